// Takes as motion strings, straight from their files: shared by the benchmarks of motion bundles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/features/pose_vector.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "takes.h"

namespace kinetome::bench {

inline constexpr double pose_rate = 120;

/// Pose vectors of several takes, one after another.
struct PoseTakes {
    std::vector<std::string> names;
    std::vector<int64_t> frames;
    MatrixF poses;  ///< n × d
    VectorD floors;

    static PoseTakes read(const std::filesystem::path& corpus,
                          const std::vector<std::string>& names) {
        std::vector<Clip> clips;
        for (const std::string& name : names) {
            const std::string subject = name.substr(0, name.find('_'));
            clips.push_back(resample(read_take(corpus / subject / (name + ".amc")), pose_rate));
        }
        return of_clips(names, clips);
    }

    static PoseTakes of_clips(const std::vector<std::string>& names,
                              const std::vector<Clip>& clips) {
        PoseTakes takes{names, {}, {}, {}};
        const auto columns = pose_vector_columns(*clips.front().skeleton);
        takes.floors.resize(static_cast<Eigen::Index>(columns.size()));
        for (size_t i = 0; i < columns.size(); ++i)
            takes.floors[static_cast<Eigen::Index>(i)] = columns[i].floor;
        Eigen::Index rows = 0;
        for (const Clip& clip : clips) rows += clip.frames();
        takes.poses.resize(rows, takes.floors.size());
        rows = 0;
        for (const Clip& clip : clips) {
            takes.frames.push_back(clip.frames());
            takes.poses.middleRows(rows, clip.frames()) =
                pose_vectors(*clip.skeleton, clip.motion, clip.rate);
            rows += clip.frames();
        }
        return takes;
    }
};

/// Principal components, mixture and string of takes.
struct SpelledTakes {
    MatrixF projected;  ///< n × D
    Mixture mixture;
    MotionString string;
    double tau = 0;
    int64_t lambda = 0;

    SpelledTakes(const PoseTakes& takes, const PoseClusterOptions& options, int threads,
                 const MotionStringOptions& spelling = {}) {
        const Workers workers{threads, nullptr};
        const Pca pca = fit_pca(moments_of(takes.poses), takes.floors, options.variance_share);
        projected = pca.project(takes.poses);
        const MatrixRows rows(projected);
        mixture = fit_pose_clusters(rows, options, workers).fit.model;
        string = make_motion_string(likeliest_clusters(mixture, rows, workers), takes.frames);
        tau = adjacent_distance(string, mixture, spelling.tau_quantile);
        lambda = longest_substring(string, spelling.longest_submotion * pose_rate);
    }
};

}  // namespace kinetome::bench
