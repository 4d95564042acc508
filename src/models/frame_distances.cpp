#include "frame_distances.h"

namespace kinetome {

void FrameDistances::from(int64_t frame, Eigen::Ref<RowVectorF> distances) const {
    auto squares = distances.array();
    squares.setZero();
    for (int64_t feature = 0; feature < columns_.rows(); ++feature) {
        squares += (columns_.row(feature).array() - columns_(feature, frame)).square();
    }
    squares = squares.sqrt();
}

}  // namespace kinetome
