// Takes of a folder with NN/NN.asf and NN/NN_*.amc: shared by the benchmarks.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/features/effectors.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/joint_roles.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"

namespace kinetome::bench {

/// In no order. Throws InputError when there is none.
inline std::vector<std::filesystem::path> amc_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".amc") files.push_back(entry.path());
    if (files.empty()) throw InputError::in_file(folder.string(), "holds no AMC take");
    return files;
}

inline Clip read_take(const std::filesystem::path& file) {
    const std::filesystem::path home = file.parent_path();
    const std::filesystem::path asf = home / (home.filename().string() + ".asf");
    Skeleton skeleton = parse_asf(read_source_file(asf), asf.string());
    assign_roles(skeleton, asf.string());
    return parse_amc(read_source_file(file), file.string(),
                     std::make_shared<const Skeleton>(std::move(skeleton)));
}

/// n × 45: end effectors at `rate`, with those 1/30 s before and after.
inline MatrixF stacked_effectors(const Clip& take, double rate) {
    const Clip clip = resample(take, rate);
    return stack_neighbours(effector_positions(*clip.skeleton, clip.motion, joint_positions(clip)),
                            std::llround(rate / 30));
}

}  // namespace kinetome::bench
