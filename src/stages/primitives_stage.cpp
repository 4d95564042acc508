// primitives: the single executions of the movements that activities repeat, and which of them are
// the same, in a take and across the corpus (S3 §3.2, §4).
#include <algorithm>
#include <map>

#include "kinetome/base/pack_fields.h"
#include "kinetome/models/adapted_radius.h"
#include "kinetome/models/alternations.h"
#include "kinetome/models/take_segmentation.h"
#include "kinetome/stages/graph_takes.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/stages/segmentation_options.h"
#include "kinetome/stages/stage.h"

namespace kinetome {
// Found where for_takes looks for them: beside the type.
static void pack(Packer& out, const TakePrimitives& take) {
    pack_each(out, take.primitives, [&](const Primitive& one) {
        pack_all(out, one.frames.first, one.frames.end, one.activity);
    });
    pack(out, take.clusters);
}

static void unpack(Unpacker& in, TakePrimitives& take) {
    unpack_each(in, take.primitives, [&](Primitive& one) {
        unpack_all(in, one.frames.first, one.frames.end, one.activity);
    });
    unpack(in, take.clusters);
}

namespace {

/// Clusters across the corpus, of the primitives of all takes one after another.
std::vector<int32_t> corpus_clusters(const StageContext& context, const GraphTakes& takes,
                                     const std::vector<TakePrimitives>& found) {
    int64_t frames = 0;
    for (const GraphTakePlace& place : takes.places()) frames += place.frames;
    MatrixF features;
    std::vector<CorpusPrimitive> primitives;
    int64_t row = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        context.stop.check();
        const MatrixF rows = takes.features(i);
        if (features.rows() == 0) features.resize(frames, rows.cols());
        features.middleRows(row, rows.rows()) = rows;
        for (const Primitive& primitive : found[i].primitives) {
            primitives.push_back({static_cast<int64_t>(i),
                                  {row + primitive.frames.first, row + primitive.frames.end}});
        }
        row += rows.rows();
    }
    PrimitiveClusterOptions options = context.options.primitive_clusters;
    for (double* distance : {&options.threshold, &options.radius}) {
        *distance = radius_for_effectors(*distance, context.options.neighbors.joints.size());
    }
    return cluster_primitives(features, primitives, options, context.resources.threads);
}

}  // namespace

StageResult make_primitives(const StageContext& context, const StageTask& task) {
    const GraphTakes takes(context, task);
    std::map<std::string, std::vector<Segment>> segments;
    for (SegmentedClip& clip :
         read_segments(context.workspace.open(*task.inputs_of("segments").front()))) {
        segments[clip.clip.name] = std::move(clip.segments);
    }
    const auto found = for_takes<TakePrimitives>(context, takes, [&](size_t i) {
        const GraphTakePlace& place = takes.places()[i];
        const SegmentationOptions options = segmentation_options(context.options, place);
        const GraphTake take = takes.read(i);
        TakePrimitives result;
        result.primitives = find_primitives(take.features, take.graph, segments.at(place.clip.name),
                                            options.primitives);
        result.clusters = cluster_take(take.features, result.primitives, options.clusters);
        if (!context.options.alternations.joined) return result;
        return join_alternations(take.features, std::move(result), context.options.alternations,
                                 options.clusters);
    });
    StageResult result;
    if (!context.is_root()) return result;
    const std::vector<int32_t> clusters = corpus_clusters(context, takes, found);
    std::vector<PrimitiveClip> clips;
    auto cluster = clusters.begin();
    for (size_t i = 0; i < found.size(); ++i) {
        clips.push_back({cut_clip(takes.places()[i]), {}});
        for (size_t p = 0; p < found[i].primitives.size(); ++p) {
            clips.back().primitives.push_back(
                {found[i].primitives[p], found[i].clusters[p], *cluster++});
        }
    }
    ArtifactWriter file(task.output, task.header, context.writing());
    write_primitives(file, clips, context.options.features.effector_rate);
    const auto highest = std::max_element(clusters.begin(), clusters.end());
    context.log.info("primitives: {} in {} clusters", clusters.size(),
                     clusters.empty() ? 0 : *highest + 1);
    result.file = file.close();
    return result;
}

}  // namespace kinetome
