// A take of the CMU folder of the test corpus.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/clip.h"
#include "kinetome/formats/joint_roles.h"

/// "14_14" → cmu/14/14.asf with cmu/14/14_14.amc.
inline kinetome::Clip cmu_take(const std::filesystem::path& corpus, const std::string& name) {
    const std::string subject = name.substr(0, name.find('_'));
    const std::filesystem::path folder = corpus / "cmu" / subject;
    const std::string asf = (folder / (subject + ".asf")).string();
    const std::string amc = (folder / (name + ".amc")).string();
    kinetome::Skeleton skeleton = kinetome::parse_asf(kinetome::read_source_file(asf), asf);
    kinetome::assign_roles(skeleton, asf);
    return kinetome::parse_amc(kinetome::read_source_file(amc), amc,
                               std::make_shared<const kinetome::Skeleton>(std::move(skeleton)));
}
