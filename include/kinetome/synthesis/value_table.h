// A number for each entry of an enumeration whose last entry is `count`.
#pragma once

#include <array>
#include <cstddef>

namespace kinetome {

template <class Key>
class ValueTable {
  public:
    static constexpr size_t size = static_cast<size_t>(Key::count);

    static ValueTable filled(double value) {
        ValueTable table;
        table.values_.fill(value);
        return table;
    }

    double& operator[](Key key) { return values_[static_cast<size_t>(key)]; }
    double operator[](Key key) const { return values_[static_cast<size_t>(key)]; }

    auto begin() { return values_.begin(); }
    auto end() { return values_.end(); }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }

    ValueTable& operator+=(const ValueTable& other) {
        for (size_t i = 0; i < size; ++i) values_[i] += other.values_[i];
        return *this;
    }
    ValueTable& operator*=(const ValueTable& other) {
        for (size_t i = 0; i < size; ++i) values_[i] *= other.values_[i];
        return *this;
    }

    /// (1 - weight) · a + weight · b.
    friend ValueTable mix(const ValueTable& a, const ValueTable& b, double weight) {
        ValueTable mixed;
        for (size_t i = 0; i < size; ++i)
            mixed.values_[i] = a.values_[i] + weight * (b.values_[i] - a.values_[i]);
        return mixed;
    }

  private:
    std::array<double, size> values_{};
};

}  // namespace kinetome
