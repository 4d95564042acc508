#include "kinetome/stages/stored_clips.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {

const CatalogClip& StoredClips::find(const std::string& name) const {
    const auto& clips = generation_.catalog().clips;
    const auto found = std::ranges::lower_bound(clips, name, {}, &CatalogClip::name);
    if (found == clips.end() || found->name != name || !found->indexed()) {
        throw UsageError(
            fmt::format("no clip {} is indexed; kinetome export STORE clips lists those that are",
                        quote_for_message(name)));
    }
    return *found;
}

StoredClip StoredClips::read(const std::string& name) {
    const CatalogClip& clip = find(name);
    auto shard = shards_.find(clip.shard);
    if (shard == shards_.end()) {
        for (const Receipt* const receipt : generation_.made_by("frames")) {
            if (receipt->shard != clip.shard) continue;
            shard = shards_
                        .emplace(clip.shard,
                                 FrameShardReader(generation_.open(receipt->file.file_name)))
                        .first;
        }
    }
    if (shard != shards_.end()) {
        const auto& clips = shard->second.clips();
        const auto found = std::ranges::find(clips, name, &FrameShardClip::name);
        if (found != clips.end())
            return shard->second.read(static_cast<size_t>(found - clips.begin()));
    }
    throw StoreError(
        fmt::format("the frames of clip {} are not in the store; kinetome verify "
                    "tells what is damaged",
                    quote_for_message(name)));
}

}  // namespace kinetome
