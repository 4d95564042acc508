// Animation curves: a value that goes through keys and comes back to the first.
#pragma once

#include <initializer_list>
#include <vector>

namespace kinetome {

/// Periodic in the phase with period 1; cubic between keys, without overshoot: slopes by the rule
/// of Fritsch & Carlson (1980), zero where a key is a turning point. Once differentiable.
class Curve {
  public:
    struct Key {
        double phase;  ///< in [0, 1), increasing
        double value;
    };

    /// Throws std::invalid_argument when phases do not increase inside [0, 1).
    Curve(std::initializer_list<Key> keys);

    /// Any phase; only its fraction counts.
    double operator()(double phase) const;

  private:
    struct Knot {
        double phase, value, slope;
    };
    std::vector<Knot> knots_;  ///< the keys, with the last one also a turn before the first and
                               ///< the first one also a turn after the last
};

/// Cubic from (0, from) to (1, to) with the given slopes.
double hermite(double at, double from, double to, double slope_from, double slope_to);

/// 0 at 0, 1 at 1, level at both; clamped outside.
double smooth_step(double at);

/// The part of a number above its floor, in [0, 1).
double fraction(double value);

}  // namespace kinetome
