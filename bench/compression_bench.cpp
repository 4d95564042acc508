// How fast are clips compressed and decompressed, how small do they become, and how far are they
// off?
//     compression_bench STORE
// STORE: with pose hierarchies. Poses are the normalised markers; motion is the skeleton fitted to
// them. Frames of all clips of a class, each clip from beginning to end.
#include <fmt/format.h>

#include <map>

#include "cost.h"
#include "kinetome/stages/motion_compression.h"
#include "kinetome/stages/open_store.h"
#include "program.h"

namespace {

using namespace kinetome;

/// A line for a class of clips, compressed to the file.
void measure(const Generation& generation, const std::string& clip_class,
             const std::vector<std::string>& clips, const std::filesystem::path& path) {
    CompressedMotion made;
    const auto compression =
        bench::cost_of([&] { made = compress_clips(generation, clips, path); });
    const CompressedFile file(path);
    const auto poses = bench::cost_of([&] {
        for (const CompressedClip& clip : file.head().clips) decompressed_poses(file, clip, {});
    });
    const auto motion = bench::cost_of([&] {
        for (const CompressedClip& clip : file.head().clips) decompressed_motion(file, clip, {}, 1);
    });
    int64_t frames = 0;
    for (const CompressedClip& clip : made.head.clips) frames += clip.frames;
    const auto a_second = [&](const bench::Cost& cost) { return double(frames) / cost.cpu; };
    fmt::print("{:>16} {:>8} {:>6.2f} {:>7.2f} {:>12.0f} {:>10.0f} {:>10.0f}\n", clip_class, frames,
               made.size.ratio(made.head), made.head.errors.rms, a_second(compression),
               a_second(poses), a_second(motion));
}

bool run(const std::filesystem::path& path, const std::filesystem::path& output) {
    const OpenStore store(path);
    std::map<std::string, std::vector<std::string>> clips_of;
    for (const CatalogClip& clip : store.generation.catalog().clips) {
        if (clip.frames > 0) clips_of[clip.clip_class].push_back(clip.name);
    }
    fmt::print("{:>16} {:>8} {:>6} {:>7} {:>12} {:>10} {:>10}   frames a second of processor\n",
               "class", "frames", "ratio", "rms mm", "compressed", "to poses", "to motion");
    for (const auto& [clip_class, clips] : clips_of) {
        measure(store.generation, clip_class, clips, output);
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    std::filesystem::path store, output = "compressed.motion";
    bench::Program program("How fast are clips compressed and decompressed?");
    program.argument("store", store, "with pose hierarchies");
    program.argument("output", output, "file that is written (default: compressed.motion)",
                     bench::Program::Need::optional);
    return program.run(argc, argv, [&] { return run(store, output); });
}
