#include "kinetome/models/skeleton_fit.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kinetome {

SkeletonFit::SkeletonFit(std::shared_ptr<const Skeleton> skeleton,
                         const SkeletonFitOptions& options)
    : skeleton_(std::move(skeleton)),
      options_(options),
      chain_(*skeleton_),
      motions_(static_cast<size_t>(skeleton_->dof_count())),
      targets_(3 * skeleton_->joint_count()),
      rest_(skeleton_->dof_count()),
      weights_(skeleton_->dof_count()) {
    Eigen::Index dof = 0;
    for (const Joint& joint : skeleton_->joints()) {
        for (const Channel channel : joint.channels) {
            weights_[dof++] = is_rotation(channel) ? options_.rest : 0;
        }
    }
    // A degree of freedom never moves joints that do not hang on it: those slopes stay 0.
    slopes_ = MatrixD::Zero(rest_.size(), targets_.size());
}

void SkeletonFit::residuals(std::span<const float> dofs, VectorD& result) {
    chain_.evaluate(dofs, pose_);
    result.resize(targets_.size() + rest_.size());
    for (size_t joint = 0; joint < pose_.positions.size(); ++joint) {
        result.segment<3>(static_cast<Eigen::Index>(3 * joint)) = pose_.positions[joint];
    }
    result.head(targets_.size()) -= targets_;
    for (Eigen::Index dof = 0; dof < rest_.size(); ++dof) {
        result[targets_.size() + dof] =
            weights_[dof] * (double(dofs[static_cast<size_t>(dof)]) - rest_[dof]);
    }
}

void SkeletonFit::differentiate(std::span<const float> dofs, const VectorD& at) {
    chain_.evaluate(dofs, pose_, motions_);
    for (int joint = 0; joint < skeleton_->joint_count(); ++joint) {
        const Eigen::Vector3d& position = pose_.positions[static_cast<size_t>(joint)];
        for (int mover = joint; mover >= 0;) {
            const Joint& moving = skeleton_->joints()[static_cast<size_t>(mover)];
            const int first = skeleton_->first_dof(mover);
            for (int dof = first; dof < first + static_cast<int>(moving.channels.size()); ++dof) {
                slopes_.row(dof).segment<3>(3 * joint) =
                    motions_[static_cast<size_t>(dof)].at(position);
            }
            mover = moving.parent;
        }
    }
    normal_.setZero(rest_.size(), rest_.size());
    normal_.selfadjointView<Eigen::Lower>().rankUpdate(slopes_);
    normal_.diagonal() += weights_.cwiseAbs2();
    gradient_ = slopes_ * at.head(targets_.size());
    gradient_ += weights_.cwiseProduct(at.tail(rest_.size()));
}

double SkeletonFit::fit(std::span<const float> positions, std::span<const float> rest,
                        std::span<float> dofs) {
    if (static_cast<Eigen::Index>(positions.size()) != targets_.size() ||
        static_cast<Eigen::Index>(rest.size()) != rest_.size() || rest.size() != dofs.size()) {
        throw std::invalid_argument("a skeleton is fitted to positions of its own joints");
    }
    for (size_t i = 0; i < positions.size(); ++i) {
        targets_[static_cast<Eigen::Index>(i)] = double(positions[i]);
    }
    for (size_t i = 0; i < rest.size(); ++i) {
        rest_[static_cast<Eigen::Index>(i)] = double(rest[i]);
    }
    VectorD here;
    residuals(dofs, here);
    double damping = 1e-6;
    std::vector<float> next(dofs.size());
    for (int i = 0; i < options_.iterations; ++i) {
        differentiate(dofs, here);
        normal_.diagonal() += damping * (normal_.diagonal().array() + 1).matrix();
        const VectorD step = normal_.selfadjointView<Eigen::Lower>().ldlt().solve(-gradient_);
        for (size_t dof = 0; dof < next.size(); ++dof) {
            next[dof] = float(double(dofs[dof]) + step[static_cast<Eigen::Index>(dof)]);
        }
        VectorD there;
        residuals(next, there);
        if (!(there.squaredNorm() < here.squaredNorm())) {
            if (step.cwiseAbs().maxCoeff() < options_.close) break;
            damping = damping * 100 + 1e-6;
            continue;
        }
        std::copy(next.begin(), next.end(), dofs.begin());
        here = there;
        damping /= 10;
        if (step.cwiseAbs().maxCoeff() < options_.close) break;
    }
    return here.squaredNorm();
}

namespace {

/// From far away the steps that a frame takes from the one before do not lead all the way.
void fit_from_afar(SkeletonFit& fit, std::span<const float> positions, std::span<const float> rest,
                   std::span<float> dofs) {
    constexpr int most_times = 50;
    constexpr double least_gain = 1e-3;  // of what is left
    double left = fit.fit(positions, rest, dofs);
    for (int time = 1; time < most_times; ++time) {
        const double before = left;
        left = fit.fit(positions, rest, dofs);
        if (left > (1 - least_gain) * before) return;
    }
}

}  // namespace

MatrixF fit_frames(SkeletonFit& fit, const MatrixFView& positions, std::span<const float> start,
                   std::span<const float> end, int64_t frames) {
    MatrixF motion(positions.rows(), static_cast<Eigen::Index>(start.size()));
    std::vector<float> dofs(start.begin(), start.end()), rest(start.size());
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const float passed = float(i) / float(frames);
        for (size_t dof = 0; dof < rest.size(); ++dof) {
            rest[dof] = start[dof] + passed * (end[dof] - start[dof]);
        }
        const std::span<const float> row(positions.data() + i * positions.outerStride(),
                                         static_cast<size_t>(positions.cols()));
        if (i == 0)
            fit_from_afar(fit, row, rest, dofs);
        else
            fit.fit(row, rest, dofs);
        std::copy(dofs.begin(), dofs.end(), motion.row(i).data());
    }
    return motion;
}

}  // namespace kinetome
