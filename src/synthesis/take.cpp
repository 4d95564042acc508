#include "kinetome/synthesis/take.h"

#include <numbers>
#include <optional>
#include <vector>

#include "kinetome/synthesis/posture_solver.h"
#include "segment_player.h"
#include "wandering.h"

namespace kinetome {
namespace {

/// The posture the plan asks for, frame after frame.
class PlanPlayer {
  public:
    explicit PlanPlayer(const TakePlan& plan) : plan_(plan), now_(plan.segments.front()) {}

    Posture posture_at(int64_t frame) {
        const SegmentPlan* segment = &plan_.segments[segment_];
        if (frame >= segment->blend_end && segment_ + 1 < plan_.segments.size()) {
            segment = &plan_.segments[++segment_];
            now_ = next_ ? *next_ : SegmentPlayer(*segment);
            next_.reset();
        }
        const auto time = static_cast<double>(frame);
        const Posture posture = now_.posture_at(time);
        if (frame < segment->blend_first || segment_ + 1 == plan_.segments.size()) return posture;
        if (!next_) next_.emplace(plan_.segments[segment_ + 1]);
        const auto extent = static_cast<double>(segment->blend_end - segment->blend_first);
        const double at = (time - static_cast<double>(segment->blend_first)) / extent;
        return mix_with_steps(posture, next_->posture_at(time), at);
    }

  private:
    const TakePlan& plan_;
    size_t segment_ = 0;
    SegmentPlayer now_;
    std::optional<SegmentPlayer> next_;
};

}  // namespace

Subject make_subject(int64_t subject, uint64_t seed) {
    RandomStream random(seed, "subject body", static_cast<uint64_t>(subject));
    const Body body = random_body(random);
    TakePlan named;
    named.subject = subject;
    return {body, std::make_shared<const Skeleton>(make_skeleton(body, named.subject_name()))};
}

Clip perform(const TakePlan& plan, const Subject& subject, uint64_t seed) {
    const Skeleton& skeleton = *subject.skeleton;
    RandomStream random(seed, "performance", static_cast<uint64_t>(plan.index));
    PostureWandering wandering(random);
    JointNoise noise(skeleton, random);
    PostureSolver solver(subject.body, skeleton);
    PlanPlayer player(plan);
    TravelFrame travel{random.uniform(-150, 150), random.uniform(-150, 150),
                       random.uniform(-std::numbers::pi, std::numbers::pi)};

    Clip clip;
    clip.skeleton = subject.skeleton;
    clip.rate = synthesis_rate;
    clip.motion.resize(plan.frames, skeleton.dof_count());
    std::vector<double> dofs(static_cast<size_t>(skeleton.dof_count()));
    for (int64_t frame = 0; frame < plan.frames; ++frame) {
        Posture posture = player.posture_at(frame);
        wandering.add_to(posture, random);
        solver.solve(posture, travel, dofs);
        noise.add_to(dofs, random);
        for (size_t i = 0; i < dofs.size(); ++i)
            clip.motion(frame, static_cast<Eigen::Index>(i)) = static_cast<float>(dofs[i]);
        travel.advance(posture, subject.body.leg(), 1 / synthesis_rate);
    }
    return clip;
}

}  // namespace kinetome
