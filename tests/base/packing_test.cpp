#include "kinetome/base/packing.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("what is packed comes back in the same order with the same bits") {
    Packer out;
    const std::vector<double> values = {1.5, -0.0, 1e300};
    out.put<int64_t>(-7).put(std::span<const double>(values)).put(std::string_view("a\0b", 3));
    MatrixF matrix(2, 3);
    matrix << 1, 2, 3, 4, 5, 6;
    pack(out, matrix);
    pack(out, VectorD(VectorD::Constant(2, 0.1)));
    pack(out, MatrixD(0, 4));
    pack(out, std::vector<int32_t>{});

    Unpacker in(out.take());
    CHECK(in.get<int64_t>() == -7);
    const auto back = in.get_all<double>();
    CHECK(back == values);
    CHECK(std::signbit(back[1]));
    CHECK(in.get_text() == std::string("a\0b", 3));
    MatrixF other;
    unpack(in, other);
    CHECK(other == matrix);
    VectorD vector;
    unpack(in, vector);
    CHECK(vector == VectorD::Constant(2, 0.1));
    MatrixD empty;
    unpack(in, empty);
    CHECK((empty.rows() == 0 && empty.cols() == 4));
    std::vector<int32_t> none{1};
    unpack(in, none);
    CHECK(none.empty());
    CHECK(in.left() == 0);
}

TEST_CASE("a message cut short or of another shape is refused, never read beyond its end") {
    MatrixD matrix = MatrixD::Random(3, 4);
    const std::string whole = packed(matrix);
    for (size_t size = 0; size < whole.size(); ++size) {
        CHECK_THROWS_AS(unpacked<MatrixD>(whole.substr(0, size)), std::out_of_range);
    }
    Packer out;
    out.put<int64_t>(5).put<int64_t>(4).put(std::span<const double>(matrix.data(), 12));
    CHECK_THROWS_AS(unpacked<MatrixD>(out.take()), std::out_of_range);
    Packer huge;
    huge.put<uint64_t>(~uint64_t{0});
    CHECK_THROWS_AS(unpacked<std::vector<double>>(huge.take()), std::out_of_range);
}
