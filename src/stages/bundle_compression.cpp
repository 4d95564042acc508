#include "kinetome/stages/bundle_compression.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kinetome/models/bundle_compression.h"
#include "kinetome/models/pose_hierarchy.h"
#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/stored_bundles.h"
#include "kinetome/stages/stored_markers.h"

namespace kinetome {
namespace {

/// Markers of clips by name.
class MarkersOfClips {
  public:
    explicit MarkersOfClips(const Generation& generation)
        : classes_(stored_markers(generation, "")) {
        for (size_t of_class = 0; of_class < classes_.size(); ++of_class) {
            const MarkerTakes& takes = classes_[of_class];
            for (size_t take = 0; take < takes.names.size(); ++take)
                places_[takes.names[take]] = {of_class, takes.takes[take].first};
        }
    }

    MatrixF of(const std::string& clip, const MotionPiece& frames) const {
        const auto& [of_class, first_row] = places_.at(clip);
        return classes_[of_class].poses.middleRows(first_row + frames.first, frames.frames());
    }

  private:
    std::vector<MarkerTakes> classes_;
    std::map<std::string, std::pair<size_t, int64_t>> places_;  ///< class, first row
};

/// Members of a bundle that has several, and which of them stands for the others.
struct Represented {
    std::vector<MotionPiece> members;
    size_t kept = 0;
};

std::vector<Represented> represented(const StoredBundles& bundles) {
    const std::vector<int32_t> heights = bundles.heights();
    std::map<int32_t, Represented> by_bundle;
    for (const BundleMember& member : bundles.members) {
        if (heights[static_cast<size_t>(member.bundle)] > 1 && member.frames.frames() > 0)
            by_bundle[member.bundle].members.push_back(member.frames);
    }
    std::vector<Represented> all;
    for (auto& [bundle, one] : by_bundle) {
        std::vector<double> lengths;
        for (const MotionPiece& member : one.members)
            lengths.push_back(static_cast<double>(member.frames()));
        one.kept = representative_of(lengths);
        all.push_back(std::move(one));
    }
    return all;
}

/// Root of the mean over markers and frames.
struct MarkerError {
    double squared = 0;  ///< cm²
    double markers = 0;

    void add(const MatrixF& member, const MatrixF& shown) {
        squared += squared_stand_in_error(member, shown);
        markers += static_cast<double>(member.rows() * compared_markers(member.cols()));
    }
    double rms_mm() const {
        constexpr double mm_per_cm = 10;
        return markers > 0 ? mm_per_cm * std::sqrt(squared / markers) : 0;
    }
};

}  // namespace

StoredBundleCompression stored_bundle_compression(const Generation& generation) {
    const BundleShares shares = bundle_shares(generation);
    const StoredBundles bundles = read_bundles(generation.open("bundles.h5"));
    const std::vector<Represented> all = represented(bundles);
    const MarkersOfClips markers(generation);
    const auto poses = [&](const MotionPiece& member) {
        return markers.of(bundles.clips[static_cast<size_t>(member.clip)].name, member);
    };
    const auto shown_by = [&](const Represented& one) { return poses(one.members[one.kept]); };
    StoredBundleCompression result{.frames = shares.frames.sum(),
                                   .kept_frames = shares.frames.sum(),
                                   .file_bytes = shares.file_bytes};
    MarkerError error, of_next;
    for (size_t i = 0; i < all.size(); ++i) {
        const MatrixF shown = shown_by(all[i]), next = shown_by(all[(i + 1) % all.size()]);
        for (size_t m = 0; m < all[i].members.size(); ++m) {
            if (m == all[i].kept) continue;
            const MatrixF member = poses(all[i].members[m]);
            error.add(member, shown);
            if (next.cols() == member.cols()) of_next.add(member, next);  // else of another class
            result.kept_frames -= member.rows();
        }
    }
    result.rms_mm = error.rms_mm();
    result.control_rms_mm = of_next.rms_mm();
    result.text_bytes = write_table(bundle_table(generation), TableFormat::csv).size();
    return result;
}

void append_compression(const StoredBundleCompression& compression, Table& table) {
    const auto ratio =
        static_cast<double>(compression.frames) / static_cast<double>(compression.kept_frames);
    table.columns.insert(table.columns.end(), {"frames", "kept_frames", "ratio", "rms_mm",
                                               "control_rms_mm", "file_bytes", "text_bytes"});
    auto& row = table.rows.front();
    row.insert(row.end(), {compression.frames, compression.kept_frames, ratio, compression.rms_mm,
                           compression.control_rms_mm, static_cast<int64_t>(compression.file_bytes),
                           static_cast<int64_t>(compression.text_bytes)});
}

}  // namespace kinetome
