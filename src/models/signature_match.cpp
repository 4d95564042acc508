#include "kinetome/models/signature_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "signature_ends.h"

namespace kinetome {
namespace {

/// The nearest, then the nearest of those that are elsewhere, and so on.
std::vector<SignatureMatch> without_overlaps(std::vector<SignatureMatch> matches, double overlap) {
    std::ranges::sort(matches, std::less<>());
    std::vector<SignatureMatch> kept;
    for (const SignatureMatch& match : matches) {
        const bool known = std::ranges::any_of(kept, [&](const SignatureMatch& nearer) {
            return is_same_place(nearer.frames, match.frames, overlap);
        });
        if (!known) kept.push_back(match);
    }
    return kept;
}

/// Those that are near enough and neither too long nor too short, without overlaps.
std::vector<SignatureMatch> chosen(std::vector<SignatureMatch> matches, int64_t query_frames,
                                   const SignatureMatchOptions& options) {
    const auto frames = static_cast<double>(query_frames);
    std::erase_if(matches, [&](const SignatureMatch& match) {
        const auto length = double(match.frames.size());
        return !(match.distance <= options.tolerance) || length < options.shortest * frames ||
               length > options.longest * frames;
    });
    return without_overlaps(std::move(matches), options.overlap);
}

}  // namespace

bool operator<(const SignatureMatch& a, const SignatureMatch& b) {
    return std::tuple(a.distance, a.frames.first, a.frames.end) <
           std::tuple(b.distance, b.frames.first, b.frames.end);
}

bool is_same_place(const RowRange& a, const RowRange& b, double overlap) {
    const int64_t shared = std::min(a.end, b.end) - std::max(a.first, b.first);
    return shared > 0 && double(shared) > overlap * double(std::min(a.size(), b.size()));
}

std::vector<SignatureMatch> match_runs(std::span<const SignatureRun> query,
                                       std::span<const SignatureRun> text,
                                       const MatrixFView& distances,
                                       const SignatureMatchOptions& options) {
    if (options.rule == MatchRule::pace) {
        throw std::invalid_argument("runs are not compared frame by frame");
    }
    if (distances.rows() != static_cast<int64_t>(query.size()) ||
        distances.cols() != static_cast<int64_t>(text.size())) {
        throw std::invalid_argument(
            fmt::format("{} × {} distances were given for signatures of {} and {} runs",
                        distances.rows(), distances.cols(), query.size(), text.size()));
    }
    if (query.empty() || text.empty()) return {};
    return chosen(run_ends(query, text, distances, options), frame_count(query), options);
}

std::vector<SignatureMatch> match_paces(int64_t query_frames, const MatrixFView& distances,
                                        const SignatureMatchOptions& options) {
    if (options.step < 1) {
        throw std::invalid_argument("signatures are compared at steps of at least one frame");
    }
    if (distances.size() == 0) return {};
    return chosen(paced_ends(distances, options.step), query_frames, options);
}

std::vector<int64_t> exact_matches(std::span<const SignatureRun> query,
                                   std::span<const SignatureRun> text) {
    std::vector<int64_t> starts;
    if (query.empty()) return starts;
    for (auto at = text.begin();; ++at) {
        at = std::search(
            at, text.end(), query.begin(), query.end(),
            [](const SignatureRun& a, const SignatureRun& b) { return a.leaf == b.leaf; });
        if (at == text.end()) return starts;
        starts.push_back(at - text.begin());
    }
}

RowRange matched_frames(std::span<const SignatureRun> query, std::span<const SignatureRun> text,
                        int64_t first, int64_t last) {
    const SignatureRun& begin = text[static_cast<size_t>(first)];
    const SignatureRun& end = text[static_cast<size_t>(last)];
    if (first == last) {
        return {begin.first_frame,
                begin.first_frame + std::min<int64_t>(begin.frames, frame_count(query))};
    }
    return {begin.end_frame() - std::min(begin.frames, query.front().frames),
            end.first_frame + std::min(end.frames, query.back().frames)};
}

}  // namespace kinetome
