#include "kinetome/models/similar_substrings.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "kinetome/base/pack_fields.h"

namespace kinetome {
namespace {

constexpr uint64_t hash_base = 0x9E3779B97F4A7C15;  // odd: 2^64 over the golden ratio

/// Substrings whose tables are made together: enough for all threads, few enough for memory.
constexpr size_t substrings_at_once = 1024;

}  // namespace

int64_t half_frames(const MotionString& string, const Substring& substring) {
    const auto first = static_cast<size_t>(substring.first);
    const auto last = static_cast<size_t>(substring.last);
    return int64_t{string.first_frame[last]} + string.end_frame[last] - string.first_frame[first] -
           string.end_frame[first];
}

template <int Words>
SimilarSubstrings<Words>::SimilarSubstrings(const MatchingContext& context,
                                            const MotionBundleOptions& options,
                                            const BundleResources& resources)
    : context_(context),
      options_(options),
      resources_(resources),
      tables_(context, resources),
      visited_(static_cast<size_t>(context.string.size())) {
    for (const int32_t letter : context.string.letters) {
        hashes_.push_back(hashes_.back() * hash_base + static_cast<uint64_t>(letter) + 1);
        powers_.push_back(powers_.back() * hash_base);
    }
}

template <int Words>
std::vector<Substring> SimilarSubstrings<Words>::find(const Substring& seed) {
    seed_half_frames_ = half_frames(context_.string, seed);
    const int32_t levels = options_.spread == BundleSpread::depth
                               ? options_.depth
                               : std::numeric_limits<int32_t>::max();
    Level level{seed};
    std::vector<Substring> found{seed};
    visit(seed);
    for (int32_t depth = 0; depth < levels && !level.empty(); ++depth) {
        const Level sources = of_new_letters(level);
        level.clear();
        for (size_t first = 0; first < sources.size(); first += substrings_at_once) {
            const size_t count = std::min(substrings_at_once, sources.size() - first);
            spread_from({sources.data() + first, count}, level);
        }
        found.insert(found.end(), level.begin(), level.end());
    }
    for (const int32_t last : visited_lasts_) visited_[static_cast<size_t>(last)] = {};
    visited_lasts_.clear();
    spread_.clear();
    return found;
}

template <int Words>
bool SimilarSubstrings<Words>::length_allowed(const Substring& substring) const {
    if (options_.spread != BundleSpread::closure_length) return true;
    const auto length = static_cast<double>(half_frames(context_.string, substring));
    const auto wanted = static_cast<double>(seed_half_frames_);
    return length >= options_.gamma * wanted && options_.gamma * length <= wanted;
}

template <int Words>
auto SimilarSubstrings<Words>::of_new_letters(const Level& level) -> Level {
    Level sources;
    for (const Substring& substring : level) {
        const uint64_t hash = letter_hash(substring);
        const auto [begin, end] = spread_.equal_range(hash);
        const bool known = std::any_of(
            begin, end, [&](const auto& other) { return same_letters(other.second, substring); });
        if (known) continue;
        spread_.emplace(hash, substring);
        sources.push_back(substring);
    }
    return sources;
}

template <int Words>
bool SimilarSubstrings<Words>::same_letters(const Substring& a, const Substring& b) const {
    const auto letters = context_.string.letters.begin();
    return std::equal(letters + a.first, letters + a.last + 1, letters + b.first,
                      letters + b.last + 1);
}

template <int Words>
uint64_t SimilarSubstrings<Words>::letter_hash(const Substring& substring) const {
    return hashes_[static_cast<size_t>(substring.last) + 1] -
           hashes_[static_cast<size_t>(substring.first)] *
               powers_[static_cast<size_t>(substring.letters())];
}

template <int Words>
void SimilarSubstrings<Words>::spread_from(std::span<const Substring> sources, Level& reached) {
    if (resources_.ranks && sources.size() >= resources_.least_shared) {
        spread_shared(sources, *resources_.ranks, reached);
        return;
    }
    tables_.prepare(sources);
    for (const Substring& substring : sources) reach(tables_.matches(substring), reached);
}

template <int Words>
void SimilarSubstrings<Words>::spread_shared(std::span<const Substring> sources,
                                             Communicator& ranks, Level& reached) {
    std::vector<Substring> mine;
    std::ranges::copy_if(sources, std::back_inserter(mine), [&](const Substring& substring) {
        return substring.first % ranks.size() == ranks.rank();
    });
    tables_.prepare(mine);
    Level reached_here;
    for (const Substring& substring : mine) reach(tables_.matches(substring), reached_here);
    Packer out;
    pack_each(out, reached_here, [&](const auto& one) { pack_all(out, one.first, one.last); });

    Level reached_anywhere;
    for (std::string& brought : ranks.gather_to_all(out.take())) {
        Unpacker in(std::move(brought));
        Level reached_there;
        unpack_each(in, reached_there, [&](auto& one) { unpack_all(in, one.first, one.last); });
        reached_anywhere.insert(reached_anywhere.end(), reached_there.begin(), reached_there.end());
    }
    std::ranges::sort(reached_anywhere);  // several may have reached one
    const auto again = std::ranges::unique(reached_anywhere);
    reached_anywhere.erase(again.begin(), again.end());
    for (const Substring& substring : reached_anywhere) visit(substring);
    reached.insert(reached.end(), reached_anywhere.begin(), reached_anywhere.end());
}

template <int Words>
void SimilarSubstrings<Words>::reach(std::span<const ReachCell<Words>> matches, Level& reached) {
    using Mask = ReachMask<Words>;
    for (const ReachCell<Words>& cell : matches) {
        // A substring has two letters or more, and no interval that has been partitioned since the
        // table was made.
        const int32_t open = context_.open.run_before(cell.column, context_.most_letters - 1);
        const Mask starts = (cell.starts & Mask::lowest(open + 1))
                                .without(Mask::lowest(1))
                                .without(visited_[static_cast<size_t>(cell.column)]);
        starts.for_each([&](int32_t letters_before) {
            const Substring found{cell.column - letters_before, cell.column};
            if (!length_allowed(found)) return;
            visit(found);
            reached.push_back(found);
        });
    }
}

template <int Words>
void SimilarSubstrings<Words>::visit(const Substring& substring) {
    using Mask = ReachMask<Words>;
    Mask& mask = visited_[static_cast<size_t>(substring.last)];
    if (!mask.any()) visited_lasts_.push_back(substring.last);
    mask |= Mask::lowest(substring.letters()).without(Mask::lowest(substring.letters() - 1));
}

template class SimilarSubstrings<1>;
template class SimilarSubstrings<2>;
template class SimilarSubstrings<4>;
template class SimilarSubstrings<8>;

}  // namespace kinetome
