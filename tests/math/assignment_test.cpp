#include "kinetome/math/assignment.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>
#include <set>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

double worth(const MatrixD& values, const std::vector<int32_t>& columns) {
    double sum = 0;
    for (size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] >= 0) sum += values(static_cast<int64_t>(i), columns[i]);
    }
    return sum;
}

/// The best of all ways to give the shorter side's members one of the longer side's each.
double best_worth_by_trying_all(const MatrixD& values) {
    const MatrixD wide = values.rows() <= values.cols() ? values : MatrixD(values.transpose());
    std::vector<int32_t> order(static_cast<size_t>(wide.cols()));
    std::iota(order.begin(), order.end(), 0);
    double best = -std::numeric_limits<double>::infinity();
    do {
        best = std::max(best, worth(wide, {order.begin(), order.begin() + wide.rows()}));
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

}  // namespace

TEST_CASE("no assignment is worth more, of whatever shape the values are") {
    RandomStream random(1, "assignment");
    for (int64_t rows = 1; rows <= 6; ++rows) {
        for (int64_t columns = 1; columns <= 6; ++columns) {
            for (int trial = 0; trial < 20; ++trial) {
                // Few different values, so that many assignments tie; some are negative.
                MatrixD values(rows, columns);
                for (double& value : values.reshaped()) value = double(random.below(7)) - 2;
                const std::vector<int32_t> chosen = best_assignment(values);
                REQUIRE(chosen.size() == static_cast<size_t>(rows));
                CHECK(worth(values, chosen) == best_worth_by_trying_all(values));
                std::set<int32_t> used(chosen.begin(), chosen.end());
                used.erase(-1);
                CHECK(static_cast<int64_t>(used.size()) == std::min(rows, columns));
            }
        }
    }
}

TEST_CASE("taking the largest value first is not good enough") {
    MatrixD values(2, 2);
    values << 10, 9, 9, 0;
    CHECK(best_assignment(values) == std::vector<int32_t>{1, 0});
}

TEST_CASE("nothing to assign is no error, what is not a number is") {
    CHECK(best_assignment(MatrixD(0, 3)).empty());
    CHECK(best_assignment(MatrixD(2, 0)) == std::vector<int32_t>{-1, -1});
    CHECK_THROWS_AS(best_assignment(MatrixD::Constant(1, 1, std::nan(""))), std::invalid_argument);
}
