#include "kinetome/synthesis/curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kinetome {

Curve::Curve(std::initializer_list<Key> keys) {
    const std::vector<Key> given(keys);
    if (given.empty()) throw std::invalid_argument("a curve needs a key");
    double last = -1e-9;
    for (const Key& key : given) {
        if (key.phase <= last || key.phase >= 1)
            throw std::invalid_argument("the keys of a curve must increase in phase inside [0, 1)");
        last = key.phase;
    }

    // Two more keys on either side than needed, so that every slope sees both neighbours.
    const auto count = static_cast<int>(given.size());
    for (int i = -2; i < count + 2; ++i) {
        const int turn = i < 0 ? (i - count + 1) / count : i / count;
        const Key& key = given[static_cast<size_t>(i - turn * count)];
        knots_.push_back({key.phase + turn, key.value, 0});
    }
    for (size_t i = 1; i + 1 < knots_.size(); ++i) {
        const double before_width = knots_[i].phase - knots_[i - 1].phase;
        const double after_width = knots_[i + 1].phase - knots_[i].phase;
        const double before = (knots_[i].value - knots_[i - 1].value) / before_width;
        const double after = (knots_[i + 1].value - knots_[i].value) / after_width;
        if (before * after <= 0) continue;
        const double w1 = 2 * after_width + before_width;
        const double w2 = after_width + 2 * before_width;
        knots_[i].slope = (w1 + w2) / (w1 / before + w2 / after);
    }
    knots_.erase(knots_.begin());
    knots_.pop_back();
}

double Curve::operator()(double phase) const {
    const double at = fraction(phase);
    size_t i = 1;
    while (i + 1 < knots_.size() && knots_[i].phase <= at) ++i;
    const Knot& from = knots_[i - 1];
    const Knot& to = knots_[i];
    const double width = to.phase - from.phase;
    return hermite((at - from.phase) / width, from.value, to.value, from.slope * width,
                   to.slope * width);
}

double hermite(double at, double from, double to, double slope_from, double slope_to) {
    const double rest = 1 - at;
    return rest * rest * ((1 + 2 * at) * from + at * slope_from) +
           at * at * ((1 + 2 * rest) * to - rest * slope_to);
}

double smooth_step(double at) {
    const double x = std::clamp(at, 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

double fraction(double value) {
    const double part = value - std::floor(value);
    return part < 1 ? part : 0;
}

}  // namespace kinetome
