#include "member_agreement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinetome {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// Of the surroundings asked for, where clips are short.
constexpr double least_share = 0.6;

/// Distances worked out at once; so many columns more than there are rows may be read.
constexpr int64_t lanes = 16;

/// How far surroundings reach to either side of a middle.
struct Reach {
    int64_t before = 0, after = 0;
    int64_t rows() const { return before + 1 + after; }
};

/// About as much before as after; where a clip begins or ends, more on the other side.
Reach reach_within(int64_t before, int64_t after, int64_t rows) {
    Reach reach{std::min(before, rows / 2), 0};
    reach.after = std::min(after, rows - 1 - reach.before);
    reach.before = std::min(before, rows - 1 - reach.after);
    return reach;
}

/// Two rows that answer each other.
struct Answer {
    int64_t one = 0, other = 0;
};

/// The cheapest paths outwards, in one direction, from a row and those it may answer: over `length`
/// rows more, neither going more than twice as fast as the other. Cells count by the rows of the
/// one that the path goes on by from there (WarpWeight::first).
class OutwardPaths {
  public:
    /// `columns` are the rows, an axis after the other, and some to spare; `others` what the middle
    /// may answer, `clip` those rows' own; `direction` is 1 or -1. Given up when all paths cost
    /// more than `at_most` in the mean.
    OutwardPaths(const MatrixF& columns, int64_t middle, int64_t length, int direction,
                 const RowRange& others, const RowRange& clip, double at_most)
        : columns_(columns),
          middle_(middle),
          length_(length),
          direction_(direction),
          answers_(others.size()),
          origin_(direction > 0 ? others.first : others.end - 1),
          count_(std::min(answers_ + 2 * length,
                          direction > 0 ? clip.end - origin_ : origin_ + 1 - clip.first)),
          distances_(length + 1, count_ + lanes),
          totals_(Totals::Constant(length + 1, count_ + longest_step, infinite)) {
        const auto hopeless = static_cast<float>(at_most * static_cast<double>(length + 1));
        for (int64_t i = length; i >= 0 && alive_; --i) alive_ = come_to(i) <= hopeless;
    }

    bool alive() const { return alive_; }

    /// From the middle and this row.
    float total(int64_t other) const { return totals_(0, direction_ * (other - origin_)); }
    float distance(int64_t other) const { return distances_(0, direction_ * (other - origin_)); }

    /// Appends what answers what from there on, but for the middle itself.
    void trace(int64_t other, std::vector<Answer>& answers) const {
        int64_t at = direction_ * (other - origin_);
        for (int64_t i = 0; i < length_;) {
            const float one = totals_(i + 1, at + 1), two = totals_(i + 1, at + 2);
            const float half =
                i + 2 <= length_ ? totals_(i + 2, at + 1) + distances_(i, at) : infinite;
            const bool passes = half < std::min(one, two);
            at += !passes && two < one ? 2 : 1;
            i += passes ? 2 : 1;
            answers.push_back({middle_ + direction_ * i, origin_ + direction_ * at});
        }
    }

  private:
    using Totals = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Lanes = Eigen::Array<float, 1, lanes>;
    static constexpr int64_t longest_step = 2;

    /// Adds row i; what the cheapest path costs that comes through it or passes over it.
    float come_to(int64_t i) {
        const int64_t first = (i + 1) / 2;
        const int64_t size = std::min(count_, answers_ + 2 * i) - first;
        if (size <= 0) return infinite;
        const int64_t begin = direction_ > 0 ? origin_ + first : origin_ - first - size + 1;
        const auto middle = columns_.col(middle_ + direction_ * i);
        for (int64_t done = 0; done < size; done += lanes) {
            Lanes sum = Lanes::Zero();
            for (Eigen::Index axis = 0; axis < columns_.rows(); ++axis) {
                sum += (columns_.row(axis).segment<lanes>(begin + done).array() - middle[axis])
                           .square();
            }
            distances_.row(i).segment<lanes>(first + done) = sum.sqrt();
        }
        auto here = distances_.row(i).segment(first, size);
        if (direction_ < 0) here.reverseInPlace();
        auto total = totals_.row(i).segment(first, size);
        if (i == length_) {
            total = here;
            return total.minCoeff();
        }
        const auto onward = totals_.row(i + 1);
        total = onward.segment(first + 1, size).min(onward.segment(first + 2, size)) + here;
        if (i + 2 <= length_)
            total = total.min(totals_.row(i + 2).segment(first + 1, size) + 2 * here);
        // Only the middle cannot be passed over.
        return i == 0 ? total.minCoeff() : std::min(total.minCoeff(), onward.minCoeff());
    }

    const MatrixF& columns_;
    int64_t middle_, length_, direction_, answers_, origin_, count_;
    Totals
        distances_;  ///< by rows outwards, and by those of the other from the first it may answer
    Totals totals_;  ///< of what follows outwards, the cell itself counted
    bool alive_ = true;
};

/// How unlike the movements are that answer each other, each about its mean.
double unlikeness(const MatrixF& rows, const std::vector<Answer>& answers) {
    Eigen::RowVectorXd x_mean = Eigen::RowVectorXd::Zero(rows.cols()), y_mean = x_mean;
    for (const Answer& answer : answers) {
        x_mean += rows.row(answer.one).cast<double>();
        y_mean += rows.row(answer.other).cast<double>();
    }
    x_mean /= static_cast<double>(answers.size());
    y_mean /= static_cast<double>(answers.size());
    double apart = 0, whole = 0;
    for (const Answer& answer : answers) {
        const Eigen::RowVectorXd x = rows.row(answer.one).cast<double>() - x_mean;
        const Eigen::RowVectorXd y = rows.row(answer.other).cast<double>() - y_mean;
        apart += (x - y).squaredNorm();
        whole += x.squaredNorm() + y.squaredNorm();
    }
    return whole > 0 ? std::sqrt(apart / whole) : 1;
}

}  // namespace

MemberAgreement::MemberAgreement(MatrixF rows, std::vector<Occurrence> occurrences,
                                 const BundleLinkOptions& options)
    : rows_(std::move(rows)),
      columns_(MatrixF::Zero(rows_.cols(), rows_.rows() + lanes)),
      occurrences_(std::move(occurrences)),
      options_(options) {
    columns_.leftCols(rows_.rows()) = rows_.transpose();
    const auto count = static_cast<Eigen::Index>(occurrences_.size());
    centres_.resize(count, rows_.cols());
    radii_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const RowRange range = answers(static_cast<size_t>(i));
        const auto all = rows_.middleRows(range.first, range.size());
        centres_.row(i) = all.colwise().mean();
        radii_[i] = (all.rowwise() - centres_.row(i)).rowwise().norm().maxCoeff();
    }
}

bool MemberAgreement::share_surroundings(size_t a, size_t b) const {
    return std::abs(occurrences_[a].middle() - occurrences_[b].middle()) < options_.surroundings;
}

RowRange MemberAgreement::answers(size_t to) const {
    const Occurrence& other = occurrences_[to];
    return {std::max(other.clip.first, other.member.first - options_.slip),
            std::min(other.clip.end, other.member.end + options_.slip)};
}

double MemberAgreement::glance(size_t from, size_t to) const {
    const auto middle = rows_.row(occurrences_[from].middle());
    const RowRange others = answers(to);
    float least = infinite;
    for (int64_t row = others.first; row < others.end; ++row)
        least = std::min(least, (rows_.row(row) - middle).squaredNorm());
    return std::sqrt(static_cast<double>(least));
}

double MemberAgreement::glance_bound(size_t from, size_t to) const {
    constexpr double rounding = 1e-5;  // relative, of sums of floats
    const auto centre = centres_.row(static_cast<Eigen::Index>(to));
    const auto distance =
        static_cast<double>((rows_.row(occurrences_[from].middle()) - centre).norm());
    const auto radius = static_cast<double>(radii_[static_cast<Eigen::Index>(to)]);
    return distance * (1 - rounding) - radius * (1 + rounding);
}

Agreement MemberAgreement::find(size_t from, size_t to, double at_most) const {
    const Occurrence &one = occurrences_[from], &other = occurrences_[to];
    const Reach reach =
        reach_within(std::min(one.middle() - one.clip.first, other.middle() - other.clip.first),
                     std::min(one.clip.end - one.middle(), other.clip.end - other.middle()) - 1,
                     options_.surroundings);
    if (static_cast<double>(reach.rows()) <
        least_share * static_cast<double>(options_.surroundings))
        return {};
    const RowRange others = answers(to);
    const OutwardPaths after(columns_, one.middle(), reach.after, 1, others, other.clip, at_most);
    if (!after.alive()) return {};
    const OutwardPaths before(columns_, one.middle(), reach.before, -1, others, other.clip,
                              at_most);
    if (!before.alive()) return {};
    float least = infinite;
    int64_t answer = others.first;
    for (int64_t row = others.first; row < others.end; ++row) {
        // The middle counts once.
        const float total = after.total(row) + before.total(row) - after.distance(row);
        if (!(total < least)) continue;
        least = total;
        answer = row;
    }
    const double cost = static_cast<double>(least) / static_cast<double>(reach.rows());
    if (!(cost <= at_most)) return {};
    std::vector<Answer> path{{one.middle(), answer}};
    after.trace(answer, path);
    before.trace(answer, path);
    return {cost, unlikeness(rows_, path)};
}

}  // namespace kinetome
