#include <fmt/format.h>

#include "checks.h"
#include "command.h"
#include "kinetome/base/progress.h"
#include "kinetome/synthesis/corpus_generator.h"

namespace kinetome::cli {

Command generate_command() {
    return {
        "generate", "make a corpus with known activities, cycles and labels",
        "kinetome generate --frames 100000 --seed 1 -o takes/", [](CLI::App& app) -> Run {
            auto options = std::make_shared<GenerateOptions>();
            auto folder = std::make_shared<std::filesystem::path>();
            app.add_option("--frames", options->frames, "frames of all takes together, at 120 Hz")
                ->required()
                ->check(above_zero());
            app.add_option("--seed", options->seed, "same seed, same bytes")->capture_default_str();
            app.add_option("-o,--output", *folder, "folder to make")->required();
            app.add_option("--subjects", options->subjects,
                           "performers (default: one for about 12 takes)");
            app.add_option("--from", options->from,
                           "warp, mirror and rescale the takes of this folder instead");
            app.add_option_function<std::string>(
                   "--format",
                   [=](const std::string& text) {
                       options->format = text == "bvh" ? MotionFormat::bvh : MotionFormat::amc;
                   },
                   "of the takes: amc or bvh")
                ->check(CLI::IsMember({"amc", "bvh"}));
            return [=](const Invocation& invocation) {
                invocation.require_joined();
                GenerateSummary summary;
                {
                    Progress progress(invocation.log, "generate", options->frames, "frames");
                    summary = generate_corpus(
                        *options, *folder, invocation.resources().threads,
                        [&](int64_t frames) { progress.advance(frames); }, invocation.stop);
                }
                fmt::print(
                    "{}: {} frames in {} takes of {} subjects; {} labelled segments, "
                    "{} cycles\n",
                    folder->string(), summary.frames, summary.takes, summary.subjects,
                    summary.segments, summary.cycles);
                return ExitCode::success;
            };
        }};
}

}  // namespace kinetome::cli
