#include "path_costs.h"

#include <algorithm>
#include <limits>

namespace kinetome {
namespace {

constexpr float unreachable = std::numeric_limits<float>::infinity();

/// Sums along best paths of ever more steps in one direction, in place.
class PathSums {
  public:
    /// `distances`: of some consecutive frames to all. `toward` 1: paths go to later frames; -1: to
    /// earlier ones.
    PathSums(const MatrixF& distances, int64_t toward)
        : distances_(distances),
          toward_(toward),
          sums_(MatrixF::Constant(distances.rows() + 2 * margin, distances.cols() + 2 * margin,
                                  unreachable)) {
        sums_.block(margin, margin, distances.rows(), distances.cols()) = distances;
    }

    void add_step() {
        // From the row that paths end in: each row is set from rows that are as they were.
        const int64_t rows = distances_.rows();
        for (int64_t i = 0; i < rows; ++i) extend(toward_ > 0 ? i : rows - 1 - i);
    }
    auto sums_of(int64_t row) const { return shifted(row, 0); }

  private:
    static constexpr int64_t margin = 2;  // that the longest step leads out

    /// Sums of a row, each from so many columns further on.
    Eigen::Ref<const RowVectorF> shifted(int64_t row, int64_t columns) const {
        return sums_.row(margin + row).segment(margin + columns, distances_.cols());
    }
    void extend(int64_t row) {
        const int64_t next = row + toward_, second = next + toward_;
        best_ = shifted(next, toward_)
                    .cwiseMin(shifted(next, 2 * toward_))
                    .cwiseMin(shifted(second, toward_));
        best_ = (best_.array() < unreachable).select(best_, shifted(row, 0));
        sums_.row(margin + row).segment(margin, distances_.cols()) = distances_.row(row) + best_;
    }

    const MatrixF& distances_;
    int64_t toward_;
    MatrixF sums_;
    RowVectorF best_;
};

}  // namespace

MatrixF path_costs(const FrameDistances& distances, const RowRange& rows, int64_t side) {
    const RowRange reach{std::max<int64_t>(rows.first - 2 * side, 0),
                         std::min(rows.end + 2 * side, distances.size())};
    MatrixF near(reach.size(), distances.size());
    for (int64_t i = 0; i < reach.size(); ++i) distances.from(reach.first + i, near.row(i));
    PathSums before(near, -1), after(near, 1);
    for (int64_t step = 0; step < side; ++step) {
        before.add_step();
        after.add_step();
    }
    MatrixF costs(rows.size(), distances.size());
    for (int64_t i = 0; i < rows.size(); ++i) {
        const int64_t row = rows.first - reach.first + i;
        costs.row(i) = (before.sums_of(row) + after.sums_of(row) - near.row(row)) /
                       static_cast<float>(2 * side + 1);
    }
    return costs;
}

}  // namespace kinetome
