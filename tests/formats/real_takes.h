// The shortest take of each subject of the test corpus, and one of another laboratory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"

struct RealTake {
    std::string asf_path;
    std::string amc_path;
    std::string asf;
    std::string amc;

    kinetome::Clip clip() const {
        return kinetome::parse_amc(
            amc, amc_path,
            std::make_shared<const kinetome::Skeleton>(kinetome::parse_asf(asf, asf_path)));
    }
};

inline RealTake read_take(const std::filesystem::path& asf, const std::filesystem::path& amc) {
    return {asf.string(), amc.string(), kinetome::read_source_file(asf),
            kinetome::read_source_file(amc)};
}

inline std::vector<RealTake> real_takes(const std::filesystem::path& corpus) {
    namespace fs = std::filesystem;
    std::vector<RealTake> takes;
    for (const fs::directory_entry& folder : fs::directory_iterator(corpus / "cmu")) {
        fs::path shortest;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() != ".amc") continue;
            if (shortest.empty() || entry.file_size() < fs::file_size(shortest)) {
                shortest = entry.path();
            }
        }
        const std::string subject = folder.path().filename().string();
        takes.push_back(read_take(folder.path() / (subject + ".asf"), shortest));
    }
    const fs::path other = corpus / "formats" / "c3d";
    takes.push_back(read_take(other / "HDM_dg.asf", other / "HDM_dg_06-03_03_120.amc"));
    return takes;
}
