// segments: every take cut into activities and transitions (S3 §3.1).
#include "kinetome/base/pack_fields.h"
#include "kinetome/models/take_segmentation.h"
#include "kinetome/stages/graph_takes.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/stages/segmentation_options.h"
#include "kinetome/stages/stage.h"

namespace kinetome {
namespace {

/// What a take is cut into, as it travels between ranks.
struct TakeSegments {
    std::vector<Segment> segments;
};

void pack(Packer& out, const TakeSegments& take) {
    pack_each(out, take.segments, [&](const Segment& one) {
        pack_all(out, one.frames.first, one.frames.end, static_cast<int32_t>(one.kind),
                 one.cluster);
    });
}

void unpack(Unpacker& in, TakeSegments& take) {
    unpack_each(in, take.segments, [&](Segment& one) {
        int32_t kind = 0;
        unpack_all(in, one.frames.first, one.frames.end, kind, one.cluster);
        one.kind = static_cast<SegmentKind>(kind);
    });
}

}  // namespace

StageResult make_segments(const StageContext& context, const StageTask& task) {
    const GraphTakes takes(context, task);
    auto cut = for_takes<TakeSegments>(context, takes, [&](size_t i) {
        const GraphTake take = takes.read(i);
        return TakeSegments{segment_take(take.graph, take.features,
                                         segmentation_options(context.options, takes.places()[i]))};
    });
    StageResult result;
    if (!context.is_root()) return result;
    std::vector<SegmentedClip> clips;
    int64_t activities = 0, transitions = 0;
    for (size_t i = 0; i < cut.size(); ++i) {
        clips.push_back({cut_clip(takes.places()[i]), std::move(cut[i].segments)});
        for (const Segment& segment : clips.back().segments) {
            ++(segment.kind == SegmentKind::activity ? activities : transitions);
        }
    }
    ArtifactWriter file(task.output, task.header, context.writing());
    write_segments(file, clips, context.options.features.effector_rate);
    context.log.info("segments: {} activities and {} transitions in {} takes", activities,
                     transitions, clips.size());
    result.file = file.close();
    return result;
}

}  // namespace kinetome
