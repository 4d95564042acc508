// Takes as normalised markers at 120 Hz, and the pose hierarchy they make: shared by benchmarks of
// the piecewise-linear model.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/math/row_source.h"
#include "kinetome/models/hierarchy_growth.h"
#include "kinetome/models/principal_markers.h"
#include "kinetome/synthesis/clip_variation.h"
#include "takes.h"

namespace kinetome::bench {

struct MarkerTake {
    std::string name;
    MatrixF markers;  ///< n × 3·joints, cm
};

inline MatrixF markers_of(const Clip& clip) {
    return normalised_markers(*clip.skeleton, clip.motion, joint_positions(clip));
}

struct NamedClip {
    std::string name;
    Clip clip;
};

/// In name order.
inline std::vector<NamedClip> read_clips(const std::filesystem::path& corpus) {
    std::vector<std::filesystem::path> files = amc_files(corpus);
    std::ranges::sort(files, {}, [](const auto& file) { return file.stem(); });
    std::vector<NamedClip> clips(files.size());
    tbb::parallel_for(size_t(0), files.size(), [&](size_t i) {
        clips[i] = {files[i].stem().string(), read_take(files[i])};
    });
    return clips;
}

inline std::vector<MarkerTake> markers_of(const std::vector<NamedClip>& clips) {
    std::vector<MarkerTake> takes(clips.size());
    tbb::parallel_for(size_t(0), clips.size(), [&](size_t i) {
        takes[i] = {clips[i].name, markers_of(clips[i].clip)};
    });
    return takes;
}

/// The clip at a pace that wanders within 0.7 to 1.4 times its own.
inline Clip at_another_pace(const Clip& clip, uint64_t seed, uint64_t copy) {
    RandomStream random(seed, "pace", copy);
    return sample(clip, TimeWarp(clip.frames(), random).source_frames(), clip.rate);
}

/// Copies of takes, each of another size, at another pace and every other one in a mirror, until
/// there are so many frames. The takes themselves come first.
inline std::vector<MarkerTake> varied_takes(const std::vector<NamedClip>& clips, int64_t frames) {
    constexpr double sizes[] = {1, 0.94, 1.12, 0.88, 1.06};
    std::vector<std::pair<size_t, size_t>> made;  // copy, clip
    int64_t planned = 0;
    for (size_t copy = 0; planned < frames; ++copy) {
        for (size_t i = 0; i < clips.size() && planned < frames; ++i) {
            made.emplace_back(copy, i);
            planned += clips[i].clip.frames();
        }
    }
    std::vector<MarkerTake> takes(made.size());
    tbb::parallel_for(size_t(0), made.size(), [&](size_t t) {
        const auto [copy, i] = made[t];
        Clip clip = clips[i].clip;
        if (copy > 0) clip = at_another_pace(clip, i, copy);
        if (copy % 2 == 1) clip = mirrored(clip);
        if (copy > 0) clip = scaled(clip, sizes[copy % std::size(sizes)]);
        takes[t] = {clips[i].name + "+" + std::to_string(copy), markers_of(clip)};
    });
    return takes;
}

/// Of all takes together.
inline PoseHierarchy hierarchy_of(const std::vector<MarkerTake>& takes, double tolerance,
                                  int threads) {
    int64_t frames = 0;
    for (const MarkerTake& take : takes) frames += take.markers.rows();
    MatrixF poses(frames, takes.front().markers.cols());
    int64_t row = 0;
    for (const MarkerTake& take : takes) {
        poses.middleRows(row, take.markers.rows()) = take.markers;
        row += take.markers.rows();
    }
    const Workers workers(threads);
    const MatrixRows rows(poses);
    const PrincipalMarkers principal =
        select_principal_markers(moments_of(rows, workers), PrincipalMarkerOptions{});
    const MatrixF columns = poses(Eigen::all, principal.columns);
    PoseHierarchyOptions options;
    options.leaf_tolerance = tolerance;
    return grow_pose_hierarchy(rows, MatrixRows(columns), principal.columns, options, workers, 2048)
        .hierarchy;
}

}  // namespace kinetome::bench
