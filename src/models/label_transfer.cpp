#include "kinetome/models/label_transfer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kinetome/base/parallel.h"
#include "primitive_rows.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// More would make the limits hardly surer, and each is compared with all others.
constexpr int64_t most_asked = 512;

void check(const LabelTransferOptions& options) {
    const auto is_share = [](double value) { return value > 0 && value <= 1; };
    if (!(options.threshold > 0 && is_share(options.lead) && is_share(options.recognised))) {
        throw std::invalid_argument(
            "labels take a threshold above 0, and a lead and a share of known primitives above 0 "
            "and up to 1");
    }
}

/// The least value that at least the share of all values like these does not exceed, as far as so
/// few can tell (the bound of split conformal prediction).
std::optional<double> upper_quantile(std::vector<double> values, double share) {
    const auto rank = std::llround(std::ceil(share * double(values.size() + 1)));
    if (rank > static_cast<int64_t>(values.size())) return std::nullopt;
    const auto at = values.begin() + rank - 1;
    std::ranges::nth_element(values, at);
    return *at;
}

}  // namespace

/// Runs in the order of what they cost at least, so that most need not be tried.
class KnowledgeBase::Search {
  public:
    struct Found {
        double cost = infinite;
        int64_t run = -1;
    };

    Search(const KnowledgeBase& known, const MatrixFView& primitive)
        : query_(known.search_->query(primitive)), order_(known.runs_.size()) {
        std::iota(order_.begin(), order_.end(), int64_t{0});
        std::ranges::stable_sort(order_, {}, [&](int64_t run) { return query_.bound(run); });
    }

    /// The cheapest run among those that are asked for, the first of equal ones.
    template <class Asked>
    Found cheapest(double at_most, Asked&& asked) const {
        Found best{at_most, -1};
        for (const int64_t run : order_) {
            if (query_.bound(run) > best.cost) break;
            if (!asked(run)) continue;
            const double cost = query_.cost(run, best.cost);
            if (cost == infinite) continue;
            if (cost < best.cost || best.run < 0 || run < best.run) best = {cost, run};
        }
        return best.run < 0 ? Found{} : best;
    }

  private:
    WarpQuery query_;
    std::vector<int64_t> order_;
};

KnowledgeBase::KnowledgeBase(const MatrixFView& features,
                             std::span<const CorpusPrimitive> primitives,
                             std::span<const int32_t> labels) {
    if (primitives.size() != labels.size()) {
        throw std::invalid_argument("each known primitive must have one label");
    }
    require_rows(features, primitives);
    std::vector<RowRange> sequences;
    for (size_t p = 0; p < primitives.size(); ++p) {
        if (labels[p] < 0) continue;
        const bool goes_on =
            p > 0 && labels[p - 1] == labels[p] && adjoin(primitives[p - 1], primitives[p]);
        if (!goes_on) {
            runs_.push_back({labels[p], primitives[p].clip, {}, {}});
            sequences.push_back({primitives[p].rows.first, primitives[p].rows.first});
        }
        sequences.back().end = primitives[p].rows.end;
        runs_.back().sources.push_back(static_cast<int64_t>(p));
        runs_.back().ends.push_back(sequences.back().size());
    }
    if (!runs_.empty()) search_.emplace(features, sequences);
}

std::vector<KnowledgeBase::Place> KnowledgeBase::places() const {
    std::vector<Place> places;
    for (size_t r = 0; r < runs_.size(); ++r) {
        int64_t first = 0;
        for (const int64_t end : runs_[r].ends) {
            places.push_back({static_cast<int64_t>(r), {first, end}});
            first = end;
        }
    }
    return places;
}

KnowledgeBase::OwnLabel KnowledgeBase::own_label(const Place& place, double lead) const {
    const Run& home = runs_[static_cast<size_t>(place.run)];
    const auto elsewhere = [&](int64_t run) { return runs_[size_t(run)].clip != home.clip; };
    const auto alike = [&](int64_t run) { return runs_[size_t(run)].label == home.label; };
    const Search search(
        *this, search_->rows_of(place.run).middleRows(place.rows.first, place.rows.size()));
    const auto same =
        search.cheapest(infinite, [&](int64_t run) { return elsewhere(run) && alike(run); });
    if (same.run < 0) return {};
    const auto next = search.cheapest(same.cost / lead,
                                      [&](int64_t run) { return elsewhere(run) && !alike(run); });
    if (next.run < 0) return {same.cost, 0};
    return {same.cost, next.cost > 0 ? same.cost / next.cost : 1};
}

LabelLimits KnowledgeBase::limits(const LabelTransferOptions& options, int threads) const {
    check(options);
    if (options.recognised == 1) return {options.threshold, options.lead};
    const std::vector<Place> known = places();
    const auto count = static_cast<int64_t>(known.size());
    const int64_t asked = std::min(count, most_asked);
    std::vector<OwnLabel> own(static_cast<size_t>(asked));
    parallel_for(threads, asked, [&](int64_t i) {
        own[size_t(i)] = own_label(known[static_cast<size_t>(i * count / asked)], options.lead);
    });
    std::vector<double> costs, shares;
    for (const OwnLabel& one : own) {
        if (one.cost == infinite) continue;
        costs.push_back(one.cost);
        shares.push_back(one.share_of_next);
    }
    const auto cost = upper_quantile(std::move(costs), options.recognised);
    const auto share = upper_quantile(std::move(shares), options.recognised);
    return {std::min(options.threshold, cost.value_or(infinite)),
            std::clamp(share.value_or(0), options.lead, 1.0)};
}

LabelGuess KnowledgeBase::label_of(const MatrixFView& primitive, const LabelLimits& limits) const {
    if (!search_ || primitive.rows() == 0) return {};
    const Search search(*this, primitive);
    const auto nearest = search.cheapest(limits.threshold, [](int64_t) { return true; });
    if (nearest.run < 0) return {};
    const int32_t label = runs_[static_cast<size_t>(nearest.run)].label;
    const auto rival = search.cheapest(nearest.cost / limits.lead, [&](int64_t run) {
        return runs_[static_cast<size_t>(run)].label != label;
    });
    return {rival.run < 0 ? label : -1, nearest.cost, rival.cost,
            source_of(primitive, nearest.run, nearest.cost)};
}

int64_t KnowledgeBase::source_of(const MatrixFView& primitive, int64_t run, double cost) const {
    const Run& home = runs_[static_cast<size_t>(run)];
    for (const WarpPath& path : warp_matches(primitive, search_->rows_of(run), {cost})) {
        const int64_t middle = (path.cells.front().second + path.cells.back().second) / 2;
        const auto end = std::ranges::upper_bound(home.ends, middle);
        return home.sources[static_cast<size_t>(end - home.ends.begin())];
    }
    return -1;
}

std::vector<LabelGuess> transfer_labels(const KnowledgeBase& known, const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const LabelTransferOptions& options, int threads) {
    require_rows(features, primitives);
    const LabelLimits limits = known.limits(options, threads);
    std::vector<LabelGuess> guesses(primitives.size());
    parallel_for(threads, static_cast<int64_t>(primitives.size()), [&](int64_t i) {
        guesses[size_t(i)] = known.label_of(rows_of(features, primitives[size_t(i)]), limits);
    });
    return guesses;
}

}  // namespace kinetome
