#include "kinetome/models/bundle_graph.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace kinetome {
namespace {

/// Frames before the first piece and after the last one of each clip.
int64_t dangling_frames(std::span<const MotionPiece> pieces, std::span<const int64_t> clip_frames) {
    std::vector<int64_t> first(clip_frames.begin(), clip_frames.end()), end(clip_frames.size());
    for (const MotionPiece& piece : pieces) {
        const auto clip = static_cast<size_t>(piece.clip);
        first[clip] = std::min(first[clip], piece.first);
        end[clip] = std::max(end[clip], piece.end);
    }
    int64_t dangling = 0;
    for (size_t clip = 0; clip < clip_frames.size(); ++clip) {
        dangling += first[clip] + (clip_frames[clip] - std::max(end[clip], first[clip]));
    }
    return dangling;
}

}  // namespace

std::vector<BundleMember> bundle_members(const MotionString& string,
                                         std::span<const SubstringBundle> bundles,
                                         std::span<const int32_t> frames) {
    if (frames.size() != string.letters.size())
        throw std::invalid_argument("each letter of the motion string needs a frame");
    std::vector<BundleMember> members;
    for (size_t bundle = 0; bundle < bundles.size(); ++bundle) {
        for (const Substring& member : bundles[bundle].members) {
            const auto first = static_cast<size_t>(member.first);
            members.push_back(
                {static_cast<int32_t>(bundle),
                 {string.clip[first], frames[first], frames[static_cast<size_t>(member.last)]}});
        }
    }
    std::ranges::sort(members, {}, [](const BundleMember& member) {
        return std::tuple(member.frames.clip, member.frames.first);
    });
    return members;
}

BundleGraph bundle_graph(std::span<const BundleMember> members, std::span<const int32_t> node_of,
                         int32_t nodes, std::span<const int64_t> clip_frames) {
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> node_of_piece;
    BundleGraph result;
    for (const BundleMember& member : members) {
        if (member.bundle < 0 || static_cast<size_t>(member.bundle) >= node_of.size())
            throw std::invalid_argument("a member is of a bundle that is not there");
        const MotionPiece& piece = member.frames;
        if (piece.clip < 0 || static_cast<size_t>(piece.clip) >= clip_frames.size() ||
            piece.end > clip_frames[static_cast<size_t>(piece.clip)]) {
            throw std::invalid_argument("a member is of a clip that is not there");
        }
        const int32_t node = node_of[static_cast<size_t>(member.bundle)];
        if (node < 0) continue;
        pieces.push_back(piece);
        node_of_piece.push_back(node);
        result.frames.in_nodes += piece.frames();
    }
    result.graph = MotionGraph(std::move(pieces), std::move(node_of_piece), nodes,
                               std::numeric_limits<int64_t>::max());
    for (int32_t node = 0; node < nodes; ++node) {
        for (const Succession& succession : result.graph.successions(node)) {
            result.frames.in_edges += result.graph.gap(succession);
        }
    }
    result.frames.dangling = dangling_frames(result.graph.pieces(), clip_frames);
    return result;
}

}  // namespace kinetome
