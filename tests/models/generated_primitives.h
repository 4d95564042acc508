// The cycles of generated takes, as primitives with known labels.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinetome/features/effectors.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/corpus_primitive.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "kinetome/synthesis/take.h"

struct GeneratedPrimitives {
    kinetome::MatrixF features;  ///< stacked effectors at 30 Hz, take below take
    std::vector<kinetome::CorpusPrimitive> primitives;
    std::vector<std::string> labels;
};

/// Of takes of 12 s, twelve of them a performer's.
inline GeneratedPrimitives generated_primitives(int64_t takes, uint64_t seed = 21) {
    using namespace kinetome;
    GeneratedPrimitives result;
    std::vector<MatrixF> parts;
    int64_t frames = 0;
    for (int64_t take = 0; take < takes; ++take) {
        const int64_t subject = 1 + take / 12;
        const TakePlan plan = plan_take(take, 1440, subject, 1 + take % 12, seed);
        const Clip clip = resample(perform(plan, make_subject(subject, seed), seed), 30);
        parts.push_back(stack_neighbours(
            effector_positions(*clip.skeleton, clip.motion, joint_positions(clip))));
        for (const CycleRow& cycle : annotate(plan).cycles) {
            const auto row = [&](int64_t frame) {
                return frames +
                       std::min<int64_t>(std::lround(double(frame) / 4), clip.motion.rows());
            };
            result.primitives.push_back({take, {row(cycle.first), row(cycle.end)}});
            result.labels.push_back(cycle.label);
        }
        frames += parts.back().rows();
    }
    result.features.resize(frames, 45);
    int64_t first = 0;
    for (const MatrixF& part : parts) {
        result.features.middleRows(first, part.rows()) = part;
        first += part.rows();
    }
    return result;
}
