// Where the takes of a new corpus come from: each can be made by itself, in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "kinetome/formats/annotation.h"
#include "kinetome/formats/clip.h"
#include "kinetome/synthesis/corpus_generator.h"

namespace kinetome {

struct NewTake {
    std::string subject;            ///< folder, and stem of the skeleton's file
    std::string name;               ///< stem of the take's file
    bool first_of_subject = false;  ///< it brings the subject's skeleton file with it
    Clip clip;
    Annotations annotations;
};

class TakeMaker {
  public:
    virtual ~TakeMaker() = default;
    virtual int64_t takes() const = 0;
    virtual int64_t subjects() const = 0;
    /// Thread-safe; the same take for the same index.
    virtual NewTake make(int64_t index) const = 0;
};

/// Takes planned and performed from nothing.
std::unique_ptr<TakeMaker> procedural_takes(const GenerateOptions& options);

/// Takes of the corpus options.from, each time as other performers: time-warped, rescaled, half of
/// them mirrored; rows of its truth.csv and cycles.csv go along. Throws InputError.
std::unique_ptr<TakeMaker> varied_takes(const GenerateOptions& options);

}  // namespace kinetome
