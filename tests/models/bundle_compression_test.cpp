#include "kinetome/models/bundle_compression.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

using namespace kinetome;

namespace {

/// Row i is the curve at at[i].
MatrixF curve(const std::vector<float>& at, float offset = 0) {
    MatrixF rows(static_cast<Eigen::Index>(at.size()), 3);
    for (size_t i = 0; i < at.size(); ++i) {
        rows.row(static_cast<Eigen::Index>(i)) << 10 * at[i], 5 * std::sin(at[i]), offset;
    }
    return rows;
}

}  // namespace

TEST_CASE("a bundle is represented by the first of the members of usual length") {
    CHECK(representative_of(std::vector<double>{9, 3, 6, 7}) == 2);  // mean 6.25
    CHECK(representative_of(std::vector<double>{2, 4, 2, 4}) == 0);  // all are 1 from it
    CHECK(representative_of(std::vector<double>{5}) == 0);
    CHECK_THROWS_AS(representative_of({}), std::invalid_argument);
}

TEST_CASE("a member of another pace is shown exactly, one of another place by what lies between") {
    const MatrixF representative = curve({0, 1, 2, 3, 4});
    CHECK(squared_stand_in_error(representative, representative) == 0);
    CHECK(squared_stand_in_error(curve({0, 0, 1, 2, 2, 2, 3, 4}), representative) == 0);
    CHECK(squared_stand_in_error(curve({0, 2, 4}), representative) == 0);
    // Poses that the representative goes by are answered by one each: 3 frames, 2 cm away.
    CHECK(squared_stand_in_error(curve({0, 2, 4}, 2), representative) == Approx(3 * 4));
    CHECK(squared_stand_in_error(curve({0}, 2), representative) == Approx(4));
    CHECK_THROWS_AS(squared_stand_in_error(MatrixF(0, 3), representative), std::invalid_argument);
    CHECK_THROWS_AS(squared_stand_in_error(MatrixF::Zero(2, 4), representative),
                    std::invalid_argument);
}
