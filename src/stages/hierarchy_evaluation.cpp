#include "kinetome/stages/hierarchy_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinetome/base/error.h"
#include "kinetome/math/row_source.h"

namespace kinetome {
namespace {

constexpr int64_t nodes_per_pass = 1024;

std::string word_of(HeldOut what) {
    if (what == HeldOut::frames) return "frames";
    return what == HeldOut::blocks ? "blocks" : "takes";
}

std::string principal_names(const PrincipalMarkers& principal, const MarkerTakes& takes) {
    std::vector<std::string> names;
    for (const int32_t marker : principal.markers) {
        names.push_back(takes.marker_names[static_cast<size_t>(marker)]);
    }
    return fmt::format("{}", fmt::join(names, " "));
}

/// Poses that are held out, or the others.
MatrixF poses_where(const MarkerTakes& takes, const std::vector<bool>& held, bool wanted) {
    std::vector<int64_t> rows;
    for (size_t i = 0; i < held.size(); ++i) {
        if (held[i] == wanted) rows.push_back(static_cast<int64_t>(i));
    }
    return takes.poses(rows, Eigen::all);
}

/// Of an error in another one; none where there is none to compare with.
Table::Cell share_of(double error, double of) {
    return of > 0 ? Table::Cell(error / of) : Table::Cell(std::string());
}

void add_estimation(Table& table, const MarkerTakes& takes, HeldOut way,
                    const HierarchyEvaluationOptions& options, const Workers& workers) {
    HeldOutOptions choice{.what = way};
    choice.every_take = std::min(choice.every_take, static_cast<int64_t>(takes.takes.size()));
    const auto held = held_out(takes.takes, takes.rate, choice);
    const MatrixF training = poses_where(takes, held, false), test = poses_where(takes, held, true);
    if (training.rows() == 0 || test.rows() == 0) {
        throw UsageError(fmt::format("{} take(s) of class {} are too few to hold out {}",
                                     takes.takes.size(), takes.clip_class, word_of(way)));
    }
    const EstimationScores scores =
        score_estimation(training, test, options.principal_markers, options.hierarchy, workers);
    const double linear = scores.scores.at(0).rms, nearest = scores.scores.at(1).rms;
    for (const EstimationScore& score : scores.scores) {
        table.rows.push_back(
            {takes.clip_class, word_of(way), static_cast<int64_t>(scores.principal.markers.size()),
             scores.leaves, scores.training, scores.tested, score.method, score.rms, score.share_95,
             score.greatest, share_of(score.rms, linear), share_of(score.rms, nearest)});
    }
}

/// Numbers that a model and the frames on it take.
struct CompressedSize {
    double whole = 0;   ///< before: N f
    double honest = 0;  ///< C f (d + 1) + (C - 1) (p + 1) + N d + runs
    double paper = 0;   ///< C f d + N d
};

CompressedSize compressed_size(const PoseHierarchy& hierarchy, int64_t poses, int64_t runs) {
    const auto n = static_cast<double>(poses), f = static_cast<double>(hierarchy.columns()),
               c = static_cast<double>(hierarchy.leaves()),
               d = static_cast<double>(hierarchy.dimension()),
               p = static_cast<double>(hierarchy.principal_columns.size());
    return {n * f, c * f * (d + 1) + (c - 1) * (p + 1) + n * d + static_cast<double>(runs),
            c * f * d + n * d};
}

/// Runs of frames of a take in one leaf.
int64_t runs_of(const std::vector<int32_t>& leaves, const std::vector<RowRange>& takes) {
    int64_t runs = 0;
    for (const RowRange& take : takes) {
        for (int64_t i = take.first; i < take.end; ++i) {
            runs += i == take.first ||
                    leaves[static_cast<size_t>(i)] != leaves[static_cast<size_t>(i - 1)];
        }
    }
    return runs;
}

void add_compression(Table& table, const MarkerTakes& takes,
                     const HierarchyEvaluationOptions& options, const Workers& workers) {
    const MatrixRows poses(takes.poses);
    const PrincipalMarkers principal =
        select_principal_markers(moments_of(poses, workers), options.principal_markers);
    const MatrixF known = takes.poses(Eigen::all, principal.columns);
    const PoseHierarchy hierarchy = grow_pose_hierarchy(poses, MatrixRows(known), principal.columns,
                                                        options.hierarchy, workers, nodes_per_pass)
                                        .hierarchy;
    const auto leaves = leaves_of(hierarchy, takes.poses);
    const CompressedSize size =
        compressed_size(hierarchy, takes.poses.rows(), runs_of(leaves, takes.takes));
    std::vector<double> errors = leaf_errors(hierarchy, takes.poses, leaves);
    double squared = 0;
    for (const double error : errors) squared += error * error;
    std::ranges::sort(errors);
    table.rows.push_back({takes.clip_class, static_cast<int64_t>(takes.poses.rows()),
                          principal_names(principal, takes), hierarchy.leaves(),
                          size.whole / size.honest, size.whole / size.paper,
                          std::sqrt(squared / static_cast<double>(errors.size())),
                          errors[(errors.size() - 1) * 95 / 100], errors.back()});
}

}  // namespace

std::vector<HeldOut> parse_held_out(const std::string& word) {
    const std::vector<HeldOut> all{HeldOut::frames, HeldOut::blocks, HeldOut::takes};
    if (word == "all") return all;
    for (const HeldOut one : all) {
        if (word == word_of(one)) return {one};
    }
    throw UsageError(fmt::format("--held-out {}: expected frames, blocks, takes or all", word));
}

Table estimation_table(const std::vector<MarkerTakes>& classes, const std::vector<HeldOut>& ways,
                       const HierarchyEvaluationOptions& options, const Workers& workers) {
    Table table{{"class", "held_out", "principal", "leaves", "trained", "tested", "method",
                 "rms_mm", "p95_mm", "max_mm", "to_linear", "to_nearest"},
                {}};
    for (const MarkerTakes& takes : classes) {
        for (const HeldOut way : ways) add_estimation(table, takes, way, options, workers);
    }
    return table;
}

Table compression_table(const std::vector<MarkerTakes>& classes,
                        const HierarchyEvaluationOptions& options, const Workers& workers) {
    Table table{{"class", "frames", "principal", "leaves", "ratio", "ratio_paper", "rms_mm",
                 "p95_mm", "max_mm"},
                {}};
    for (const MarkerTakes& takes : classes) add_compression(table, takes, options, workers);
    return table;
}

}  // namespace kinetome
