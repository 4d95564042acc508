// read → work → write over the clips of a shard: reading and writing in clip order, work in
// parallel, a bounded number of clips in memory.
#pragma once

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"

namespace kinetome {

/// Clips that may be in the pipeline at once: two a thread, fewer when the largest ones
/// (`largest_bytes` of memory each) would not fit in a quarter of the memory granted.
inline size_t clips_in_flight(const Resources& resources, uint64_t largest_bytes) {
    return std::clamp<uint64_t>(resources.memory_bytes / 4 / std::max<uint64_t>(largest_bytes, 1),
                                1, 2 * static_cast<uint64_t>(resources.threads));
}

/// `read` returns the next clip, or null at the end; `work` and `write` take a reference. Throws
/// what they throw, and Interrupted when a stop was asked for.
template <class Clip, class Read, class Work, class Write>
void run_clip_pipeline(size_t in_flight, const StopToken& stop, Read read, Work work, Write write) {
    using Token = std::shared_ptr<Clip>;
    const auto next = [&](tbb::flow_control& control) -> Token {
        Token clip = stop.requested() ? nullptr : read();
        if (!clip) control.stop();
        return clip;
    };
    const auto worked = [&](Token clip) {
        work(*clip);
        return clip;
    };
    tbb::parallel_pipeline(
        in_flight, tbb::make_filter<void, Token>(tbb::filter_mode::serial_in_order, next) &
                       tbb::make_filter<Token, Token>(tbb::filter_mode::parallel, worked) &
                       tbb::make_filter<Token, void>(tbb::filter_mode::serial_in_order,
                                                     [&](const Token& clip) { write(*clip); }));
    stop.check();
}

}  // namespace kinetome
