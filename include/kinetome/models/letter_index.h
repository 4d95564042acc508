// Where each letter of a motion string occurs, and which are accessible from it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"

namespace kinetome {

/// Inverted index of a motion string. Letters that do not occur have no positions.
class LetterIndex {
  public:
    /// Throws std::invalid_argument for a letter that the matrix does not have.
    LetterIndex(const MotionString& string, const AccessibilityMatrix& accessibility);

    /// Where a letter stands in the string, ascending.
    std::span<const int32_t> positions(int32_t letter) const;
    /// Where any letter accessible from it stands, ascending: its own positions among them.
    std::span<const int32_t> accessible_positions(int32_t letter) const;

  private:
    using Lists = std::vector<std::vector<int32_t>>;
    Lists positions_, accessible_;  ///< by letter
};

}  // namespace kinetome
