// The key of a piece of work: what its result depends on, and nothing else. Equal keys mean equal
// results, so the result can be taken from an earlier run (design §4).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinetome/base/digest.h"

namespace kinetome {

/// Named parts (format version, inputs, options), kept so that a log can say which of them changed.
/// Threads, ranks and paths have no place here.
class StageKey {
  public:
    using Part = std::pair<std::string, std::string>;

    StageKey() = default;
    explicit StageKey(std::vector<Part> parts) : parts_(std::move(parts)) {}

    StageKey& add(std::string name, std::string value);
    StageKey& add(std::string name, const Digest& value) {
        return add(std::move(name), value.hex());
    }

    Digest digest() const;
    const std::vector<Part>& parts() const { return parts_; }

    /// Why work under `this` key cannot use a result made under `earlier`: "option clusters was
    /// 250, is 300". Empty when the keys are equal.
    std::string difference_from(const StageKey& earlier) const;

  private:
    std::vector<Part> parts_;
};

}  // namespace kinetome
