#include "kinetome/models/signature.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kinetome {

Signature make_signature(std::span<const int32_t> frame_leaves) {
    Signature signature;
    for (size_t frame = 0; frame < frame_leaves.size(); ++frame) {
        if (signature.empty() || signature.back().leaf != frame_leaves[frame]) {
            signature.push_back({frame_leaves[frame], static_cast<int32_t>(frame), 0});
        }
        ++signature.back().frames;
    }
    return signature;
}

int32_t frame_count(std::span<const SignatureRun> signature) {
    return signature.empty() ? 0 : signature.back().end_frame();
}

int64_t run_at(std::span<const SignatureRun> signature, int64_t frame) {
    const auto after = std::ranges::upper_bound(signature, frame, {}, &SignatureRun::first_frame);
    return after - signature.begin() - 1;
}

Signature part_of(std::span<const SignatureRun> signature, const RowRange& frames) {
    if (frames.first < 0 || frames.first > frames.end || frames.end > frame_count(signature)) {
        throw std::out_of_range(fmt::format("frames {}:{} are not all among {}", frames.first,
                                            frames.end, frame_count(signature)));
    }
    Signature part;
    if (frames.size() == 0) return part;
    for (const SignatureRun& run :
         signature.subspan(static_cast<size_t>(run_at(signature, frames.first)))) {
        if (run.first_frame >= frames.end) break;
        const int64_t first = std::max<int64_t>(run.first_frame, frames.first);
        const int64_t end = std::min<int64_t>(run.end_frame(), frames.end);
        part.push_back({run.leaf, static_cast<int32_t>(first - frames.first),
                        static_cast<int32_t>(end - first)});
    }
    return part;
}

}  // namespace kinetome
