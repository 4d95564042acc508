#include "kinetome/models/compressed_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "byte_numbers.h"

namespace kinetome {
namespace {

constexpr int64_t root_columns = 4;
constexpr int64_t most_frames = int64_t{1} << 24;  // of a block

/// Rounded values of a column as what they differ by from their straight continuation, begun anew
/// where told.
class Continuation {
  public:
    void begin() { known_ = 0; }
    /// What comes next if nothing changes.
    int64_t expected() const { return known_ == 0 ? 0 : known_ == 1 ? last_ : 2 * last_ - before_; }
    void follow(int64_t value) {
        before_ = last_;
        last_ = value;
        known_ = std::min(known_ + 1, 2);
    }

  private:
    int64_t before_ = 0, last_ = 0;
    int known_ = 0;
};

VectorD root_steps(const MotionSteps& steps) {
    VectorD all(root_columns);
    all << steps.place, steps.place, steps.place, steps.heading;
    return all;
}

/// Frames [first, end) on one model.
struct ModelRun {
    int64_t first, end;
};

std::vector<ModelRun> runs_of(const std::vector<int32_t>& models) {
    std::vector<ModelRun> runs;
    for (size_t frame = 0; frame < models.size(); ++frame) {
        if (frame == 0 || models[frame] != models[frame - 1]) {
            const auto first = static_cast<int64_t>(frame);
            runs.push_back({first, first});
        }
        ++runs.back().end;
    }
    return runs;
}

}  // namespace

MatrixD root_track(const MatrixFView& positions, const MatrixFView& normalised) {
    MatrixD root(positions.rows(), root_columns);
    double heading = 0;
    for (Eigen::Index i = 0; i < root.rows(); ++i) {
        // The turn about the vertical that brings the normalised markers nearest to the others.
        double along = 0, across = 0;
        for (Eigen::Index c = 0; c < positions.cols(); c += 3) {
            const double x = double(positions(i, c)) - double(positions(i, 0));
            const double z = double(positions(i, c + 2)) - double(positions(i, 2));
            const double nx = double(normalised(i, c)), nz = double(normalised(i, c + 2));
            along += nx * x + nz * z;
            across += nz * x - nx * z;
        }
        const double turn = std::atan2(across, along) - heading;
        heading += std::remainder(turn, 2 * std::numbers::pi);
        root.row(i) << double(positions(i, 0)), double(positions(i, 1)), double(positions(i, 2)),
            heading;
    }
    return root;
}

MatrixF world_positions(const MatrixFView& normalised, const MatrixDView& root) {
    MatrixF positions(normalised.rows(), normalised.cols());
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const double cosine = std::cos(root(i, 3)), sine = std::sin(root(i, 3));
        for (Eigen::Index c = 0; c < positions.cols(); c += 3) {
            const double x = double(normalised(i, c)), z = double(normalised(i, c + 2));
            positions(i, c) = float(root(i, 0) + cosine * x + sine * z);
            positions(i, c + 1) = float(root(i, 1) + double(normalised(i, c + 1)));
            positions(i, c + 2) = float(root(i, 2) - sine * x + cosine * z);
        }
    }
    return positions;
}

LeafFrames on_leaves(const PoseHierarchy& hierarchy, const LeafModels& models,
                     const MatrixFView& poses, const MatrixDView& root) {
    LeafFrames frames{{}, MatrixD(poses.rows(), models.dimension()), root};
    for (Eigen::Index i = 0; i < poses.rows(); ++i) {
        const std::span<const float> pose(poses.data() + i * poses.outerStride(),
                                          static_cast<size_t>(poses.cols()));
        const int32_t leaf = leaf_of(hierarchy, pose);
        const auto place = std::ranges::lower_bound(models.leaves(), leaf);
        if (place == models.leaves().end() || *place != leaf) {
            throw std::invalid_argument("a pose falls in a leaf that was not to be stored");
        }
        frames.models.push_back(static_cast<int32_t>(place - models.leaves().begin()));
        frames.coordinates.row(i) = models.coordinates(frames.models.back(), pose).transpose();
    }
    return frames;
}

std::string encode_block(const LeafFrames& frames, const MotionSteps& steps) {
    NumberWriter out;
    const auto runs = runs_of(frames.models);
    out.put(static_cast<int64_t>(runs.size()));
    for (const ModelRun& run : runs) {
        out.put(frames.models[static_cast<size_t>(run.first)]);
        out.put(run.end - run.first);
    }
    const auto put_column = [&](const MatrixD& values, Eigen::Index column, const ModelRun& rows,
                                double step) {
        Continuation continuation;
        for (int64_t i = rows.first; i < rows.end; ++i) {
            const int64_t value = std::llround(values(i, column) / step);
            out.put(value - continuation.expected());
            continuation.follow(value);
        }
    };
    for (const ModelRun& run : runs) {
        for (Eigen::Index c = 0; c < frames.coordinates.cols(); ++c) {
            put_column(frames.coordinates, c, run, steps.coordinate);
        }
    }
    const VectorD of_root = root_steps(steps);
    for (Eigen::Index c = 0; c < root_columns; ++c) {
        put_column(frames.root, c, {0, frames.root.rows()}, of_root[c]);
    }
    return out.take();
}

LeafFrames decode_block(std::string_view bytes, const LeafModels& models,
                        const MotionSteps& steps) {
    NumberReader in(bytes);
    LeafFrames frames;
    for (int64_t left = in.get(0, most_frames); left > 0; --left) {
        const auto model = static_cast<int32_t>(in.get(0, models.size() - 1));
        const int64_t count = in.get(1, most_frames - static_cast<int64_t>(frames.models.size()));
        frames.models.insert(frames.models.end(), static_cast<size_t>(count), model);
    }
    const auto count = static_cast<Eigen::Index>(frames.models.size());
    frames.coordinates.resize(count, models.dimension());
    frames.root.resize(count, root_columns);
    const auto get_column = [&](MatrixD& values, Eigen::Index column, const ModelRun& rows,
                                double step) {
        Continuation continuation;
        for (int64_t i = rows.first; i < rows.end; ++i) {
            const int64_t value = continuation.expected() + in.get();
            continuation.follow(value);
            values(i, column) = step * double(value);
        }
    };
    for (const ModelRun& run : runs_of(frames.models)) {
        for (Eigen::Index c = 0; c < frames.coordinates.cols(); ++c) {
            get_column(frames.coordinates, c, run, steps.coordinate);
        }
    }
    const VectorD of_root = root_steps(steps);
    for (Eigen::Index c = 0; c < root_columns; ++c) {
        get_column(frames.root, c, {0, count}, of_root[c]);
    }
    if (!in.at_end()) throw std::out_of_range("a compressed block is longer than its frames");
    return frames;
}

MatrixF poses_of(const LeafFrames& frames, const LeafModels& models, const LeafBlend& blend) {
    const auto count = static_cast<Eigen::Index>(frames.models.size());
    MatrixD poses(count, models.columns());
    for (Eigen::Index i = 0; i < count; ++i) {
        const VectorD coordinates = frames.coordinates.row(i).transpose();
        poses.row(i) = models.pose(frames.models[static_cast<size_t>(i)], coordinates).transpose();
    }
    const auto runs = runs_of(frames.models);
    MatrixD blended = poses;
    for (size_t r = 1; r < runs.size(); ++r) {
        const ModelRun &before = runs[r - 1], &after = runs[r];
        const int64_t at = after.first;
        // A step each side takes at its own speed, where it has one.
        VectorD leap = (poses.row(at) - poses.row(at - 1)).transpose();
        const bool moves_before = before.end - before.first > 1;
        const bool moves_after = after.end - after.first > 1;
        VectorD speed = VectorD::Zero(models.columns());
        if (moves_before) speed += (poses.row(at - 1) - poses.row(at - 2)).transpose();
        if (moves_after) speed += (poses.row(at + 1) - poses.row(at)).transpose();
        if (moves_before && moves_after) speed /= 2;
        leap -= speed;
        const auto reach = [&](const ModelRun& run) {
            return std::min(blend.frames, (run.end - run.first + 1) / 2);
        };
        const int64_t back = reach(before), forth = reach(after);
        for (int64_t i = 0; i < back; ++i) {
            const double share = 0.5 * (1 - double(i) / double(back));
            blended.row(at - 1 - i) += share * leap.transpose();
        }
        for (int64_t i = 0; i < forth; ++i) {
            const double share = 0.5 * (1 - double(i) / double(forth));
            blended.row(at + i) -= share * leap.transpose();
        }
    }
    return blended.cast<float>();
}

std::vector<double> errors_of(const MatrixFView& poses, const MatrixFView& decoded) {
    if (poses.rows() != decoded.rows() || poses.cols() != decoded.cols()) {
        throw std::invalid_argument("poses can be compared with as many decoded ones alone");
    }
    std::vector<double> errors;
    for (Eigen::Index i = 0; i < poses.rows(); ++i) {
        const std::span<const float> pose(poses.data() + i * poses.outerStride(),
                                          static_cast<size_t>(poses.cols()));
        errors.push_back(pose_error(pose, decoded.row(i).cast<double>().transpose()));
    }
    return errors;
}

PoseErrors summary_of(std::vector<double> errors) {
    PoseErrors summary;
    if (errors.empty()) return summary;
    double squares = 0;
    for (const double error : errors) {
        summary.mean += error;
        squares += error * error;
    }
    const auto count = static_cast<double>(errors.size());
    summary.mean /= count;
    summary.rms = std::sqrt(squares / count);
    std::ranges::sort(errors);
    summary.share_95 = errors[static_cast<size_t>(std::ceil(0.95 * count)) - 1];
    summary.greatest = errors.back();
    return summary;
}

PoseErrors pose_errors(const MatrixFView& poses, const MatrixFView& decoded) {
    return summary_of(errors_of(poses, decoded));
}

}  // namespace kinetome
