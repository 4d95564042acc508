#include "kinetome/models/estimation_score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "kinetome/base/parallel.h"
#include "kinetome/base/random.h"
#include "kinetome/math/row_source.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

std::span<const float> pose_of(const MatrixF& poses, int64_t row) {
    return {poses.data() + row * poses.cols(), static_cast<size_t>(poses.cols())};
}

EstimationScore score_of(std::string method, std::vector<double> errors) {
    EstimationScore score{std::move(method)};
    double squared = 0;
    for (const double error : errors) squared += error * error;
    std::ranges::sort(errors);
    const size_t last = errors.size() - 1;
    score.rms = std::sqrt(squared / static_cast<double>(errors.size()));
    score.share_95 = errors[last * 95 / 100];
    score.greatest = errors[last];
    return score;
}

/// Errors of estimate(row of the test).
std::vector<double> errors_of(const MatrixF& test, int64_t markers, const Workers& workers,
                              const std::function<VectorD(int64_t)>& estimate) {
    std::vector<double> errors(static_cast<size_t>(test.rows()));
    parallel_for(workers.threads, test.rows(), [&](int64_t i) {
        errors[static_cast<size_t>(i)] = estimation_error(pose_of(test, i), estimate(i), markers);
    });
    return errors;
}

/// One map for all poses, as the root of a hierarchy has it.
std::vector<double> linear_errors(const Moments& training, const MatrixF& test,
                                  const PrincipalMarkers& principal, int64_t markers,
                                  const Workers& workers) {
    const std::vector<int32_t>& known = principal.columns;
    const auto others = estimated_columns(test.cols(), known);
    const MarkerMap map =
        fit_marker_map(training, known, nullptr, {.rule = MarkerMapRule::least_squares});
    return errors_of(test, markers, workers, [&](int64_t i) {
        VectorD pose = test.row(i).cast<double>();
        const VectorD from_mean = pose(known) - training.mean(known);
        pose(others) = training.mean(others) + map.map.transpose() * from_mean;
        return pose;
    });
}

using Nearest = std::vector<std::pair<float, int64_t>>;  ///< squared distance, row; ascending

/// The `count` nearest rows of `among` to each of `rows`; ties to the first.
std::vector<Nearest> nearest_rows(const MatrixF& rows, const MatrixF& among, size_t count,
                                  const Workers& workers) {
    constexpr int64_t queries_at_once = 64, rows_at_once = 4096;
    std::vector<Nearest> nearest(static_cast<size_t>(rows.rows()));
    const int64_t batches = (rows.rows() + queries_at_once - 1) / queries_at_once;
    parallel_for(workers.threads, batches, [&](int64_t batch) {
        const int64_t first = batch * queries_at_once;
        const auto queries = rows.middleRows(first, std::min(queries_at_once, rows.rows() - first));
        for (int64_t start = 0; start < among.rows(); start += rows_at_once) {
            const auto block =
                among.middleRows(start, std::min(rows_at_once, among.rows() - start));
            MatrixF distances = -2 * queries * block.transpose();
            distances.rowwise() += block.rowwise().squaredNorm().transpose();
            for (int64_t q = 0; q < queries.rows(); ++q) {
                Nearest& best = nearest[static_cast<size_t>(first + q)];
                for (int64_t r = 0; r < block.rows(); ++r) {
                    const std::pair<float, int64_t> found(distances(q, r), start + r);
                    if (best.size() == count && !(found < best.back())) continue;
                    if (best.size() == count) best.pop_back();
                    best.insert(std::ranges::upper_bound(best, found), found);
                }
            }
        }
    });
    return nearest;
}

/// Mean of the first `count` of the nearest training poses, principal columns as they are.
VectorD neighbours_mean(const MatrixF& training, const Nearest& nearest, size_t count,
                        const std::vector<int32_t>& known, std::span<const float> pose) {
    VectorD mean = VectorD::Zero(training.cols());
    const size_t used = std::min(count, nearest.size());
    for (size_t i = 0; i < used; ++i) {
        mean += training.row(nearest[i].second).cast<double>() / static_cast<double>(used);
    }
    for (const int32_t column : known) mean[column] = double(pose[static_cast<size_t>(column)]);
    return mean;
}

GrownHierarchy grown(const MatrixF& training, const MatrixF& known_values,
                     const PrincipalMarkers& principal, PoseHierarchyOptions options,
                     MarkerMapRule rule, const Workers& workers) {
    constexpr int64_t nodes_per_pass = 1024;
    options.maps.rule = rule;
    return grow_pose_hierarchy(MatrixRows(training), MatrixRows(known_values), principal.columns,
                               options, workers, nodes_per_pass);
}

std::vector<double> hierarchy_errors(const GrownHierarchy& model, const MatrixF& test,
                                     int64_t markers, double band, const Workers& workers) {
    return errors_of(test, markers, workers, [&](int64_t i) {
        return estimate_pose(model.hierarchy, model.maps,
                             principal_values(model.hierarchy, pose_of(test, i)), band);
    });
}

}  // namespace

int64_t estimated_markers(const PrincipalMarkers& principal, int64_t columns) {
    return std::max<int64_t>(1, columns / 3 - 1 - static_cast<int64_t>(principal.markers.size()));
}

double estimation_error(std::span<const float> pose, const VectorD& estimate, int64_t markers) {
    const auto truth = Eigen::Map<const VectorF>(pose.data(), estimate.size()).cast<double>();
    return mm_per_cm * std::sqrt((truth - estimate).squaredNorm() / static_cast<double>(markers));
}

std::vector<bool> held_out(std::span<const RowRange> takes, double rate,
                           const HeldOutOptions& options) {
    std::vector<bool> held;
    RandomStream random(options.seed, "held_out");
    const int64_t block_frames = std::max<int64_t>(1, std::llround(options.block_seconds * rate));
    const auto is_last_of = [](int64_t number, int64_t of) { return number % of == of - 1; };
    int64_t block = 0;  // of all takes, so that short takes have held out blocks, too
    for (size_t take = 0; take < takes.size(); ++take) {
        for (int64_t i = 0; i < takes[take].size(); ++i) {
            block += i > 0 && i % block_frames == 0;
            switch (options.what) {
                case HeldOut::frames:
                    held.push_back(random.uniform() < options.share_of_frames);
                    break;
                case HeldOut::blocks:
                    held.push_back(is_last_of(block, options.every_block));
                    break;
                case HeldOut::takes:
                    held.push_back(is_last_of(static_cast<int64_t>(take), options.every_take));
                    break;
            }
        }
        ++block;
    }
    return held;
}

EstimationScores score_estimation(const MatrixF& training, const MatrixF& test,
                                  const PrincipalMarkerOptions& marker_options,
                                  const PoseHierarchyOptions& options, const Workers& workers) {
    if (training.rows() == 0 || test.rows() == 0) {
        throw std::invalid_argument("an estimation is scored on poses apart from those learned");
    }
    EstimationScores result;
    const Moments moments = moments_of(MatrixRows(training), workers);
    result.principal = select_principal_markers(moments, marker_options);
    result.training = training.rows();
    result.tested = test.rows();
    const std::vector<int32_t>& known = result.principal.columns;
    const int64_t markers = estimated_markers(result.principal, test.cols());
    const MatrixF known_values = training(Eigen::all, known);
    const auto add = [&](const char* method, std::vector<double> errors) {
        result.scores.push_back(score_of(method, std::move(errors)));
    };

    add("global linear", linear_errors(moments, test, result.principal, markers, workers));
    const auto nearest = nearest_rows(test(Eigen::all, known), known_values, 8, workers);
    for (const size_t count : {size_t{1}, size_t{8}}) {
        add(count == 1 ? "nearest pose" : "8 nearest poses",
            errors_of(test, markers, workers, [&](int64_t i) {
                return neighbours_mean(training, nearest[static_cast<size_t>(i)], count, known,
                                       pose_of(test, i));
            }));
    }
    const auto least = grown(training, known_values, result.principal, options,
                             MarkerMapRule::least_squares, workers);
    add("least squares", hierarchy_errors(least, test, markers, 0, workers));
    const auto shrunk =
        grown(training, known_values, result.principal, options, MarkerMapRule::shrinkage, workers);
    add("shrinkage", hierarchy_errors(shrunk, test, markers, 0, workers));
    add("shrinkage, blended", hierarchy_errors(shrunk, test, markers, default_blend_band, workers));
    result.leaves = shrunk.hierarchy.leaves();
    return result;
}

}  // namespace kinetome
