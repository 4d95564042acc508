// What does a pose hierarchy of millions of frames cost, and how does that grow with the number of
// columns? Poses are those of real takes at other paces, in other sizes and mirrored, made when
// they are read, so that --memory is all there is for the model and for rows that are kept.
//     pose_hierarchy_bench CORPUS [--frames N] [--columns 30,93,123] [--leaf-tolerance MM]
//                          [--memory 1G] [--threads N] [--nodes-per-pass N] [--check]
// With --check each is grown again with another thread and small passes, and with less memory,
// so that rows are read anew; the program exits with 1 unless all are equal.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "cost.h"
#include "kinetome/base/digest.h"
#include "kinetome/features/markers.h"
#include "kinetome/math/kept_rows.h"
#include "kinetome/models/hierarchy_growth.h"
#include "kinetome/models/principal_markers.h"
#include "kinetome/stages/pose_hierarchy_memory.h"
#include "marker_takes.h"
#include "program.h"

namespace {

using namespace kinetome;
using namespace kinetome::bench;

/// A take at another pace and size, perhaps mirrored.
struct Variation {
    size_t take = 0;
    double pace = 1;  ///< frames of the take a row
    float size = 1;
    bool mirrored = false;
    int64_t first = 0;  ///< row
    int64_t rows = 0;
};

/// Column of the pose in a mirror from the column it is seen in: left and right change places.
std::vector<int64_t> mirrored_columns(const std::vector<std::string>& names) {
    std::vector<int64_t> columns;
    for (const std::string& name : names) {
        std::string other = name;
        if (name.front() == 'l' || name.front() == 'r')
            other.front() = name.front() == 'l' ? 'r' : 'l';
        const auto found = std::ranges::find(names, other);
        const auto marker =
            (found == names.end() ? std::ranges::find(names, name) : found) - names.begin();
        for (int64_t axis = 0; axis < 3; ++axis) columns.push_back(3 * marker + axis);
    }
    return columns;
}

/// n × columns: the first markers of a skeleton, and beyond its last the middles between them.
class VariedPoses final : public RowSource {
  public:
    VariedPoses(const std::vector<MarkerTake>& takes, const std::vector<std::string>& names,
                int64_t frames, int64_t columns)
        : takes_(takes), mirror_(mirrored_columns(names)), columns_(columns) {
        constexpr float sizes[] = {1.F, 0.94F, 1.12F, 0.88F, 1.06F};
        constexpr double paces[] = {1, 0.83, 1.21, 0.91, 1.07, 0.77, 1.31};
        std::vector<ClipExtent> extents;
        for (size_t copy = 0, at = 0; rows_ < frames; ++at) {
            if (at == takes.size()) {
                at = 0;
                ++copy;
            }
            Variation one{at,
                          paces[copy % std::size(paces)],
                          sizes[copy % std::size(sizes)],
                          copy % 2 == 1,
                          rows_,
                          0};
            const auto last = static_cast<double>(takes[at].markers.rows() - 1);
            one.rows = std::min(static_cast<int64_t>(last / one.pace) + 1, frames - rows_);
            rows_ += one.rows;
            extents.push_back(
                {hash_name(fmt::format("{}+{}", takes[at].name, copy)), one.rows, one.rows});
            variations_.push_back(one);
        }
        layout_ = layout_pieces(extents);
    }

    int64_t columns() const override { return columns_; }
    const PieceLayout& layout() const override { return layout_; }
    RowBlock read(const RowRange& range) const override {
        MatrixF rows(range.size(), columns_);
        auto one = std::ranges::upper_bound(variations_, range.first, {}, &Variation::first) - 1;
        for (int64_t row = range.first; row < range.end; ++row) {
            while (row >= one->first + one->rows) ++one;
            fill(*one, row - one->first, rows.row(row - range.first));
        }
        return RowBlock(std::move(rows));
    }

  private:
    void fill(const Variation& one, int64_t row,
              Eigen::Ref<Eigen::RowVectorXf, 0, Eigen::InnerStride<>> pose) const {
        const MatrixF& markers = takes_[one.take].markers;
        const double at = static_cast<double>(row) * one.pace;
        const auto before = static_cast<int64_t>(at);
        const int64_t after = std::min(before + 1, markers.rows() - 1);
        const auto share = static_cast<float>(at - static_cast<double>(before));
        const int64_t own = std::min(columns_, markers.cols());
        for (int64_t j = 0; j < own; ++j) {
            const int64_t from = one.mirrored ? mirror_[static_cast<size_t>(j)] : j;
            const float sign = one.mirrored && j % 3 == 0 ? -1.F : 1.F;
            pose[j] =
                sign * one.size *
                (markers(before, from) + share * (markers(after, from) - markers(before, from)));
        }
        for (int64_t j = own; j < columns_; ++j)
            pose[j] = (pose[j - own + 3] + pose[j - own + 6]) / 2;
    }

    const std::vector<MarkerTake>& takes_;
    std::vector<int64_t> mirror_;
    int64_t columns_, rows_ = 0;
    std::vector<Variation> variations_;
    PieceLayout layout_;
};

struct Options {
    std::filesystem::path corpus;
    int64_t frames = 2'500'000, nodes_per_pass = 0;
    std::vector<int64_t> columns{30, 93, 123};
    double leaf_tolerance = 40;  ///< some 300 frames a leaf, as in S2 §5.1
    std::string memory;
    int threads = 1;
    bool check = false;

    Resources resources() const {
        std::optional<uint64_t> bytes;
        if (!memory.empty()) bytes = parse_bytes(memory);
        return granted_resources(threads, bytes);
    }
};

/// Prints a line; returns the digest of the hierarchy.
std::string measure(const VariedPoses& poses, const Options& options) {
    constexpr double frame_rate = 120;
    malloc_trim(0);  // what the one before freed would count as taken
    const Resources resources = options.resources();
    PoseHierarchyOptions growth;
    growth.leaf_tolerance = options.leaf_tolerance;
    const Workers workers(resources.threads);
    GrownHierarchy grown;
    HierarchyMemory memory;
    size_t known = 0;
    const Cost cost = cost_of([&] {
        const auto principal = select_principal_markers(moments_of(poses, workers), {});
        known = principal.columns.size();
        memory = share_memory({poses.rows(), poses.columns(), static_cast<int64_t>(known),
                               static_cast<double>(poses.rows()) / frame_rate},
                              growth, resources, 1);
        if (options.nodes_per_pass > 0) memory.nodes_per_pass = options.nodes_per_pass;
        const KeptRows kept(
            poses.layout(), poses.columns(),
            [&](const RowRange& range) { return MatrixF(poses.read(range).view()); }, workers,
            memory.pose_bytes);
        const KeptRows columns(
            poses.layout(), static_cast<int64_t>(known),
            [&](const RowRange& range) -> MatrixF {
                return kept.read(range).view()(Eigen::all, principal.columns);
            },
            workers, memory.principal_bytes);
        grown = grow_pose_hierarchy(kept, columns, principal.columns, growth, workers,
                                    memory.nodes_per_pass);
    });
    const std::string digest = digest_of(packed(grown)).hex();
    fmt::print("{:9} {:8} {:10} {:7} {:8} {:6} {:6.0f} % {:8.1f} {:8.1f} {:9.0f}  {}\n",
               poses.rows(), poses.columns(), known, grown.hierarchy.leaves(), resources.threads,
               memory.nodes_per_pass,
               100 * std::min(1.0, static_cast<double>(memory.pose_bytes) /
                                       static_cast<double>(poses.rows() * poses.columns() * 4)),
               cost.cpu, cost.wall, static_cast<double>(peak_resident_bytes()) / (1 << 20), digest);
    std::fflush(stdout);
    return digest;
}

/// Whether other threads, other passes and rows read anew make the same hierarchy.
bool is_same_otherwise(const VariedPoses& poses, const Options& options,
                       const std::string& digest) {
    Options other = options;
    other.threads = options.threads + 1;
    other.nodes_per_pass = 97;
    bool same = measure(poses, other) == digest;
    other = options;
    other.nodes_per_pass = 1500;
    other.memory = fmt::format("{}", options.resources().memory_bytes / 4 * 3);
    return measure(poses, other) == digest && same;
}

/// False when some hierarchy is another one when it is grown otherwise.
bool run(const Options& options) {
    std::vector<std::string> names;
    const auto takes = [&] {
        const auto clips = read_clips(options.corpus);
        names = marker_names(*clips.front().clip.skeleton);
        return markers_of(clips);
    }();
    fmt::print(
        "   frames  columns  principal  leaves  threads  nodes  kept     cpu s   wall s  peak MiB  "
        "digest\n");
    bool same = true;
    for (const int64_t columns : options.columns) {
        const VariedPoses poses(takes, names, options.frames, columns);
        const std::string digest = measure(poses, options);
        if (options.check) same = is_same_otherwise(poses, options, digest) && same;
    }
    return same;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    Program program("What does a pose hierarchy of millions of frames cost?");
    program.argument("corpus", options.corpus, "folder with NN/NN.asf and NN/NN_*.amc");
    program.count("--frames", options.frames, "poses");
    program.option("--columns", options.columns, "columns of a pose");
    program.option("--leaf-tolerance", options.leaf_tolerance, "mm");
    program.option("--memory", options.memory, "bytes granted, such as 1G");
    program.count("--threads", options.threads, "threads");
    program.option("--nodes-per-pass", options.nodes_per_pass, "0: as memory allows");
    program.flag("--check", options.check, "grow each again, otherwise, and compare");
    return program.run(argc, argv, [&] { return run(options); });
}
