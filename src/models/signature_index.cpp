#include "kinetome/models/signature_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/base/parallel.h"
#include "signature_places.h"

namespace kinetome {
namespace {

void check_shape(const PlacedSignature& signature, int64_t columns) {
    const auto runs = static_cast<int64_t>(signature.runs.size());
    const MatrixF& positions = signature.positions;
    if (runs == 0 || (positions.rows() == runs && positions.cols() == columns)) return;
    throw std::invalid_argument(
        fmt::format("{} × {} positions were given for a signature of {} runs, of {} values each",
                    positions.rows(), positions.cols(), runs, columns));
}

ValueLists<SignatureRun> joined_runs(const std::vector<PlacedSignature>& clips) {
    ValueLists<SignatureRun> lists;
    for (const PlacedSignature& clip : clips) {
        lists.values.insert(lists.values.end(), clip.runs.begin(), clip.runs.end());
        lists.first.push_back(static_cast<int64_t>(lists.values.size()));
    }
    return lists;
}

/// Throws std::invalid_argument unless every run has one, all of `columns` values.
MatrixF joined_positions(const std::vector<PlacedSignature>& clips, int64_t columns) {
    int64_t runs = 0;
    for (const PlacedSignature& clip : clips) {
        check_shape(clip, columns);
        runs += static_cast<int64_t>(clip.runs.size());
    }
    MatrixF positions(runs, columns);
    int64_t next = 0;
    for (const PlacedSignature& clip : clips) {
        if (clip.runs.empty()) continue;
        positions.middleRows(next, clip.positions.rows()) = clip.positions;
        next += clip.positions.rows();
    }
    return positions;
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
        parts.occurrences.size() == leaves && parts.positions.rows() == runs &&
        all_below(parts.clips.values, leaves, leaf_of_run) &&
        all_below(parts.occurrences.values, runs, std::identity()) &&
        all_below(parts.near_leaves.values, leaves, leaf_of_near)) {
        return;
    }
    throw std::invalid_argument("these are not the parts of a signature index");
}

/// Between positions (n × r and m × r), n × m.
MatrixF distances_between(const MatrixFView& query, const MatrixFView& text) {
    const MatrixF columns = text.transpose();  // values of one kind side by side, for vector units
    MatrixF distances = MatrixF::Zero(query.rows(), text.rows());
    for (Eigen::Index i = 0; i < query.rows(); ++i) {
        auto row = distances.row(i).array();
        for (Eigen::Index k = 0; k < query.cols(); ++k) {
            row += (columns.row(k).array() - query(i, k)).square();
        }
        row = row.sqrt();
    }
    return distances;
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
    Parts parts;
    parts.clips = joined_runs(clips);
    parts.positions = joined_positions(clips, leaf_positions.cols());
    parts.occurrences = occurrences_of(parts.clips.values, leaf_positions.rows());
    parts.near_leaves = near_leaves(leaf_positions, options, threads);
    parts.reach = options.reach;
    *this = SignatureIndex(std::move(parts));
}

SignatureIndex::SignatureIndex(Parts parts) : parts_(std::move(parts)) {
    check(parts_);
    clip_of_run_.reserve(parts_.clips.values.size());
    for (int64_t clip = 0; clip < parts_.clips.size(); ++clip) {
        clip_of_run_.insert(clip_of_run_.end(), parts_.clips[clip].size(),
                            static_cast<int32_t>(clip));
    }
}

std::vector<IndexedMatch> SignatureIndex::search(const PlacedSignature& query, int64_t k,
                                                 const SignatureSearchOptions& options) const {
    if (query.runs.empty() || parts_.clips.values.empty()) return {};
    check_shape(query, parts_.positions.cols());
    auto matches =
        options.match.tolerance > 0 ? near_matches(query, options) : exact_matches(query.runs);
    return nearest_matches(std::move(matches), k, options.match.overlap);
}

std::vector<IndexedMatch> SignatureIndex::near_matches(
    const PlacedSignature& query, const SignatureSearchOptions& options) const {
    SignatureMatchOptions match_options = options.match;
    // A short query is compared as often as one of a few seconds.
    constexpr int32_t samples = 30;
    match_options.step = std::clamp(frame_count(query.runs) / samples, 1, options.match.step);
    std::vector<IndexedMatch> matches;
    for (const SignaturePlace& place : likely_places(parts_, clip_of_run_, query.runs, options)) {
        const int64_t first = place.frames.first / match_options.step * match_options.step;
        const auto clip = parts_.clips[place.clip];
        const Signature text = part_of(clip, {first, place.frames.end});
        const int64_t first_run =
            parts_.clips.first[static_cast<size_t>(place.clip)] + run_at(clip, first);
        const MatrixF distances = distances_between(
            query.positions,
            parts_.positions.middleRows(first_run, static_cast<Eigen::Index>(text.size())));
        for (SignatureMatch match : match_signature(query.runs, text, distances, match_options)) {
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
