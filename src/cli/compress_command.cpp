#include <fmt/format.h>

#include "clip_list.h"
#include "command.h"
#include "frame_range.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/write_bvh.h"
#include "kinetome/stages/motion_compression.h"
#include "kinetome/stages/open_store.h"

namespace kinetome::cli {
namespace {

struct CompressFlags {
    std::filesystem::path store, output;
    std::vector<std::string> clips;
    std::string generation = "current";
};

struct DecompressFlags {
    std::filesystem::path file, output;
    std::string clip, frames;
};

/// What every script may rely on, in the last line.
void print_last_line(const CompressedHead& head, const CompressedSize& size) {
    fmt::print("ratio {:.2f} rms_mm {:.2f} max_mm {:.2f}\n", size.ratio(head), head.errors.rms,
               head.errors.greatest);
}

ExitCode compress(const CompressFlags& flags) {
    const OpenStore open(flags.store, flags.generation);
    std::vector<std::string> clips = listed_clips(flags.clips, open.generation.catalog());
    if (clips.empty()) {
        for (const CatalogClip& clip : open.generation.catalog().clips) {
            if (clip.indexed()) clips.push_back(clip.name);
        }
    }
    const CompressedMotion made = compress_clips(open.generation, clips, flags.output);
    const CompressedSize& size = made.size;
    const PoseErrors& errors = made.head.errors;
    fmt::print("motion        {} clips, {} frames of {} joints\n", made.head.clips.size(),
               made.head.frames(), made.head.models.columns() / 3);
    fmt::print("file          {} bytes: {} leaves {}, frames {}, the rest {}\n", size.file,
               made.head.models.size(), size.models, size.blocks, size.rest);
    fmt::print("error         mean {:.2f} mm, 95 % of the frames within {:.2f} mm\n", errors.mean,
               errors.share_95);
    fmt::print("paper         ratio {:.2f} by C f k + N k\n", made.paper_ratio);
    print_last_line(made.head, size);
    return ExitCode::success;
}

ExitCode decompress(const DecompressFlags& flags, const Invocation& invocation) {
    if (flags.output.extension() != ".bvh") {
        throw UsageError(fmt::format("-o {}: expected a name that ends in .bvh",
                                     path_for_message(flags.output.string())));
    }
    std::optional<RowRange> frames;
    if (!flags.frames.empty()) frames = parse_frame_range(flags.frames);
    const CompressedFile file(flags.file);
    const Clip motion =
        decompressed_motion(file, file.find(flags.clip), frames, invocation.resources().threads);
    write_file_atomically(flags.output, write_bvh(motion));
    fmt::print("motion        {} frames at {:g} a second\n", motion.frames(), motion.rate);
    print_last_line(file.head(), file.size());
    return ExitCode::success;
}

}  // namespace

Command compress_command() {
    return {"compress", "write clips as coordinates on the leaves of the pose hierarchy",
            "kinetome compress motion.store --clip 02_01 -o 02_01.motion",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<CompressFlags>();
                app.add_option("STORE", flags->store, "store to read")->required();
                app.add_option("--clip", flags->clips,
                               "clips to compress, separated by commas (default: all)");
                app.add_option("-o,--output", flags->output, "file to write")->required();
                app.add_option("--generation", flags->generation,
                               "id, the beginning of one, or current");
                return [=](const Invocation&) { return compress(*flags); };
            }};
}

Command decompress_command() {
    return {"decompress", "play compressed motion, all of it or some frames",
            "kinetome decompress 02_01.motion --frames 120:360 -o part.bvh",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<DecompressFlags>();
                app.add_option("FILE", flags->file, "what compress wrote")->required();
                app.add_option("--clip", flags->clip, "which of its clips, if there are several");
                app.add_option("--frames", flags->frames,
                               "A:B, frames from A to before B (default: all)");
                app.add_option("-o,--output", flags->output, ".bvh file to write")->required();
                return [=](const Invocation& invocation) { return decompress(*flags, invocation); };
            }};
}

}  // namespace kinetome::cli
