#include "kinetome/models/reach_tables.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace kinetome {
namespace {

/// Fewer tables are not worth waking other threads for.
constexpr size_t least_in_parallel = 16;

}  // namespace

template <int Words>
ReachTables<Words>::ReachTables(const MatchingContext& context, const BundleResources& resources)
    : context_(context),
      most_bytes_(resources.table_bytes),
      tables_(static_cast<size_t>(context.string.size())) {
    if (resources.threads > 1) arena_ = std::make_unique<tbb::task_arena>(resources.threads);
}

template <int Words>
std::span<const ReachCell<Words>> ReachTables<Words>::matches(const Substring& substring) const {
    return tables_[static_cast<size_t>(substring.first)]->row_of(substring.last);
}

/// One request a table, so that each is extended by one thread.
template <int Words>
auto ReachTables<Words>::missing(std::span<const Substring> wanted) const -> std::vector<Request> {
    std::vector<Request> requests;
    for (const Substring& substring : wanted) {
        const auto& table = tables_[static_cast<size_t>(substring.first)];
        if (!table || !table->holds(substring.last))
            requests.push_back({substring.first, substring.last});
    }
    std::ranges::sort(requests, [](const Request& a, const Request& b) {
        return a.first != b.first ? a.first < b.first : a.last > b.last;
    });
    const auto rest = std::ranges::unique(requests, {}, &Request::first);
    requests.erase(rest.begin(), rest.end());
    return requests;
}

template <int Words>
void ReachTables<Words>::prepare(std::span<const Substring> wanted) {
    const std::vector<Request> requests = missing(wanted);
    if (requests.empty()) return;
    for (const Request& request : requests) {
        auto& table = tables_[static_cast<size_t>(request.first)];
        if (table) {
            bytes_ -= table->bytes();
        } else {
            table = std::make_unique<ReachTable<Words>>(request.first);
            made_.push_back(request.first);
        }
    }
    const auto make = [&](size_t i) {
        tables_[static_cast<size_t>(requests[i].first)]->extend_to(requests[i].last, context_);
    };
    if (arena_ && requests.size() >= least_in_parallel) {
        arena_->execute([&] { tbb::parallel_for(size_t{0}, requests.size(), make); });
    } else {
        for (size_t i = 0; i < requests.size(); ++i) make(i);
    }
    for (const Request& request : requests) {
        bytes_ += tables_[static_cast<size_t>(request.first)]->bytes();
    }
    if (bytes_ > most_bytes_) evict(wanted);
}

/// Down to half of what is allowed, so that it is not called again at once.
template <int Words>
void ReachTables<Words>::evict(std::span<const Substring> wanted) {
    std::vector<int32_t> kept;
    for (const Substring& substring : wanted) kept.push_back(substring.first);
    std::ranges::sort(kept);
    for (size_t left = made_.size(); left > 0 && bytes_ > most_bytes_ / 2; --left) {
        const int32_t oldest = made_.front();
        made_.pop_front();
        if (std::ranges::binary_search(kept, oldest)) {
            made_.push_back(oldest);
            continue;
        }
        auto& table = tables_[static_cast<size_t>(oldest)];
        bytes_ -= table->bytes();
        table.reset();
    }
}

template class ReachTables<1>;
template class ReachTables<2>;
template class ReachTables<4>;
template class ReachTables<8>;

}  // namespace kinetome
