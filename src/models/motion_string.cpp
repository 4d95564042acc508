#include "kinetome/models/motion_string.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kinetome/math/quantiles.h"
#include "kinetome/models/pose_clusters.h"

namespace kinetome {

double MotionString::mean_frame(int64_t j) const {
    const auto i = static_cast<size_t>(j);
    return (static_cast<double>(first_frame[i]) + end_frame[i] - 1) / 2;
}

bool MotionString::breaks_after(int64_t j) const {
    const auto i = static_cast<size_t>(j);
    return i + 1 == clip.size() || clip[i] != clip[i + 1];
}

void pack(Packer& out, const MotionString& string) {
    for (const auto* values :
         {&string.letters, &string.clip, &string.first_frame, &string.end_frame}) {
        pack(out, *values);
    }
}

void unpack(Unpacker& in, MotionString& string) {
    for (auto* values : {&string.letters, &string.clip, &string.first_frame, &string.end_frame}) {
        unpack(in, *values);
    }
}

MotionString make_motion_string(std::span<const int32_t> frame_letters,
                                std::span<const int64_t> clip_frames) {
    if (std::accumulate(clip_frames.begin(), clip_frames.end(), int64_t{0}) !=
        static_cast<int64_t>(frame_letters.size()))
        throw std::invalid_argument(
            "a motion string needs one letter for every frame of its clips");

    MotionString string;
    size_t offset = 0;
    for (size_t c = 0; c < clip_frames.size(); ++c) {
        const auto frames = static_cast<size_t>(clip_frames[c]);
        const auto letters = frame_letters.subspan(offset, frames);
        for (size_t first = 0, end = 0; first < frames; first = end) {
            while (end < frames && letters[end] == letters[first]) ++end;
            string.letters.push_back(letters[first]);
            string.clip.push_back(static_cast<int32_t>(c));
            string.first_frame.push_back(static_cast<int32_t>(first));
            string.end_frame.push_back(static_cast<int32_t>(end));
        }
        offset += frames;
    }
    return string;
}

double adjacent_distance(const MotionString& string, const Mixture& mixture, double quantile) {
    std::vector<double> distances;
    for (int64_t j = 0; j + 1 < string.size(); ++j) {
        const auto i = static_cast<size_t>(j);
        if (!string.breaks_after(j))
            distances.push_back(letter_distance(mixture, string.letters[i], string.letters[i + 1]));
    }
    return lower_quantile(std::move(distances), quantile);
}

int64_t longest_substring(const MotionString& string, double longest_submotion_frames) {
    constexpr int64_t shortest = 2;
    int64_t pairs = 0;
    double frames = 0;
    for (int64_t j = 0; j + 1 < string.size(); ++j) {
        if (string.breaks_after(j)) continue;
        ++pairs;
        frames += string.mean_frame(j + 1) - string.mean_frame(j);
    }
    if (pairs == 0) return shortest;
    return std::max<int64_t>(
        std::llround(longest_submotion_frames * static_cast<double>(pairs) / frames), shortest);
}

}  // namespace kinetome
