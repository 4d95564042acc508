#include "kinetome/models/signature_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/base/parallel.h"
#include "signature_moments.h"
#include "signature_places.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void check_shape(const MatrixF& positions, int64_t rows, int64_t columns, const char* what) {
    if (rows == 0 || (positions.rows() == rows && positions.cols() == columns)) return;
    throw std::invalid_argument(
        fmt::format("{} × {} positions were given for a signature of {} {}, of {} values each",
                    positions.rows(), positions.cols(), rows, what, columns));
}

void check_shape(const PlacedSignature& signature, int64_t columns) {
    check_shape(signature.positions, std::ssize(signature.runs), columns, "runs");
    check_shape(signature.sample_positions, signature.samples().count(), columns, "samples");
}

/// Of the samples of all clips. Throws std::invalid_argument when they differ.
int32_t common_stride(const std::vector<PlacedSignature>& clips) {
    std::optional<int32_t> stride;
    for (const PlacedSignature& clip : clips) {
        if (clip.runs.empty()) continue;
        if (stride.value_or(clip.stride) != clip.stride) {
            throw std::invalid_argument("signatures are sampled at different strides");
        }
        stride = clip.stride;
    }
    return stride.value_or(1);
}

ValueLists<SignatureRun> joined_runs(const std::vector<PlacedSignature>& clips) {
    ValueLists<SignatureRun> lists;
    for (const PlacedSignature& clip : clips) {
        lists.values.insert(lists.values.end(), clip.runs.begin(), clip.runs.end());
        lists.first.push_back(static_cast<int64_t>(lists.values.size()));
    }
    return lists;
}

MatrixF joined_rows(const std::vector<PlacedSignature>& clips, MatrixF PlacedSignature::*rows_of,
                    int64_t columns) {
    int64_t count = 0;
    for (const PlacedSignature& clip : clips) count += (clip.*rows_of).rows();
    MatrixF joined(count, columns);
    int64_t next = 0;
    for (const PlacedSignature& clip : clips) {
        const MatrixF& rows = clip.*rows_of;
        if (rows.rows() > 0) joined.middleRows(next, rows.rows()) = rows;
        next += rows.rows();
    }
    return joined;
}

ValueLists<int32_t> occurrences_of(const std::vector<SignatureRun>& runs, int64_t leaves) {
    ValueLists<int32_t> lists;
    lists.first.assign(static_cast<size_t>(leaves) + 1, 0);
    for (const SignatureRun& run : runs) {
        if (run.leaf < 0 || run.leaf >= leaves) {
            throw std::invalid_argument(
                fmt::format("a signature has leaf {} of {}", run.leaf, leaves));
        }
        ++lists.first[static_cast<size_t>(run.leaf) + 1];
    }
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    lists.values.resize(runs.size());
    std::vector<int64_t> next = lists.first;
    for (size_t i = 0; i < runs.size(); ++i) {
        const auto slot = next[static_cast<size_t>(runs[i].leaf)]++;
        lists.values[static_cast<size_t>(slot)] = static_cast<int32_t>(i);
    }
    return lists;
}

std::vector<NearLeaf> near_leaves_of(int32_t leaf, const MatrixF& positions,
                                     const SignatureIndexOptions& options) {
    const VectorF distances =
        (positions.rowwise() - positions.row(leaf)).rowwise().norm().transpose();
    std::vector<NearLeaf> near;
    for (int32_t other = 0; other < positions.rows(); ++other) {
        if (double(distances[other]) < options.reach) near.push_back({other, distances[other]});
    }
    const auto nearer = [](const NearLeaf& a, const NearLeaf& b) {
        return std::tuple(a.distance, a.leaf) < std::tuple(b.distance, b.leaf);
    };
    const auto kept = std::min<size_t>(near.size(), static_cast<size_t>(options.near_leaves));
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end(),
                      nearer);
    near.resize(kept);
    return near;
}

ValueLists<NearLeaf> near_leaves(const MatrixF& positions, const SignatureIndexOptions& options,
                                 int threads) {
    std::vector<std::vector<NearLeaf>> found(static_cast<size_t>(positions.rows()));
    parallel_for(threads, positions.rows(), [&](int64_t leaf) {
        found[static_cast<size_t>(leaf)] =
            near_leaves_of(static_cast<int32_t>(leaf), positions, options);
    });
    ValueLists<NearLeaf> lists;
    for (const auto& near : found) {
        lists.values.insert(lists.values.end(), near.begin(), near.end());
        lists.first.push_back(static_cast<int64_t>(lists.values.size()));
    }
    return lists;
}

template <class Value>
bool is_whole(const ValueLists<Value>& lists) {
    return !lists.first.empty() && lists.first.front() == 0 &&
           std::ranges::is_sorted(lists.first) &&
           lists.first.back() == static_cast<int64_t>(lists.values.size());
}

template <class Values, class Number>
bool all_below(const Values& values, int64_t bound, const Number& number) {
    return std::ranges::all_of(
        values, [&](const auto& value) { return number(value) >= 0 && number(value) < bound; });
}

void check(const SignatureIndex::Parts& parts) {
    const int64_t leaves = parts.near_leaves.size();
    const auto runs = static_cast<int64_t>(parts.clips.values.size());
    const auto leaf_of_run = [](const SignatureRun& run) { return run.leaf; };
    const auto leaf_of_near = [](const NearLeaf& near) { return near.leaf; };
    if (is_whole(parts.clips) && is_whole(parts.occurrences) && is_whole(parts.near_leaves) &&
        parts.occurrences.size() == leaves && parts.positions.rows() == runs && parts.stride > 0 &&
        parts.positions.allFinite() && parts.sample_positions.allFinite() &&
        all_below(parts.clips.values, leaves, leaf_of_run) &&
        all_below(parts.occurrences.values, runs, std::identity()) &&
        all_below(parts.near_leaves.values, leaves, leaf_of_near)) {
        return;
    }
    throw std::invalid_argument("these are not the parts of a signature index");
}

bool is_before(const IndexedMatch& a, const IndexedMatch& b) {
    return std::tuple(a.match.distance, a.clip, a.match.frames.first, a.match.frames.end) <
           std::tuple(b.match.distance, b.clip, b.match.frames.first, b.match.frames.end);
}

}  // namespace

std::vector<IndexedMatch> nearest_matches(std::vector<IndexedMatch> matches, int64_t k,
                                          double overlap) {
    std::ranges::sort(matches, is_before);
    std::vector<IndexedMatch> kept;
    for (const IndexedMatch& match : matches) {
        if (static_cast<int64_t>(kept.size()) >= k) break;
        const bool known = std::ranges::any_of(kept, [&](const IndexedMatch& nearer) {
            return nearer.clip == match.clip &&
                   is_same_place(nearer.match.frames, match.match.frames, overlap);
        });
        if (!known) kept.push_back(match);
    }
    return kept;
}

SignatureIndex::SignatureIndex(const std::vector<PlacedSignature>& clips,
                               const MatrixF& leaf_positions, const SignatureIndexOptions& options,
                               int threads) {
    const int64_t columns = leaf_positions.cols();
    for (const PlacedSignature& clip : clips) check_shape(clip, columns);
    Parts parts;
    parts.clips = joined_runs(clips);
    parts.positions = joined_rows(clips, &PlacedSignature::positions, columns);
    parts.stride = common_stride(clips);
    parts.sample_positions = joined_rows(clips, &PlacedSignature::sample_positions, columns);
    parts.occurrences = occurrences_of(parts.clips.values, leaf_positions.rows());
    parts.near_leaves = near_leaves(leaf_positions, options, threads);
    parts.reach = options.reach;
    *this = SignatureIndex(std::move(parts));
}

SignatureIndex::SignatureIndex(Parts parts) : parts_(std::move(parts)) {
    check(parts_);
    clip_of_run_.reserve(parts_.clips.values.size());
    first_sample_.push_back(0);
    for (int64_t clip = 0; clip < parts_.clips.size(); ++clip) {
        const auto number = static_cast<int32_t>(clip);
        clip_of_run_.insert(clip_of_run_.end(), parts_.clips[clip].size(), number);
        first_sample_.push_back(first_sample_.back() + samples(number).count());
    }
    if (first_sample_.back() != parts_.sample_positions.rows()) {
        throw std::invalid_argument("these are not the samples of a signature index");
    }
}

FrameSamples SignatureIndex::samples(int32_t clip) const {
    return {frame_count(parts_.clips[clip]), parts_.stride};
}

MotionView SignatureIndex::motion(int32_t clip) const {
    const auto number = static_cast<size_t>(clip);
    const FrameSamples of_clip = samples(clip);
    return {parts_.clips[clip],
            parts_.positions.middleRows(parts_.clips.first[number], std::ssize(parts_.clips[clip])),
            of_clip, parts_.sample_positions.middleRows(first_sample_[number], of_clip.count())};
}

std::vector<IndexedMatch> SignatureIndex::search(const PlacedSignature& query, int64_t k,
                                                 const SignatureSearchOptions& options) const {
    if (query.runs.empty() || parts_.clips.values.empty()) return {};
    check_shape(query, parts_.positions.cols());
    const auto matches = [&] {
        if (options.match.tolerance <= 0) return exact_matches(query.runs);
        if (options.match.rule == MatchRule::pace) return matches_by_pace(query, k, options);
        return matches_by_runs(query, options);
    };
    return nearest_matches(matches(), k, options.match.overlap);
}

std::vector<IndexedMatch> SignatureIndex::matches_by_pace(const PlacedSignature& query, int64_t k,
                                                          SignatureSearchOptions options) const {
    const int64_t frames = query.samples().frames;
    // A short query is compared as often as one of a few seconds.
    constexpr int64_t moments = 30;
    const auto step =
        static_cast<int32_t>(std::clamp<int64_t>(frames / moments, 1, options.match.step));
    options.match.step = step;
    const double tolerance = std::exchange(options.match.tolerance, infinite);
    const int64_t rows = std::max<int64_t>(1, std::llround(double(frames) / step));
    const double spacing = double(frames) / double(rows);
    const Moments asked{(spacing - 1) / 2, spacing, rows};
    std::vector<IndexedMatch> matches;
    for (const SignaturePlace& place : likely_places(parts_, clip_of_run_, query.runs, options)) {
        const int64_t first = place.frames.first / step * step;
        const Moments there{double(first) + step / 2, double(step),
                            (place.frames.end - first) / step};
        const MatrixF distances =
            distances_between(view_of(query), asked, motion(place.clip), there, frames / 4);
        for (SignatureMatch match : match_paces(frames, distances, options.match)) {
            match.frames = {first + match.frames.first, first + match.frames.end};
            matches.push_back({place.clip, match});
        }
    }
    if (options.to_the_frame) {
        constexpr int64_t moved = 8;  // at least: the query itself is among so many
        matches = nearest_matches(std::move(matches), std::max(k, moved), options.match.overlap);
        for (IndexedMatch& one : matches) {
            one.match = at_own_pace(one.match, view_of(query), motion(one.clip), step);
        }
    }
    std::erase_if(matches, [&](const auto& one) { return one.match.distance > tolerance; });
    return matches;
}

std::vector<IndexedMatch> SignatureIndex::matches_by_runs(
    const PlacedSignature& query, const SignatureSearchOptions& options) const {
    std::vector<IndexedMatch> matches;
    for (const SignaturePlace& place : likely_places(parts_, clip_of_run_, query.runs, options)) {
        const int64_t first = place.frames.first;
        const auto clip = parts_.clips[place.clip];
        const Signature text = part_of(clip, place.frames);
        const int64_t first_run =
            parts_.clips.first[static_cast<size_t>(place.clip)] + run_at(clip, first);
        const MatrixF distances = distances_between(
            query.positions,
            parts_.positions.middleRows(first_run, static_cast<Eigen::Index>(text.size())));
        for (SignatureMatch match : match_runs(query.runs, text, distances, options.match)) {
            match.frames = {first + match.frames.first, first + match.frames.end};
            matches.push_back({place.clip, match});
        }
    }
    return matches;
}

std::vector<IndexedMatch> SignatureIndex::exact_matches(std::span<const SignatureRun> query) const {
    const auto rarest = std::ranges::min_element(
        query, {}, [&](const SignatureRun& run) { return parts_.occurrences[run.leaf].size(); });
    const int64_t before = rarest - query.begin();
    const std::span runs(parts_.clips.values);
    std::vector<IndexedMatch> matches;
    for (const int32_t run : parts_.occurrences[rarest->leaf]) {
        const int32_t clip = clip_of_run_[static_cast<size_t>(run)];
        const auto text = parts_.clips[clip];
        const int64_t first = run - before - parts_.clips.first[static_cast<size_t>(clip)];
        const int64_t last = first + static_cast<int64_t>(query.size()) - 1;
        if (first < 0 || last >= static_cast<int64_t>(text.size())) continue;
        const bool same =
            std::ranges::equal(query, text.subspan(static_cast<size_t>(first), query.size()), {},
                               &SignatureRun::leaf, &SignatureRun::leaf);
        if (same) matches.push_back({clip, {matched_frames(query, text, first, last), 0}});
    }
    return matches;
}

}  // namespace kinetome
