#include "kinetome/synthesis/corpus_generator.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/write_amc.h"
#include "kinetome/formats/write_bvh.h"
#include "take_maker.h"
#include "text_file.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw create_error("create", folder, error.value());
}

/// "takes/" and "takes" are one folder, but differ in what stands beside them.
fs::path without_final_slash(const fs::path& folder) {
    const fs::path whole = fs::absolute(folder).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

void refuse_occupied(const fs::path& folder) {
    std::error_code error;
    if (!fs::exists(folder, error)) return;
    if (!fs::is_directory(folder, error) || !fs::is_empty(folder, error))
        throw UsageError(folder.string() +
                         " is not an empty folder; name a new one, or remove it first");
}

void write_text(const fs::path& path, std::string_view text) {
    TextFile file(path);
    file.text() = text;
    file.close();
}

std::span<const float> frame_of(const Clip& clip, int64_t frame) {
    return {clip.motion.row(frame).data(), static_cast<size_t>(clip.motion.cols())};
}

void write_amc_file(const Clip& clip, const fs::path& path) {
    TextFile file(path);
    append_amc_header(file.text());
    for (int64_t frame = 0; frame < clip.frames(); ++frame) {
        append_amc_frame(file.text(), *clip.skeleton, frame + 1, frame_of(clip, frame));
        file.write_if_large();
    }
    file.close();
}

void write_bvh_file(const Clip& clip, const fs::path& path) {
    TextFile file(path);
    BvhWriter writer(clip.skeleton);
    writer.append_header(file.text(), clip.frames(), clip.rate);
    for (int64_t frame = 0; frame < clip.frames(); ++frame) {
        writer.append_frame(file.text(), frame_of(clip, frame));
        file.write_if_large();
    }
    file.close();
}

void write_take(const NewTake& take, const fs::path& folder, MotionFormat format) {
    const fs::path home = folder / take.subject;
    make_folder(home);
    if (format == MotionFormat::bvh) {
        write_bvh_file(take.clip, home / (take.name + ".bvh"));
        return;
    }
    if (take.first_of_subject)
        write_text(home / (take.subject + ".asf"), write_asf(*take.clip.skeleton));
    write_amc_file(take.clip, home / (take.name + ".amc"));
}

/// Makes and writes all takes; returns their annotations in order.
Annotations write_takes(const TakeMaker& maker, const fs::path& folder, MotionFormat format,
                        int threads, const FramesDone& frames_done, const StopToken& stop) {
    std::vector<Annotations> annotations(static_cast<size_t>(maker.takes()));
    const tbb::global_control granted(tbb::global_control::max_allowed_parallelism,
                                      static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] {
        const auto one = [&](int64_t index) {
            stop.check();
            NewTake take = maker.make(index);
            write_take(take, folder, format);
            annotations[static_cast<size_t>(index)] = std::move(take.annotations);
            if (frames_done) frames_done(take.clip.frames());
        };
        tbb::parallel_for(int64_t{0}, maker.takes(), one, tbb::simple_partitioner());
    });
    Annotations all;
    for (const Annotations& one : annotations) all.append(one);
    return all;
}

}  // namespace

GenerateSummary generate_corpus(const GenerateOptions& options, const fs::path& output, int threads,
                                const FramesDone& frames_done, const StopToken& stop) {
    const fs::path folder = without_final_slash(output);
    if (options.frames < 1) throw UsageError("a corpus needs at least one frame: give --frames");
    if (!options.from.empty() && options.subjects > 0)
        throw UsageError("--subjects does not go with --from: its takes bring their performers");
    refuse_occupied(folder);
    const std::unique_ptr<TakeMaker> maker =
        options.from.empty() ? procedural_takes(options) : varied_takes(options);

    const fs::path incomplete = folder.string() + ".incomplete";
    std::error_code error;
    fs::remove_all(incomplete, error);
    if (error) throw create_error("replace", incomplete, error.value());
    make_folder(incomplete);
    const Annotations annotations =
        write_takes(*maker, incomplete, options.format, threads, frames_done, stop);
    write_text(incomplete / "truth.csv", write_truth_csv(annotations.truth));
    write_text(incomplete / "cycles.csv", write_cycles_csv(annotations.cycles));
    fs::rename(incomplete, folder, error);
    if (error) throw create_error("create", folder, error.value());
    return {.frames = options.frames,
            .takes = maker->takes(),
            .subjects = maker->subjects(),
            .segments = static_cast<int64_t>(annotations.truth.size()),
            .cycles = static_cast<int64_t>(annotations.cycles.size())};
}

}  // namespace kinetome
