// segments.h5 and primitives.h5: what takes are cut into (S3), written by their stages and read by
// all who ask for it. Layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/models/segment.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// A clip that was cut; what it is cut into counts frames at a rate of its own: in these files the
/// effector rate.
struct CutClip {
    std::string name;
    std::string clip_class;
    int64_t frames = 0;  ///< at that rate
    int64_t source_frames = 0;
    double source_rate = 0;  ///< frames a second
};

struct SegmentedClip {
    CutClip clip;
    std::vector<Segment> segments;
};

struct StoredPrimitive {
    Primitive primitive;
    int32_t take_cluster = -1;  ///< among the primitives of its take
    int32_t cluster = -1;       ///< among those of the corpus
};

struct PrimitiveClip {
    CutClip clip;
    std::vector<StoredPrimitive> primitives;
};

/// Clips in name order, `rate`: the effector rate.
void write_segments(ArtifactWriter& file, const std::vector<SegmentedClip>& clips, double rate);
std::vector<SegmentedClip> read_segments(const ArtifactReader& file);

void write_primitives(ArtifactWriter& file, const std::vector<PrimitiveClip>& clips, double rate);
std::vector<PrimitiveClip> read_primitives(const ArtifactReader& file);

/// Frames a second that frames count at, of either file.
double effector_rate_of(const ArtifactReader& file);

/// A boundary at the rate of `clip.frames` as a frame of the source: the first that lies at it or
/// after it.
int64_t source_boundary(const CutClip& clip, int64_t frame, double rate);

/// What a file tells of the clips that it is about; `rate` names the rate of their frames.
void write_cut_clips(ArtifactWriter& file, const std::vector<CutClip>& clips, const char* rate);
std::vector<CutClip> read_cut_clips(const ArtifactReader& file);

/// The same clips with frames of the source, as exports and evaluations list them: without segments
/// and primitives that are so short that no frame of the source lies in them. Primitives go on
/// naming their activity by its number in segments.h5.
std::vector<SegmentedClip> in_source(std::vector<SegmentedClip> clips, double effector_rate);
std::vector<PrimitiveClip> in_source(std::vector<PrimitiveClip> clips, double effector_rate);

}  // namespace kinetome
