// How performers differ: from each other, from take to take, from one activity to the next and from
// cycle to cycle.
#pragma once

#include "kinetome/base/random.h"
#include "kinetome/synthesis/activity.h"
#include "kinetome/synthesis/posture.h"

namespace kinetome {

struct Style {
    Traits traits = usual_traits();
    Posture carriage;  ///< added to every posture: how one holds oneself

    /// Traits multiplied or added as their kind asks, carriages added.
    Style& operator+=(const Style& other);
};

/// A random departure from the norm; `spread` scales it (1: as two people differ).
Style random_style(double spread, RandomStream& random);

/// The departure of one cycle from its neighbours.
Traits random_cycle_traits(double spread, RandomStream& random);

/// `base` with the factors of `change` multiplied and its offsets added.
Traits combine(const Traits& base, const Traits& change);

/// Draws the traits whose meaning depends on the activity (a turn, a second form).
void choose_form(Activity activity, Traits& traits, RandomStream& random);

}  // namespace kinetome
