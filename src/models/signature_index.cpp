#include "kinetome/models/signature_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/base/parallel.h"
#include "kinetome/models/pose_hierarchy.h"
#include "signature_places.h"

namespace kinetome {
namespace {

ValueLists<SignatureRun> joined(const std::vector<Signature>& clips) {
    ValueLists<SignatureRun> lists;
    for (const Signature& clip : clips) {
        lists.values.insert(lists.values.end(), clip.begin(), clip.end());
        lists.first.push_back(static_cast<int64_t>(lists.values.size()));
    }
    return lists;
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
    const int64_t leaves = parts.positions.rows();
    const auto runs = static_cast<int64_t>(parts.clips.values.size());
    const auto leaf_of_run = [](const SignatureRun& run) { return run.leaf; };
    const auto leaf_of_near = [](const NearLeaf& near) { return near.leaf; };
    if (is_whole(parts.clips) && is_whole(parts.occurrences) && is_whole(parts.near_leaves) &&
        parts.occurrences.size() == leaves && parts.near_leaves.size() == leaves &&
        all_below(parts.clips.values, leaves, leaf_of_run) &&
        all_below(parts.occurrences.values, runs, std::identity()) &&
        all_below(parts.near_leaves.values, leaves, leaf_of_near)) {
        return;
    }
    throw std::invalid_argument("these are not the parts of a signature index");
}

/// Distances from the leaves of a query to others, measured when they are first asked for.
class QueryDistances {
  public:
    QueryDistances(std::span<const SignatureRun> query, const MatrixF& positions)
        : positions_(positions), column_of_(static_cast<size_t>(positions.rows()), -1) {
        std::vector<int32_t> leaves;
        for (const SignatureRun& run : query) leaves.push_back(run.leaf);
        std::ranges::sort(leaves);
        leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
        query_positions_.resize(static_cast<Eigen::Index>(leaves.size()), positions.cols());
        for (size_t i = 0; i < leaves.size(); ++i) {
            query_positions_.row(static_cast<Eigen::Index>(i)) = positions.row(leaves[i]);
        }
        for (const SignatureRun& run : query) {
            rows_.push_back(std::ranges::lower_bound(leaves, run.leaf) - leaves.begin());
        }
    }

    /// Query runs × runs of a text.
    MatrixF to(std::span<const SignatureRun> text) {
        MatrixF distances(static_cast<Eigen::Index>(rows_.size()),
                          static_cast<Eigen::Index>(text.size()));
        for (size_t j = 0; j < text.size(); ++j) {
            const VectorF& column = to_leaf(text[j].leaf);
            for (size_t i = 0; i < rows_.size(); ++i) {
                distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    column[rows_[i]];
            }
        }
        return distances;
    }

  private:
    const VectorF& to_leaf(int32_t leaf) {
        int32_t& column = column_of_[static_cast<size_t>(leaf)];
        if (column < 0) {
            column = static_cast<int32_t>(columns_.size());
            columns_.emplace_back(
                (query_positions_.rowwise() - positions_.row(leaf)).rowwise().norm());
        }
        return columns_[static_cast<size_t>(column)];
    }

    const MatrixF& positions_;
    MatrixF query_positions_;         ///< of its different leaves
    std::vector<Eigen::Index> rows_;  ///< of those, by run of the query
    std::vector<int32_t> column_of_;  ///< by leaf
    std::vector<VectorF> columns_;
};

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

MatrixF leaf_positions(const MatrixDView& means) {
    constexpr double mm_per_cm = 10;
    const auto markers = static_cast<double>(compared_markers(means.cols()));
    return (means * (mm_per_cm / std::sqrt(markers))).cast<float>();
}

SignatureIndex::SignatureIndex(const std::vector<Signature>& clips, MatrixF positions,
                               const SignatureIndexOptions& options, int threads) {
    Parts parts;
    parts.clips = joined(clips);
    parts.occurrences = occurrences_of(parts.clips.values, positions.rows());
    parts.near_leaves = near_leaves(positions, options, threads);
    parts.positions = std::move(positions);
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

std::vector<IndexedMatch> SignatureIndex::search(std::span<const SignatureRun> query, int64_t k,
                                                 const SignatureSearchOptions& options) const {
    if (query.empty()) return {};
    auto matches =
        options.match.tolerance > 0 ? near_matches(query, options) : exact_matches(query);
    return nearest_matches(std::move(matches), k, options.match.overlap);
}

std::vector<IndexedMatch> SignatureIndex::near_matches(
    std::span<const SignatureRun> query, const SignatureSearchOptions& options) const {
    SignatureMatchOptions match_options = options.match;
    // A short query is compared as often as one of a few seconds.
    constexpr int32_t samples = 30;
    match_options.step = std::clamp(frame_count(query) / samples, 1, options.match.step);
    QueryDistances distances(query, parts_.positions);
    std::vector<IndexedMatch> matches;
    for (const SignaturePlace& place : likely_places(parts_, clip_of_run_, query, options)) {
        const int64_t first = place.frames.first / match_options.step * match_options.step;
        const Signature text = part_of(parts_.clips[place.clip], {first, place.frames.end});
        for (SignatureMatch match :
             match_signature(query, text, distances.to(text), match_options)) {
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
