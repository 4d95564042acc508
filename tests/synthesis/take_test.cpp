#include "kinetome/synthesis/take.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinetome/formats/kinematics.h"
#include "kinetome/synthesis/corpus_generator.h"

using namespace kinetome;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr uint64_t seed = 12;

struct Take {
    TakePlan plan;
    Subject subject;
    Clip clip;
    MatrixF positions;
    Annotations rows;

    Eigen::Vector3d at(int64_t frame, const std::string& joint) const {
        const int j = *subject.skeleton->find(joint);
        return positions.row(frame).segment<3>(3 * j).transpose().cast<double>();
    }
    double angle(int64_t frame, const std::string& joint, int channel = 0) const {
        const int j = *subject.skeleton->find(joint);
        return clip.motion(frame, subject.skeleton->first_dof(j) + channel);
    }
};

/// Forty takes of as many subjects, half a minute each: made once for all tests.
const std::vector<Take>& takes() {
    static const std::vector<Take> made = [] {
        std::vector<Take> all;
        for (int64_t index = 0; index < 40; ++index) {
            Take take{plan_take(index, 1500, index + 1, 1, seed),
                      make_subject(index + 1, seed),
                      {},
                      {},
                      {}};
            take.clip = perform(take.plan, take.subject, seed);
            take.positions = joint_positions(take.clip);
            take.rows = annotate(take.plan);
            all.push_back(std::move(take));
        }
        return all;
    }();
    return made;
}

/// Calls visit(take, first, end) for each segment of a label, its blends left out.
template <class Visit>
int for_each_segment(std::string_view label, Visit&& visit) {
    int visited = 0;
    for (const Take& take : takes()) {
        int64_t blended = 0;
        for (const SegmentPlan& segment : take.plan.segments) {
            const int64_t first = std::max(segment.first, blended);
            if (activity_name(segment.label()) == label && segment.blend_first - first > 120) {
                visit(take, first, segment.blend_first);
                ++visited;
            }
            blended = segment.blend_end;
        }
    }
    return visited;
}

double range_of(const Take& take, int64_t first, int64_t end, const std::string& joint) {
    double low = 1e9, high = -1e9;
    for (int64_t frame = first; frame < end; ++frame) {
        low = std::min(low, take.angle(frame, joint));
        high = std::max(high, take.angle(frame, joint));
    }
    return high - low;
}

constexpr int64_t stride = 8;  // frames over which a speed is taken: sensor noise averages out

double floor_speed(const Take& take, int64_t frame, const std::string& joint) {
    Eigen::Vector3d step = take.at(frame + stride, joint) - take.at(frame, joint);
    step.y() = 0;
    return step.norm() * synthesis_rate / stride;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values.at(values.size() / 2);
}

}  // namespace

TEST_CASE("no joint pops: none turns faster than 25 rad/s, no root jumps") {
    for (const Take& take : takes()) {
        const Skeleton& skeleton = *take.subject.skeleton;
        for (int j = 0; j < skeleton.joint_count(); ++j) {
            const Joint& joint = skeleton.joints()[static_cast<size_t>(j)];
            Eigen::Matrix3d before;
            for (int64_t frame = 0; frame < take.clip.frames(); ++frame) {
                const float* dofs = take.clip.motion.row(frame).data() + skeleton.first_dof(j);
                const Eigen::Matrix3d now = local_rotation(joint, {dofs, joint.channels.size()});
                if (frame > 0) {
                    const double cosine = ((before.transpose() * now).trace() - 1) / 2;
                    const double speed = std::acos(std::clamp(cosine, -1.0, 1.0)) * synthesis_rate;
                    if (speed >= 25)
                        FAIL(joint.name << " of take " << take.plan.index << " at " << frame << ": "
                                        << speed << " rad/s");
                }
                before = now;
            }
        }
        for (int64_t frame = 1; frame < take.clip.frames(); ++frame)
            if ((take.at(frame, "root") - take.at(frame - 1, "root")).norm() > 6)
                FAIL("the root of take " << take.plan.index << " jumps at " << frame);
    }
    SUCCEED();
}

TEST_CASE("joints stay within what bodies can do") {
    // A ball joint's three angles have no limits of their own: shoulders are left out.
    for (const Take& take : takes()) {
        const Skeleton& skeleton = *take.subject.skeleton;
        for (int j = 1; j < skeleton.joint_count(); ++j) {
            const Joint& joint = skeleton.joints()[static_cast<size_t>(j)];
            if (joint.name.ends_with("humerus")) continue;
            for (size_t i = 0; i < joint.channels.size(); ++i) {
                const auto column =
                    take.clip.motion.col(skeleton.first_dof(j) + static_cast<int>(i));
                INFO(joint.name << " channel " << i << " of take " << take.plan.index);
                CHECK(static_cast<double>(column.minCoeff()) > joint.limits[i].first - 3 * degree);
                CHECK(static_cast<double>(column.maxCoeff()) < joint.limits[i].second + 3 * degree);
            }
        }
    }
}

TEST_CASE("feet do not sink into the floor and leave it only to run, jump and kick") {
    for (const Take& take : takes()) {
        std::vector<double> lowest;
        for (int64_t frame = 0; frame < take.clip.frames(); ++frame)
            lowest.push_back(
                std::min(std::min(take.at(frame, "ltoes").y(), take.at(frame, "rtoes").y()),
                         std::min(take.at(frame, "lfoot").y(), take.at(frame, "rfoot").y())));
        INFO("take " << take.plan.index);
        CHECK(*std::ranges::min_element(lowest) > -4);
        CHECK(median(lowest) < 6);
        CHECK(median(lowest) > -1);
    }
    for (const char* label : {"walk", "squat", "idle", "punch_left", "wave"}) {
        for_each_segment(label, [&](const Take& take, int64_t first, int64_t end) {
            for (int64_t frame = first; frame < end; ++frame)
                if (std::min(take.at(frame, "lfoot").y(), take.at(frame, "rfoot").y()) > 8)
                    FAIL(label << " leaves the floor in take " << take.plan.index << " at "
                               << frame);
        });
    }
}

TEST_CASE("walking travels, and the foot on the floor stays where it is") {
    const int seen = for_each_segment("walk", [](const Take& take, int64_t first, int64_t end) {
        std::vector<double> body, foot;
        for (int64_t frame = first; frame + stride < end; ++frame) {
            body.push_back(floor_speed(take, frame, "root"));
            foot.push_back(
                std::min(floor_speed(take, frame, "lfoot"), floor_speed(take, frame, "rfoot")));
        }
        INFO("take " << take.plan.index << ", frames " << first << " to " << end);
        CHECK(median(body) > 60);
        CHECK(median(body) < 260);
        CHECK(median(foot) < 0.10 * median(body));
    });
    CHECK(seen > 5);
}

TEST_CASE("running is quicker than walking and has moments with both feet in the air") {
    std::vector<double> walking, running;
    for_each_segment("walk", [&](const Take& take, int64_t first, int64_t end) {
        for (int64_t frame = first; frame + stride < end; ++frame)
            walking.push_back(floor_speed(take, frame, "root"));
    });
    const int seen = for_each_segment("run", [&](const Take& take, int64_t first, int64_t end) {
        int64_t airborne = 0;
        for (int64_t frame = first; frame + stride < end; ++frame) {
            running.push_back(floor_speed(take, frame, "root"));
            airborne += std::min(take.at(frame, "ltoes").y(), take.at(frame, "rtoes").y()) > 5;
        }
        CHECK(airborne > (end - first) / 20);
    });
    CHECK(seen > 2);
    CHECK(median(running) > 1.3 * median(walking));
}

TEST_CASE("a punch is thrown with the arm that its label names") {
    int seen = 0;
    for (const auto& [label, own, other] : {std::tuple("punch_left", "lradius", "rradius"),
                                            std::tuple("punch_right", "rradius", "lradius")}) {
        seen += for_each_segment(label, [&](const Take& take, int64_t first, int64_t end) {
            INFO(label << " in take " << take.plan.index);
            // A hook straightens the elbow least.
            CHECK(range_of(take, first, end, own) > 1.4 * range_of(take, first, end, other));
        });
    }
    CHECK(seen > 5);
}

TEST_CASE("a kick lifts the foot that its label names") {
    int seen = 0;
    for (const auto& [label, own, other] :
         {std::tuple("kick_left", "lfoot", "rfoot"), std::tuple("kick_right", "rfoot", "lfoot")}) {
        seen += for_each_segment(label, [&](const Take& take, int64_t first, int64_t end) {
            double highest = 0, highest_other = 0;
            for (int64_t frame = first; frame < end; ++frame) {
                highest = std::max(highest, take.at(frame, own).y());
                highest_other = std::max(highest_other, take.at(frame, other).y());
            }
            CHECK(highest > 50);
            CHECK(highest_other < 20);
        });
    }
    CHECK(seen > 3);
}

TEST_CASE("the motion repeats with the period that the cycles state") {
    // The angle that shows an activity's cycle best, against itself shifted: the best shift between
    // half and one and a half periods is one period.
    int seen = 0;
    for (const auto& [label, joint] :
         {std::pair("walk", "lfemur"), std::pair("run", "lfemur"), std::pair("squat", "ltibia"),
          std::pair("punch_left", "lradius"), std::pair("punch_right", "rradius"),
          std::pair("jump", "ltibia"), std::pair("kick_left", "ltibia")}) {
        seen += for_each_segment(label, [&](const Take& take, int64_t first, int64_t end) {
            double sum = 0;
            int64_t cycles = 0;
            for (const CycleRow& cycle : take.rows.cycles) {
                if (cycle.first < first || cycle.end > end + 40 || cycle.label != label) continue;
                sum += static_cast<double>(cycle.end - cycle.first);
                ++cycles;
            }
            if (cycles < 3) return;
            const double period = sum / static_cast<double>(cycles);
            int64_t best_shift = 0;
            double least = 1e9;
            for (auto shift = std::llround(0.5 * period); shift < std::llround(1.5 * period);
                 ++shift) {
                double difference = 0;
                for (int64_t frame = first; frame + shift < end; ++frame) {
                    const double step = take.angle(frame, joint) - take.angle(frame + shift, joint);
                    difference += step * step;
                }
                difference /= static_cast<double>(end - first - shift);
                if (difference < least) {
                    least = difference;
                    best_shift = shift;
                }
            }
            INFO(label << " in take " << take.plan.index << ", frames " << first << " to " << end);
            CHECK(static_cast<double>(best_shift) == Approx(period).epsilon(0.08));
        });
    }
    CHECK(seen > 20);
}

TEST_CASE("no two cycles are the same, as nobody's are") {
    const Take& take = takes().front();
    for (int64_t frame = 1; frame < take.clip.frames(); ++frame)
        CHECK((take.clip.motion.row(frame) - take.clip.motion.row(frame - 1)).cwiseAbs().sum() > 0);
    const CycleRow first = take.rows.cycles.at(0), second = take.rows.cycles.at(1);
    double difference = 0;
    for (int64_t i = 0; i < std::min(first.end - first.first, second.end - second.first); ++i)
        difference = std::max(difference, std::abs(take.angle(first.first + i, "lradius") -
                                                   take.angle(second.first + i, "lradius")));
    CHECK(difference > 0.5 * degree);
}
