// Corpora and takes to work on.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "texts.h"

inline void generate_corpus(const fs::path& folder, int frames, int subjects, int seed = 1) {
    require_program({"generate", "--frames", std::to_string(frames), "--subjects",
                     std::to_string(subjects), "--seed", std::to_string(seed), "--quiet", "-o",
                     folder.string()});
}

/// The take as performed `centimetres` further along x: other numbers, the same motion.
inline std::string shifted_take(const std::string& amc, double centimetres) {
    std::vector<std::string> lines = lines_of(amc);
    for (std::string& line : lines) {
        if (line.rfind("root ", 0) != 0) continue;
        std::istringstream words(line.substr(5));
        double x = 0;
        std::string rest;
        words >> x;
        std::getline(words, rest);
        std::ostringstream moved;
        moved << "root " << x + centimetres << rest;
        line = moved.str();
    }
    return joined(lines);
}

/// The header of a take and its first frames.
inline std::string first_frames(const std::string& amc, int frames) {
    std::vector<std::string> kept;
    for (const std::string& line : lines_of(amc)) {
        if (line == std::to_string(frames + 1)) break;
        kept.push_back(line);
    }
    return joined(kept);
}
