#include "kinetome/models/bundle_ends.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// Takes of letters 0 1 2 3, ten frames each; in F(j) the pose runs through 0 … 9 past an offset,
/// so that some frame of each F(j) has the same pose as some of every other.
struct Takes {
    MotionString string;
    std::vector<SubstringBundle> bundles;
    std::vector<int32_t> letters;
    MatrixF poses;

    explicit Takes(const std::vector<int>& offsets) {
        constexpr int frames_per_letter = 10;
        std::vector<int32_t> frame_letters;
        std::vector<int64_t> clips;
        SubstringBundle bundle;
        for (size_t take = 0; take < offsets.size(); ++take) {
            for (int frame = 0; frame < 4 * frames_per_letter; ++frame)
                frame_letters.push_back(frame / frames_per_letter);
            clips.push_back(4 * frames_per_letter);
            const auto first = static_cast<int32_t>(4 * take);
            bundle.members.push_back({first + 1, first + 2});
        }
        string = make_motion_string(frame_letters, clips);
        bundles = {bundle};
        letters = bundle_end_letters(bundles);
        poses.resize(static_cast<Eigen::Index>(letters.size()) * frames_per_letter, 2);
        for (Eigen::Index row = 0; row < poses.rows(); ++row) {
            const auto take = static_cast<size_t>(row / (2 * frames_per_letter));
            const auto pose = static_cast<float>(row % frames_per_letter + offsets[take]);
            poses.row(row) << pose, 100 * pose;
        }
    }
};

/// Eq. 6 of one bundle, from its definition.
double score_of(const Takes& takes, const std::vector<int32_t>& frames) {
    const auto variance = [](const std::vector<double>& values) {
        double mean = 0, sum = 0;
        for (const double value : values) mean += value / double(values.size());
        for (const double value : values) sum += (value - mean) * (value - mean);
        return sum / double(values.size());
    };
    double score = 0;
    const auto add_poses = [&](int which) {
        for (Eigen::Index column = 0; column < takes.poses.cols(); ++column) {
            std::vector<double> values;
            for (size_t i = size_t(which); i < takes.letters.size(); i += 2) {
                const auto letter = static_cast<size_t>(takes.letters[i]);
                const int32_t inside = frames[letter] - takes.string.first_frame[letter];
                values.push_back(takes.poses(Eigen::Index(10 * i) + inside, column));
            }
            score += variance(values);
        }
    };
    add_poses(0);
    add_poses(1);
    std::vector<double> lengths;
    for (size_t i = 0; i < takes.letters.size(); i += 2) {
        lengths.push_back(frames[size_t(takes.letters[i + 1])] - frames[size_t(takes.letters[i])]);
    }
    return score + variance(lengths);
}

}  // namespace

TEST_CASE("ends move to frames where poses and lengths agree") {
    const Takes takes({0, 3, -2, 1});
    const BundleEnds ends =
        find_bundle_ends(takes.string, takes.bundles, takes.letters, takes.poses);
    CHECK(ends.first_score > 1000);
    CHECK(ends.score == Approx(0).margin(1e-6));
    CHECK(ends.score == Approx(score_of(takes, ends.frames)).margin(1e-6));
    for (size_t j = 0; j < ends.frames.size(); ++j) {
        CHECK(ends.frames[j] >= takes.string.first_frame[j]);
        CHECK(ends.frames[j] < takes.string.end_frame[j]);
    }
}

TEST_CASE("the first score is that of mean frames, and no move makes it worse") {
    const Takes takes({0, 9, -9, 4, 30});
    std::vector<int32_t> means;
    for (int64_t j = 0; j < takes.string.size(); ++j)
        means.push_back(static_cast<int32_t>(takes.string.mean_frame(j)));
    const BundleEnds none =
        find_bundle_ends(takes.string, takes.bundles, takes.letters, takes.poses, {.sweeps = 0});
    CHECK(none.frames == means);
    CHECK(none.score == Approx(score_of(takes, means)));
    double before = none.score;
    for (const int32_t sweeps : {1, 2, 5}) {
        const BundleEnds ends = find_bundle_ends(takes.string, takes.bundles, takes.letters,
                                                 takes.poses, {.sweeps = sweeps});
        CHECK(ends.score == Approx(score_of(takes, ends.frames)));
        CHECK(ends.score <= before);
        before = ends.score;
    }
}

TEST_CASE("a member that follows another of its bundle shares an end with it") {
    std::vector<int32_t> frame_letters;
    for (int frame = 0; frame < 50; ++frame) frame_letters.push_back(frame / 10 % 2);
    const MotionString string = make_motion_string(frame_letters, std::vector<int64_t>{50});
    const std::vector<SubstringBundle> bundles = {{{{0, 2}, {2, 4}}}};
    const auto letters = bundle_end_letters(bundles);
    REQUIRE(letters == std::vector<int32_t>{0, 2, 4});
    MatrixF poses(30, 1);
    for (Eigen::Index row = 0; row < 30; ++row) poses(row, 0) = float(row % 10);
    const BundleEnds ends = find_bundle_ends(string, bundles, letters, poses);
    CHECK(ends.score == Approx(0).margin(1e-9));
    CHECK(ends.frames[2] - ends.frames[0] == ends.frames[4] - ends.frames[2]);
}

TEST_CASE("poses that do not fit the ends are refused") {
    const Takes takes({0, 1});
    CHECK_THROWS_AS(
        find_bundle_ends(takes.string, takes.bundles, takes.letters, takes.poses.topRows(5)),
        std::invalid_argument);
    const std::vector<int32_t> too_few = {takes.letters[0]};
    CHECK_THROWS_AS(find_bundle_ends(takes.string, takes.bundles, too_few, takes.poses.topRows(10)),
                    std::invalid_argument);
}
