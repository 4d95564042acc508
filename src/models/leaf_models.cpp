#include <cmath>

#include "byte_numbers.h"
#include "kinetome/models/compressed_motion.h"

namespace kinetome {
namespace {

constexpr double mean_step = 0.01;              // cm
constexpr double basis_step = 1.0 / (1 << 14);  // entries of unit vectors
constexpr int64_t most = int64_t{1} << 30;      // of leaves, columns and rounded entries

int64_t rounded(double value, double step) {
    return std::llround(value / step);
}

}  // namespace

LeafModels::LeafModels(const PoseHierarchy& hierarchy, std::vector<int32_t> leaves)
    : dimension_(hierarchy.dimension()), leaves_(std::move(leaves)) {
    const int64_t count = static_cast<int64_t>(leaves_.size()), columns = hierarchy.columns();
    means_.resize(count, columns);
    bases_.resize(count * columns, dimension_);
    for (int64_t i = 0; i < count; ++i) {
        const int32_t leaf = leaves_[static_cast<size_t>(i)];
        means_.row(i) = hierarchy.means.row(leaf);
        bases_.middleRows(i * columns, columns) = hierarchy.basis(leaf);
    }
    const auto round_to = [](double step) {
        return [step](double value) { return step * double(rounded(value, step)); };
    };
    means_ = means_.unaryExpr(round_to(mean_step)).eval();
    bases_ = bases_.unaryExpr(round_to(basis_step)).eval();
}

std::string LeafModels::bytes() const {
    NumberWriter out;
    out.put(size());
    out.put(columns());
    out.put(dimension_);
    int32_t last = 0;
    for (const int32_t leaf : leaves_) {
        out.put(leaf - last);
        last = leaf;
    }
    for (const double value : means_.reshaped<Eigen::RowMajor>())
        out.put(rounded(value, mean_step));
    for (const double value : bases_.reshaped<Eigen::RowMajor>())
        out.put(rounded(value, basis_step));
    return out.take();
}

LeafModels::LeafModels(std::string_view bytes) {
    NumberReader in(bytes);
    const int64_t count = in.get(0, most), columns = in.get(0, most);
    dimension_ = in.get(0, most);
    // A number takes a byte or more: so many are there at most.
    const auto room = static_cast<int64_t>(bytes.size());
    if (columns > room || dimension_ > room || count > room || count * columns > room ||
        count * columns * dimension_ > room) {
        throw std::out_of_range("compressed models end too early");
    }
    int32_t last = 0;
    for (int64_t i = 0; i < count; ++i) {
        last += static_cast<int32_t>(in.get(0, most));
        leaves_.push_back(last);
    }
    means_.resize(count, columns);
    bases_.resize(count * columns, dimension_);
    for (double& value : means_.reshaped<Eigen::RowMajor>()) {
        value = mean_step * double(in.get(-most, most));
    }
    for (double& value : bases_.reshaped<Eigen::RowMajor>()) {
        value = basis_step * double(in.get(-most, most));
    }
}

VectorD LeafModels::coordinates(int64_t model, std::span<const float> pose) const {
    const VectorD centred =
        Eigen::Map<const VectorF>(pose.data(), static_cast<Eigen::Index>(pose.size()))
            .cast<double>() -
        means_.row(model).transpose();
    return bases_.middleRows(model * columns(), columns()).transpose() * centred;
}

VectorD LeafModels::pose(int64_t model, const VectorD& coordinates) const {
    return means_.row(model).transpose() +
           bases_.middleRows(model * columns(), columns()) * coordinates;
}

}  // namespace kinetome
