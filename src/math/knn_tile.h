// The exact search for up to eight queries that follow each other: nearest box first (Hjaltason &
// Samet 1999), until no box is near enough to change a list. Boxes and projected rows in float only
// rule rows out, with room for their rounding; what is left is measured in double.
#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/math/knn.h"
#include "knn_blocks.h"
#include "knn_nearest.h"

namespace kinetome {

class QueryTile {
  public:
    /// For at most `most` neighbours of each query.
    QueryTile(const RowBlocks& blocks, int64_t most);

    /// Searches for one to eight queries, each within the root of its own limit; `excluded` is
    /// empty or as long.
    void search(const MatrixFView& queries, std::span<const double> squared_limits,
                std::span<const RowRange> excluded);

    /// Of a query of the last search.
    std::span<const Neighbour> neighbours(int64_t query) {
        return nearest_[static_cast<size_t>(query)].sorted();
    }

  private:
    /// A box that may hold neighbours, as one number: the nearest box is the least. Of equally near
    /// ones the earlier comes first, so that among identical rows the first ones are found first.
    class Node {
      public:
        Node(float squared_gap, int level, int64_t box)
            : number_(uint64_t{std::bit_cast<uint32_t>(squared_gap)} << 32 |
                      static_cast<uint64_t>(box << (3 * level) << 4 | level)) {}
        float squared_gap() const { return std::bit_cast<float>(uint32_t(number_ >> 32)); }
        int level() const { return static_cast<int>(number_ & 15); }
        int64_t first_block() const { return static_cast<int64_t>(uint32_t(number_) >> 4); }
        int64_t box() const { return first_block() >> (3 * level()); }
        auto operator<=>(const Node&) const = default;

      private:
        uint64_t number_;
    };

    void load(const MatrixFView& queries, std::span<const double> squared_limits,
              std::span<const RowRange> excluded);
    void load_projected(const MatrixF& projected, const VectorF& slack);
    void set_reach(size_t query);

    void push_boxes(int level, int64_t group);
    Node pop();
    void prefetch(const Node& node) const;
    bool is_out_of_reach(const Node& node) const;
    /// No row of this block or a later one can change the list, however near it is.
    bool wants_none_from(size_t query, int64_t block) const;

    void visit(int64_t block);
    /// A bit for each query, or each row of the block.
    uint32_t queries_near(int64_t block) const;
    uint32_t rows_near(int64_t block, size_t query) const;
    uint32_t rows_allowed(int64_t block, size_t query) const;
    void measure(int64_t block, size_t query, double (&squared)[octet]) const;

    const RowBlocks& blocks_;
    int64_t most_;
    int64_t dimension_;  ///< of projected rows
    float rounding_;     ///< no projected distance comes out longer than by this factor

    int64_t size_ = 0;
    std::vector<double> values_;  ///< 8 × columns
    LaneBuffer projected_;        ///< dimension × 8
    LaneBuffer box_;  ///< dimension × (lowest, highest) of all, with room for the slack
    float slack_[octet];
    RowRange excluded_[octet];

    NearestRows nearest_[octet];
    float reach_[octet];          ///< what is farther among projected rows is no neighbour
    float squared_reach_[octet];  ///< negative where there is no query
    float largest_squared_reach_ = 0;
    std::vector<Node> queue_;
};

}  // namespace kinetome
