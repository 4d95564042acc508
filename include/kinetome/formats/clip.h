// One take: a skeleton and its motion.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

struct Clip {
    std::shared_ptr<const Skeleton> skeleton;
    MatrixF motion;                          ///< frames × dof_count; cm and radians
    double rate = 120.0;                     ///< frames a second
    std::vector<std::string> warnings = {};  ///< what the reader found odd and how it went on

    int64_t frames() const { return motion.rows(); }
};

}  // namespace kinetome
