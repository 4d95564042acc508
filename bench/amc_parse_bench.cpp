// How fast AMC text is parsed, against a bare loop of std::from_chars over the numbers of the same
// bytes. The two take turns in one process; medians are printed.
//
//   amc_parse_bench [CORPUS]    CORPUS: a folder with NN/NN.asf and NN/NN_*.amc below it;
//                               without one, text of the same shape is generated
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/file.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/write_amc.h"

namespace {

using namespace kinetome;
namespace fs = std::filesystem;

struct Take {
    std::shared_ptr<const Skeleton> skeleton;
    std::string path;
    std::string text;
};

std::vector<Take> takes_of_corpus(const fs::path& corpus) {
    std::vector<Take> takes;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(corpus)) {
        if (entry.path().extension() != ".amc") continue;
        const fs::path folder = entry.path().parent_path();
        const fs::path asf = folder / (folder.filename().string() + ".asf");
        if (!fs::exists(asf)) continue;
        takes.push_back(
            {std::make_shared<const Skeleton>(parse_asf(read_source_file(asf), asf.string())),
             entry.path().string(), read_source_file(entry.path())});
    }
    return takes;
}

Skeleton chain_of_joints() {
    std::vector<Joint> joints(29);
    for (size_t j = 0; j < joints.size(); ++j) {
        joints[j].name = j == 0 ? "root" : "bone" + std::string(1, static_cast<char>('a' + j % 26));
        if (j > 25) joints[j].name += "2";
        joints[j].parent = static_cast<int>(j) - 1;
        joints[j].channels = {Channel::rx, Channel::ry};
    }
    joints[0].channels = {Channel::tx, Channel::ty, Channel::tz,
                          Channel::rx, Channel::ry, Channel::rz};
    return Skeleton("chain", std::move(joints));
}

std::vector<Take> generated_takes() {
    constexpr int64_t frames = 40000;
    const auto skeleton = std::make_shared<const Skeleton>(chain_of_joints());
    Take take{skeleton, "generated", {}};
    append_amc_header(take.text);
    std::vector<float> dofs(static_cast<size_t>(skeleton->dof_count()));
    for (int64_t frame = 0; frame < frames; ++frame) {
        for (size_t d = 0; d < dofs.size(); ++d) {
            dofs[d] = std::sin(0.01F * static_cast<float>(frame) + static_cast<float>(d));
        }
        append_amc_frame(take.text, *skeleton, frame + 1, dofs);
    }
    return {take};
}

/// What any parser must at least do: find each number of a frame and convert it.
double sum_by_from_chars(const std::string& text) {
    double sum = 0;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        while (at != end && (*at == ' ' || *at == '\r' || *at == '\n')) ++at;
        double value = 0;
        const auto [number_end, error] = std::from_chars(at, end, value);
        if (error == std::errc()) {
            sum += value;
            at = number_end;
        } else {
            while (at != end && *at != ' ' && *at != '\n') ++at;
        }
    }
    return sum;
}

template <class Work>
double seconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void run(const std::vector<Take>& takes) {
    constexpr int runs = 9;
    double bytes = 0;
    for (const Take& take : takes) bytes += static_cast<double>(take.text.size());

    std::vector<double> parse_seconds;
    std::vector<double> baseline_seconds;
    std::vector<double> count_seconds;
    double kept = 0;  // keeps the work from being optimised away
    for (int i = 0; i < runs; ++i) {
        parse_seconds.push_back(seconds_of([&] {
            for (const Take& take : takes) {
                kept += parse_amc(take.text, take.path, take.skeleton).motion(0, 0);
            }
        }));
        baseline_seconds.push_back(seconds_of([&] {
            for (const Take& take : takes) kept += sum_by_from_chars(take.text);
        }));
        count_seconds.push_back(seconds_of([&] {
            for (const Take& take : takes) {
                kept += static_cast<double>(count_amc_frames(take.text));
            }
        }));
    }

    const auto rate = [&](const std::vector<double>& seconds) {
        return bytes / 1e6 / median(seconds);
    };
    std::printf("takes %zu, %.1f MB, medians of %d interleaved runs (check %.3g)\n", takes.size(),
                bytes / 1e6, runs, kept);
    std::printf("parse_amc            %8.1f MB/s\n", rate(parse_seconds));
    std::printf("std::from_chars      %8.1f MB/s\n", rate(baseline_seconds));
    std::printf("count_amc_frames     %8.1f MB/s\n", rate(count_seconds));
    std::printf("parse_amc / std::from_chars %.2f\n", rate(parse_seconds) / rate(baseline_seconds));
}

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<Take> takes = argc > 1 ? takes_of_corpus(argv[1]) : generated_takes();
    if (takes.empty()) {
        std::fprintf(stderr, "no NN/NN_*.amc with NN/NN.asf below %s\n", argv[1]);
        return 65;
    }
    run(takes);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "amc_parse_bench: %s\n", error.what());
    return 70;
}
