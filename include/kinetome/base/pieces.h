// How the frames of a corpus are cut for every sum that must not depend on threads, ranks or
// shards (design §5): clips in name order form groups where a hash of the clip's name says so, at a
// size that is a constant of the program; the frames of a group form pieces.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace kinetome {

/// Mean frames of a group. Also the least --shard-frames, so that a shard is whole groups.
inline constexpr int64_t group_frames = 8192;
/// A piece is closed at the first block boundary at or after this many frames.
inline constexpr int64_t piece_frames = 2048;

/// One clip as the cutting sees it.
struct ClipExtent {
    uint64_t name_hash = 0;  ///< hash_name(name)
    int64_t claimed = 0;  ///< frames its source file claims; decides the cuts, quarantined or not
    int64_t rows = 0;     ///< rows it contributes to the matrix at hand (0: none)
};

/// Whether a run of clips ends after this one, for runs of `mean_frames` on average. A cut at some
/// mean is also a cut at every smaller mean: shards are whole groups.
bool cut_after(const ClipExtent& clip, int64_t mean_frames);

struct RowRange {
    int64_t first = 0;
    int64_t end = 0;
    int64_t size() const { return end - first; }
    bool operator==(const RowRange&) const = default;
};

/// Pieces in row order; group g holds pieces [group_first[g], group_first[g + 1]).
struct PieceLayout {
    std::vector<RowRange> pieces;
    std::vector<int64_t> group_first{0};

    int64_t group_count() const { return static_cast<int64_t>(group_first.size()) - 1; }
    int64_t rows() const { return pieces.empty() ? 0 : pieces.back().end; }
};

/// Cuts the rows of clips (in name order) into groups and pieces. Blocks start at the beginning of
/// a clip and have at most piece_frames rows; short clips share a piece, long ones have several. A
/// piece has less than 2 · piece_frames rows. The last group ends with the last clip.
/// Groups without rows are kept, empty, so that group numbers agree between matrices.
PieceLayout layout_pieces(std::span<const ClipExtent> clips);

/// The layout of a matrix that is not cut by clips: one group, pieces of piece_frames rows and what
/// remains; no group when there are no rows.
PieceLayout layout_rows(int64_t rows);

}  // namespace kinetome
