#include "kinetome/models/bundle_links.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/base/parallel.h"
#include "kinetome/math/warp_search.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A member that speaks for its bundle. Ranges are of all rows.
struct Occurrence {
    int32_t bundle = 0, clip = 0, subject = 0;
    RowRange member, query, sequence;
};

bool overlap(const RowRange& a, const RowRange& b) {
    return a.first < b.end && b.first < a.end;
}

RowRange grown(const RowRange& range, int64_t before, int64_t after, const RowRange& within) {
    return {std::max(within.first, range.first - before), std::min(within.end, range.end + after)};
}

void check(const MatrixFView& rows, std::span<const RowRange> clips,
           std::span<const BundleMember> members, std::span<const int32_t> subject_of,
           const BundleLinkOptions& options) {
    if (clips.size() != subject_of.size())
        throw std::invalid_argument("each clip needs the number of its subject");
    for (const RowRange& clip : clips) {
        if (clip.first < 0 || clip.end < clip.first || clip.end > rows.rows())
            throw std::invalid_argument("a clip lies outside the rows");
    }
    for (const BundleMember& member : members) {
        const MotionPiece& frames = member.frames;
        if (frames.clip < 0 || static_cast<size_t>(frames.clip) >= clips.size())
            throw std::invalid_argument("a member is of a clip that is not there");
        if (frames.first < 0 || frames.frames() < 1 ||
            frames.end > clips[static_cast<size_t>(frames.clip)].size())
            throw std::invalid_argument("a member is empty or reaches beyond its clip");
    }
    if (options.surroundings < 1 || options.slip < 0 || options.members < 1 ||
        !(options.gamma > 0 && options.gamma <= 1) || !(options.unlike > 0) || !(options.reach > 0))
        throw std::invalid_argument("options of bundle links must be positive");
}

/// By bundle, clip and row; of bundles with more members than asked for some, evenly spaced.
std::vector<Occurrence> occurrences_of(std::span<const RowRange> clips,
                                       std::span<const BundleMember> members,
                                       std::span<const int32_t> subject_of,
                                       const BundleLinkOptions& options) {
    std::map<int32_t, std::vector<MotionPiece>> of_bundles;
    for (const BundleMember& member : members) of_bundles[member.bundle].push_back(member.frames);
    std::vector<Occurrence> all;
    for (auto& [bundle, pieces] : of_bundles) {
        std::ranges::sort(pieces, {}, [](const MotionPiece& piece) {
            return std::tuple(piece.clip, piece.first, piece.end);
        });
        const auto count = static_cast<int64_t>(pieces.size());
        const int64_t taken = std::min(count, options.members);
        for (int64_t i = 0; i < taken; ++i) {
            const MotionPiece& piece = pieces[static_cast<size_t>(i * count / taken)];
            const RowRange& clip = clips[static_cast<size_t>(piece.clip)];
            const RowRange member{clip.first + piece.first, clip.first + piece.end};
            const int64_t missing = std::max<int64_t>(0, options.surroundings - member.size());
            const RowRange query = grown(member, (missing + 1) / 2, (missing + 1) / 2, clip);
            const RowRange sequence =
                grown(member, options.surroundings, options.surroundings, clip);
            all.push_back({bundle, piece.clip, subject_of[static_cast<size_t>(piece.clip)], member,
                           query, sequence});
        }
    }
    return all;
}

/// A member found from another.
struct Found {
    double cost = infinite;
    int64_t row = 0, other_row = 0;  ///< that answer each other, of all rows
};

class MemberSearch {
  public:
    MemberSearch(const MatrixFView& rows, std::vector<Occurrence> occurrences,
                 const BundleLinkOptions& options)
        : rows_(rows),
          options_(options),
          occurrences_(std::move(occurrences)),
          search_(rows, sequences(occurrences_)) {}

    const std::vector<Occurrence>& occurrences() const { return occurrences_; }

    WarpQuery query(const Occurrence& from) const {
        return search_.query(rows_.middleRows(from.query.first, from.query.size()));
    }

    /// The occurrence `to`, where it is found from the one that the query is of.
    Found find(const WarpQuery& query, const Occurrence& from, size_t to, double at_most) const {
        Found found;
        if (query.bound(static_cast<int64_t>(to)) > at_most) return found;
        const Occurrence& other = occurrences_[to];
        MatchOptions match;
        match.at_most = at_most;
        const auto paths =
            warp_matches(rows_.middleRows(from.query.first, from.query.size()),
                         rows_.middleRows(other.sequence.first, other.sequence.size()), match);
        for (const WarpPath& path : paths) {
            if (path.mean >= found.cost) continue;
            const auto rows = answering_rows(path, from, other);
            if (!rows || !takes_as_long(path) || !moves_alike(path, from, other)) continue;
            found = {path.mean, rows->first, rows->second};
        }
        return found;
    }

  private:
    static std::vector<RowRange> sequences(const std::vector<Occurrence>& occurrences) {
        std::vector<RowRange> ranges;
        for (const Occurrence& occurrence : occurrences) ranges.push_back(occurrence.sequence);
        return ranges;
    }

    /// The middle of what answers the one member in the other, if half of the shorter of the two
    /// does: it must, but for a slip.
    std::optional<std::pair<int64_t, int64_t>> answering_rows(const WarpPath& path,
                                                              const Occurrence& from,
                                                              const Occurrence& to) const {
        std::vector<std::pair<int64_t, int64_t>> answers;
        for (const WarpCell& cell : path.cells) {
            const int64_t row = from.query.first + cell.first;
            if (row >= from.member.first && row < from.member.end)
                answers.emplace_back(row, to.sequence.first + cell.second);
        }
        if (answers.empty()) return std::nullopt;
        const RowRange answered{answers.front().second, answers.back().second + 1};
        const int64_t common = std::min(answered.end, to.member.end + options_.slip) -
                               std::max(answered.first, to.member.first - options_.slip);
        if (2 * common < std::min(answered.size(), to.member.size())) return std::nullopt;
        return answers[answers.size() / 2];
    }

    bool takes_as_long(const WarpPath& path) const {
        const WarpCell &first = path.cells.front(), &last = path.cells.back();
        const double length = last.first - first.first + 1, other = last.second - first.second + 1;
        return length >= options_.gamma * other && other >= options_.gamma * length;
    }

    /// Σ|x - y|² <= unlike · (Σ|x|² + Σ|y|²), x and y about their means along the path.
    bool moves_alike(const WarpPath& path, const Occurrence& from, const Occurrence& to) const {
        const Eigen::Index columns = rows_.cols();
        const auto row_of = [&](int64_t row) -> Eigen::RowVectorXd {
            return rows_.row(row).cast<double>();
        };
        Eigen::RowVectorXd x_mean = Eigen::RowVectorXd::Zero(columns), y_mean = x_mean;
        for (const WarpCell& cell : path.cells) {
            x_mean += row_of(from.query.first + cell.first);
            y_mean += row_of(to.sequence.first + cell.second);
        }
        x_mean /= static_cast<double>(path.cells.size());
        y_mean /= static_cast<double>(path.cells.size());
        double apart = 0, moved = 0;
        for (const WarpCell& cell : path.cells) {
            const Eigen::RowVectorXd x = row_of(from.query.first + cell.first) - x_mean;
            const Eigen::RowVectorXd y = row_of(to.sequence.first + cell.second) - y_mean;
            apart += (x - y).squaredNorm();
            moved += x.squaredNorm() + y.squaredNorm();
        }
        return apart <= options_.unlike * moved;
    }

    MatrixFView rows_;
    BundleLinkOptions options_;
    std::vector<Occurrence> occurrences_;
    WarpSearch search_;
};

/// Median over members of the least cost to another of their bundle; the lower of two middle ones.
double usual_cost(const MemberSearch& search, int threads) {
    const auto& all = search.occurrences();
    std::vector<double> costs(all.size(), infinite);
    parallel_for(threads, static_cast<int64_t>(all.size()), [&](int64_t i) {
        const Occurrence& from = all[static_cast<size_t>(i)];
        const WarpQuery query = search.query(from);
        double& least = costs[static_cast<size_t>(i)];
        for (size_t to = 0; to < all.size(); ++to) {
            if (all[to].bundle != from.bundle || overlap(all[to].query, from.query)) continue;
            least = std::min(least, search.find(query, from, to, least).cost);
        }
    });
    std::erase(costs, infinite);
    if (costs.empty()) return 0;
    const auto middle = costs.begin() + static_cast<std::ptrdiff_t>((costs.size() - 1) / 2);
    std::nth_element(costs.begin(), middle, costs.end());
    return *middle;
}

using BundlePair = std::pair<int32_t, int32_t>;  ///< from, to
using FoundPairs = std::map<BundlePair, BundleLink>;

/// What the members of bundles lead to in those of other subjects, cheapest first.
FoundPairs find_pairs(const MemberSearch& search, std::span<const RowRange> clips, double at_most,
                      int threads) {
    const auto& all = search.occurrences();
    std::vector<FoundPairs> of_members(all.size());
    parallel_for(threads, static_cast<int64_t>(all.size()), [&](int64_t i) {
        const Occurrence& from = all[static_cast<size_t>(i)];
        FoundPairs& own = of_members[static_cast<size_t>(i)];
        const WarpQuery query = search.query(from);
        for (size_t to = 0; to < all.size(); ++to) {
            const Occurrence& other = all[to];
            if (other.subject == from.subject) continue;
            const Found found = search.find(query, from, to, at_most);
            if (found.cost > at_most) continue;
            const auto row_in = [&](int32_t clip, int64_t row) {
                return row - clips[static_cast<size_t>(clip)].first;
            };
            const BundleLink link{from.bundle,
                                  other.bundle,
                                  found.cost,
                                  from.clip,
                                  other.clip,
                                  row_in(from.clip, found.row),
                                  row_in(other.clip, found.other_row)};
            const auto [known, is_new] = own.try_emplace({from.bundle, other.bundle}, link);
            if (!is_new && link.cost < known->second.cost) known->second = link;
        }
    });
    FoundPairs pairs;
    for (const FoundPairs& own : of_members) {
        for (const auto& [pair, link] : own) {
            const auto [known, is_new] = pairs.try_emplace(pair, link);
            if (!is_new && link.cost < known->second.cost) known->second = link;
        }
    }
    return pairs;
}

}  // namespace

BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, int threads) {
    check(rows, clips, members, subject_of, options);
    const MemberSearch search(rows, occurrences_of(clips, members, subject_of, options), options);
    BundleLinks result;
    result.usual_cost = usual_cost(search, threads);
    if (result.usual_cost == 0) return result;
    const FoundPairs pairs = find_pairs(search, clips, options.reach * result.usual_cost, threads);
    for (const auto& [pair, link] : pairs) {
        if (pair.first < pair.second && pairs.contains({pair.second, pair.first}))
            result.links.push_back(link);
    }
    return result;
}

}  // namespace kinetome
