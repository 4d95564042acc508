// Where in a collection a query may be answered: what the occurrences of its leaves speak for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/signature_index.h"

namespace kinetome {

/// Frames of a clip that hold the match, if there is one.
struct SignaturePlace {
    int32_t clip = 0;
    RowRange frames;
};

/// The places that most of the query speaks for, at most `options.places`. An occurrence of a near
/// leaf puts the middle of the query where that run of the clip would answer the query's run; what
/// the query's runs say is added up over a quarter of its length around, each counting with its
/// frames and with its nearest leaf alone. `clip_of_run` has one for each run of all clips.
std::vector<SignaturePlace> likely_places(const SignatureIndex::Parts& parts,
                                          std::span<const int32_t> clip_of_run,
                                          std::span<const SignatureRun> query,
                                          const SignatureSearchOptions& options);

}  // namespace kinetome
