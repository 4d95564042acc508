#include "member_agreement.h"

#include <algorithm>
#include <cmath>

#include "kinetome/math/moments.h"
#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// They hold more than nineteen twentieths of what the points of bodies vary.
constexpr Eigen::Index most_axes = 16;

MatrixF along_main_axes(const MatrixFView& rows, std::span<const Occurrence> occurrences) {
    Eigen::Index count = 0;
    for (const Occurrence& one : occurrences) count += one.query.size();
    MatrixF sample(count, rows.cols());
    count = 0;
    for (const Occurrence& one : occurrences) {
        sample.middleRows(count, one.query.size()) =
            rows.middleRows(one.query.first, one.query.size());
        count += one.query.size();
    }
    const Moments moments = moments_of(sample);
    const MatrixD axes =
        symmetric_eigen(moments.scatter).vectors.leftCols(std::min(most_axes, rows.cols()));
    MatrixF along(rows.rows(), axes.cols());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        along.row(i) =
            ((rows.row(i).cast<double>() - moments.mean.transpose()) * axes).cast<float>();
    }
    return along;
}

/// Movements along a path about the mean of each, a cell.
struct Movement {
    double apart = 0;  ///< Σ|x - y|²
    double whole = 0;  ///< Σ|x|² + Σ|y|²
};

Movement movement(const MatrixF& rows, const WarpPath& path, int64_t first, int64_t second) {
    Eigen::RowVectorXd x_mean = Eigen::RowVectorXd::Zero(rows.cols()), y_mean = x_mean;
    for (const WarpCell& cell : path.cells) {
        x_mean += rows.row(first + cell.first).cast<double>();
        y_mean += rows.row(second + cell.second).cast<double>();
    }
    const auto cells = static_cast<double>(path.cells.size());
    x_mean /= cells;
    y_mean /= cells;
    Movement sum;
    for (const WarpCell& cell : path.cells) {
        const Eigen::RowVectorXd x = rows.row(first + cell.first).cast<double>() - x_mean;
        const Eigen::RowVectorXd y = rows.row(second + cell.second).cast<double>() - y_mean;
        sum.apart += (x - y).squaredNorm();
        sum.whole += x.squaredNorm() + y.squaredNorm();
    }
    return {sum.apart / cells, sum.whole / cells};
}

}  // namespace

MemberAgreement::MemberAgreement(const MatrixFView& rows, std::vector<Occurrence> occurrences,
                                 const BundleLinkOptions& options)
    : rows_(along_main_axes(rows, occurrences)),
      occurrences_(std::move(occurrences)),
      options_(options) {
    columns_ = rows_.transpose();
}

bool MemberAgreement::share_surroundings(size_t a, size_t b) const {
    const RowRange &one = occurrences_[a].query, &other = occurrences_[b].query;
    return one.first < other.end && other.first < one.end;
}

double MemberAgreement::glance(size_t from, size_t to) const {
    const RowRange &member = occurrences_[from].member, &other = occurrences_[to].member;
    const RowRange& within = occurrences_[to].sequence;
    const auto middle = rows_.row((member.first + member.end) / 2);
    const int64_t first = std::max(within.first, other.first - options_.slip);
    const int64_t end = std::min(within.end, other.end + options_.slip);
    float least = std::numeric_limits<float>::infinity();
    for (int64_t row = first; row < end; ++row)
        least = std::min(least, (rows_.row(row) - middle).squaredNorm());
    return std::sqrt(static_cast<double>(least));
}

double MemberAgreement::bound(size_t from, size_t to, double at_most) const {
    const RowRange &query = occurrences_[from].query, &sequence = occurrences_[to].sequence;
    const Eigen::Index count = sequence.size();
    constexpr Eigen::Index longest_step = 2;
    constexpr double rounding = 1e-5;  // relative, of sums of floats
    const double hopeless = at_most * static_cast<double>(query.size()) * (1 + rounding);
    // Totals of the row before the last, of the last and of this one, by where paths end.
    Eigen::ArrayXf before =
        Eigen::ArrayXf::Constant(count + longest_step, std::numeric_limits<float>::infinity());
    Eigen::ArrayXf last = before, here = before, distance(count);
    for (int64_t row = query.first; row < query.end; ++row) {
        distance.setZero();
        for (Eigen::Index axis = 0; axis < columns_.rows(); ++axis) {
            const auto y = columns_.row(axis).segment(sequence.first, count).transpose().array();
            distance += (y - rows_(row, axis)).square();
        }
        distance = distance.sqrt();
        if (row == query.first) {
            here.tail(count) = distance;
        } else {
            here.tail(count) = (last.segment(1, count).min(last.head(count)) + distance)
                                   .min(before.segment(1, count) + 2 * distance);
        }
        // A path comes through this row or the one before.
        const float least = std::min(here.minCoeff(), last.minCoeff());
        if (static_cast<double>(least) > hopeless) return infinite;
        std::swap(before, last);
        std::swap(last, here);
    }
    const auto total = static_cast<double>(last.minCoeff());
    const double mean = total / static_cast<double>(query.size()) * (1 - rounding);
    return mean > at_most ? infinite : mean;
}

/// Whether the middle of what answers the one member lies in the other, or that one's middle in
/// what answers, but for a slip.
bool MemberAgreement::answers(const WarpPath& path, const Occurrence& from,
                              const Occurrence& to) const {
    RowRange answered{std::numeric_limits<int64_t>::max(), 0};
    for (const WarpCell& cell : path.cells) {
        const int64_t row = from.query.first + cell.first;
        if (row < from.member.first || row >= from.member.end) continue;
        const int64_t other = to.sequence.first + cell.second;
        answered = {std::min(answered.first, other), std::max(answered.end, other + 1)};
    }
    if (answered.first >= answered.end) return false;
    const auto in_the_midst = [&](const RowRange& range, const RowRange& other) {
        const int64_t middle = (range.first + range.end) / 2;
        return middle >= other.first - options_.slip && middle < other.end + options_.slip;
    };
    return in_the_midst(answered, to.member) || in_the_midst(to.member, answered);
}

Agreement MemberAgreement::find(size_t from, size_t to, double at_most, double unlikeness) const {
    const Occurrence &one = occurrences_[from], &other = occurrences_[to];
    MatchOptions match;
    match.at_most = at_most;
    const auto paths =
        warp_matches(rows_.middleRows(one.query.first, one.query.size()),
                     rows_.middleRows(other.sequence.first, other.sequence.size()), match);
    Agreement best;
    for (const WarpPath& path : paths) {
        if (path.cells.empty() || path.mean >= best.cost || !answers(path, one, other)) continue;
        const Movement moved = movement(rows_, path, one.query.first, other.sequence.first);
        if (moved.apart > std::max(unlikeness, options_.unlike * moved.whole)) continue;
        best = {path.mean, moved.apart};
    }
    return best;
}

}  // namespace kinetome
