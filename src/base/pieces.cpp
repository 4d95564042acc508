#include "kinetome/base/pieces.h"

#include <algorithm>

#include "wide_integer.h"

namespace kinetome {
namespace {

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): cuts must not follow from the hash
/// itself, which also numbers clips.
uint64_t remix(uint64_t hash) {
    hash += 0x9E3779B97F4A7C15;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EB;
    return hash ^ (hash >> 31);
}

/// Appends blocks to the last piece until it is full, and closes groups.
class LayoutBuilder {
  public:
    void add_block(int64_t rows) {
        end_ += rows;
        if (end_ - first_ >= piece_frames) close_piece();
    }
    void close_group() {
        if (end_ > first_) close_piece();
        layout_.group_first.push_back(static_cast<int64_t>(layout_.pieces.size()));
    }
    PieceLayout finish() { return std::move(layout_); }

  private:
    void close_piece() {
        layout_.pieces.push_back({first_, end_});
        first_ = end_;
    }

    PieceLayout layout_;
    int64_t first_ = 0;
    int64_t end_ = 0;
};

void add_blocks(int64_t rows, LayoutBuilder& builder) {
    for (int64_t row = 0; row < rows; row += piece_frames) {
        builder.add_block(std::min(piece_frames, rows - row));
    }
}

}  // namespace

// With u = remix(hash) / 2^64, the test is u < claimed / mean_frames, in whole numbers.
bool cut_after(const ClipExtent& clip, int64_t mean_frames) {
    if (clip.claimed <= 0) return false;
    if (clip.claimed >= mean_frames) return true;
    return WideUnsigned{remix(clip.name_hash)} * static_cast<uint64_t>(mean_frames) <
           WideUnsigned{static_cast<uint64_t>(clip.claimed)} << 64;
}

PieceLayout layout_pieces(std::span<const ClipExtent> clips) {
    LayoutBuilder builder;
    bool group_open = false;
    for (const ClipExtent& clip : clips) {
        add_blocks(clip.rows, builder);
        group_open = !cut_after(clip, group_frames);
        if (!group_open) builder.close_group();
    }
    if (group_open) builder.close_group();
    return builder.finish();
}

PieceLayout layout_rows(int64_t rows) {
    LayoutBuilder builder;
    add_blocks(rows, builder);
    if (rows > 0) builder.close_group();
    return builder.finish();
}

}  // namespace kinetome
