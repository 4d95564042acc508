#include "signature_moments.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double between_samples = 3;  // mm per marker that positions_between may be off

/// Where moments lie, those of a run together.
struct MomentRows {
    MatrixF positions;
    std::vector<int32_t> of_moment;
};

MomentRows rows_of(const MotionView& motion, const Moments& moments, int64_t longest) {
    MomentRows rows;
    rows.positions.resize(moments.count, motion.positions.cols());
    auto run = run_at(motion.runs, static_cast<int64_t>(moments.first));
    int64_t latest = -1;  // run that the last row is the mean of
    int32_t count = 0;
    for (int64_t i = 0; i < moments.count; ++i) {
        const double frame = moments.first + static_cast<double>(i) * moments.spacing;
        while (static_cast<double>(motion.runs[static_cast<size_t>(run)].end_frame()) <= frame)
            ++run;
        if (motion.runs[static_cast<size_t>(run)].frames > longest) {
            rows.positions.row(count++) =
                positions_between(motion.sample_positions, motion.samples, frame, 1, 1);
        } else if (run != latest) {
            rows.positions.row(count++) = motion.positions.row(run);
            latest = run;
        }
        rows.of_moment.push_back(count - 1);
    }
    rows.positions.conservativeResize(count, Eigen::NoChange);
    return rows;
}

/// Mean distance of rows from every step-th row of the text, the first being row `first`; no less
/// than `at_most` where it is not below that.
double mean_distance(const MatrixF& query, const MatrixF& text, int64_t first, int64_t step,
                     double at_most) {
    const auto rows = static_cast<double>(query.rows());
    double total = 0;
    for (Eigen::Index i = 0; i < query.rows() && total < at_most * rows; ++i) {
        total += double((query.row(i) - text.row(first + i * step)).norm());
    }
    return total / rows;
}

/// Where the query begins.
struct Beginning {
    int64_t frame = -1;  ///< -1: nowhere
    double distance = infinite;
};

/// The nearest of the beginnings in [range), `spacing` frames apart, that is nearer than `at_most`.
/// Of the query every step-th frame is given; the step is a multiple of the spacing.
Beginning nearest_beginning(const MatrixF& query, const MotionView& text, const RowRange& range,
                            int64_t spacing, int64_t step, double at_most) {
    const int64_t begins = (range.size() + spacing - 1) / spacing, apart = step / spacing;
    const MatrixF around =
        positions_between(text.sample_positions, text.samples, static_cast<double>(range.first),
                          static_cast<double>(spacing), begins + (query.rows() - 1) * apart);
    Beginning nearest{-1, at_most};
    for (int64_t i = 0; i < begins; ++i) {
        const double distance = mean_distance(query, around, i, apart, nearest.distance);
        if (distance < nearest.distance) nearest = {range.first + i * spacing, distance};
    }
    return nearest;
}

}  // namespace

MotionView view_of(const PlacedSignature& signature) {
    return {signature.runs, signature.positions, signature.samples(), signature.sample_positions};
}

MatrixF distances_between(const MatrixFView& query, const MatrixFView& text) {
    const MatrixF columns = text.transpose();  // values of one kind side by side, for vector units
    MatrixF distances = MatrixF::Zero(query.rows(), text.rows());
    for (Eigen::Index i = 0; i < query.rows(); ++i) {
        auto row = distances.row(i).array();
        for (Eigen::Index k = 0; k < query.cols(); ++k) {
            row += (columns.row(k).array() - query(i, k)).square();
        }
        row = row.sqrt();
    }
    return distances;
}

MatrixF distances_between(const MotionView& query, const Moments& of_query, const MotionView& text,
                          const Moments& of_text, int64_t longest) {
    const MomentRows rows = rows_of(query, of_query, longest);
    const MomentRows columns = rows_of(text, of_text, longest);
    const MatrixF known = distances_between(rows.positions, columns.positions);
    MatrixF distances(of_query.count, of_text.count);
    for (Eigen::Index i = 0; i < distances.rows(); ++i) {
        const auto row = known.row(rows.of_moment[static_cast<size_t>(i)]);
        for (Eigen::Index j = 0; j < distances.cols(); ++j) {
            distances(i, j) = row[columns.of_moment[static_cast<size_t>(j)]];
        }
    }
    return distances;
}

SignatureMatch at_own_pace(const SignatureMatch& match, const MotionView& query,
                           const MotionView& text, int32_t step) {
    const int64_t frames = query.samples.frames, margin = frames / 4;
    const auto [low, high] = std::minmax({match.frames.first, match.frames.end - frames});
    const RowRange range{std::max<int64_t>(low - margin, 0),
                         std::min(high + margin, text.samples.frames - frames) + 1};
    if (range.first >= range.end) return match;
    const MatrixF every_step = positions_between(query.sample_positions, query.samples, 0, step,
                                                 (frames + step - 1) / step);
    const int64_t about = nearest_beginning(every_step, text, range, step, step, infinite).frame;
    const RowRange near{std::max(about - step + 1, range.first), std::min(about + step, range.end)};
    const Beginning found = nearest_beginning(every_step, text, near, 1, step,
                                              std::max(match.distance / 2, between_samples));
    if (found.frame < 0) return match;
    return {{found.frame, found.frame + frames}, found.distance};
}

}  // namespace kinetome
