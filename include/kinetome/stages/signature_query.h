// The sub-motions of a store that are most like a given one (S2 §5.3).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "kinetome/base/pieces.h"
#include "kinetome/models/signature_index.h"
#include "kinetome/run/generation.h"
#include "kinetome/stages/export.h"

namespace kinetome {

struct SignatureQuery {
    std::string clip;                ///< of the store; "": see file
    std::filesystem::path file;      ///< a take that need not be in the store
    std::optional<RowRange> frames;  ///< of the clip or the take, at its own rate; nothing: all
    int64_t answers = 10;            ///< k, that do not share more than 30 % of their frames
    SignatureSearchOptions search;
    bool rerank = false;  ///< by dynamic time warping of the markers themselves
};

/// rank,clip,first,end,distance: nearest first; frames at the source's rate, from 0, end exclusive;
/// distance in mm per marker, the mean along the alignment: between what the index keeps of poses
/// or runs (MatchRule), or with rerank between markers. A part of a clip of the store finds itself,
/// by MatchRule::pace to the frame. Throws UsageError for a clip that is not indexed, for frames
/// outside it and for a take of a class that the store has none of, InputError.
Table query_table(const Generation& generation, const SignatureQuery& query, int threads);

/// clip,first,end,leaf: runs of every signature, clips in name order; frames likewise.
Table signature_table(const Generation& generation);

}  // namespace kinetome
