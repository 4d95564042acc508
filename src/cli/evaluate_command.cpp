#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/report/timeline_svg.h"
#include "kinetome/stages/aligned_text.h"
#include "kinetome/stages/evaluation.h"
#include "kinetome/stages/primitive_evaluation.h"

namespace kinetome::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateFlags {
    fs::path truth, cycles, segments, primitives, pictures, output;
    std::string what = "segments", format = "text";
    double rate = 120;
    EvaluationOptions evaluation;
};

/// A name for a clip's picture that is no path and no other clip's.
std::string picture_name(const std::string& clip, std::set<std::string>& taken) {
    std::string name = clip;
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '-'; }, '_');
    std::string free = name;
    for (int i = 2; !taken.insert(free).second; ++i) free = fmt::format("{}_{}", name, i);
    return free + ".svg";
}

void draw(const std::vector<AnnotatedTake>& takes, const std::vector<PrimitivesOfTake>& primitives,
          const fs::path& folder) {
    std::map<std::string, std::vector<RowRange>> primitives_of;
    for (const PrimitivesOfTake& take : primitives) primitives_of[take.clip] = take.primitives;
    fs::create_directories(folder);
    std::set<std::string> taken;
    for (const AnnotatedTake& one : takes) {
        const Timeline timeline = {
            one.take.clip,
            one.truth.frames(),
            one.take.rate,
            {truth_row(one.truth),
             segment_row("segments", one.take.segments, primitives_of[one.take.clip], one.truth)}};
        write_file_atomically(folder / picture_name(one.take.clip, taken), timeline_svg(timeline));
    }
}

std::vector<PrimitivesOfTake> read_primitives(const EvaluateFlags& flags) {
    if (flags.primitives.empty()) return {};
    return parse_primitives_csv(read_source_file(flags.primitives), flags.primitives.string());
}

std::vector<TruthRow> read_truth(const fs::path& path) {
    auto rows = parse_truth_csv(read_source_file(path), path.string());
    if (rows.empty()) throw InputError::in_file(path.string(), "no clip is annotated");
    return rows;
}

std::string segments_report(const EvaluateFlags& flags) {
    const auto takes =
        parse_segments_csv(read_source_file(flags.segments), flags.segments.string(), flags.rate);
    const auto annotated = annotate(takes, read_truth(flags.truth), flags.truth.string());
    const SegmentEvaluation evaluation = evaluate_segments(annotated, flags.evaluation);
    if (!flags.pictures.empty()) draw(annotated, read_primitives(flags), flags.pictures);
    if (flags.format == "text") return aligned_text(evaluation_summary(evaluation));
    return write_table(evaluation_table(evaluation), parse_table_format(flags.format));
}

std::string primitives_report(const EvaluateFlags& flags) {
    const auto annotated =
        annotated_alone(read_truth(flags.truth), flags.truth.string(), flags.rate);
    std::vector<CycleRow> cycles;
    if (!flags.cycles.empty()) {
        cycles = parse_cycles_csv(read_source_file(flags.cycles), flags.cycles.string());
    }
    const PrimitiveEvaluation evaluation =
        evaluate_primitives(annotated, read_primitives(flags), flags.primitives.string(), cycles,
                            flags.cycles.string());
    if (flags.format == "text") return aligned_text(evaluation_table(evaluation));
    return write_table(evaluation_table(evaluation), parse_table_format(flags.format));
}

void check(const EvaluateFlags& flags) {
    if (flags.what != "segments" && flags.what != "primitives") {
        throw UsageError("--what " + flags.what + ": expected segments or primitives");
    }
    if (flags.format != "text" && flags.format != "csv" && flags.format != "json") {
        throw UsageError("--format " + flags.format + ": expected text, csv or json");
    }
    if (flags.what == "segments" && flags.segments.empty()) {
        throw UsageError("give the segments to evaluate: --segments segments.csv");
    }
    if (flags.what == "primitives" && flags.primitives.empty()) {
        throw UsageError("give the primitives to evaluate: --primitives primitives.csv");
    }
}

void add_options(CLI::App& app, EvaluateFlags& flags) {
    app.add_option("--truth", flags.truth,
                   "annotated activities: clip,first,end,label,end_lo,end_hi")
        ->required();
    app.add_option("--what", flags.what, "segments or primitives")->capture_default_str();
    app.add_option("--segments", flags.segments, "table as `export segments` writes it");
    app.add_option("--primitives", flags.primitives, "table as `export primitives` writes it");
    app.add_option("--cycles", flags.cycles, "annotated repetitions: clip,first,end,label");
    app.add_option("--rate", flags.rate, "frames a second of tables and annotation")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--tolerance", flags.evaluation.boundary_tolerance,
                   "seconds by which a boundary may miss the zone where it is annotated")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--svg", flags.pictures, "folder for a timeline of each take");
    app.add_option("--format", flags.format, "text, csv or json")->capture_default_str();
    app.add_option("-o,--output", flags.output, "file to write (default: standard output)");
}

}  // namespace

Command evaluate_command() {
    return {"evaluate", "compare segments or primitives with annotations",
            "kinetome evaluate --segments segments.csv --truth truth.csv --svg pictures",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<EvaluateFlags>();
                add_options(app, *flags);
                return [=](const Invocation&) {
                    check(*flags);
                    const std::string text = flags->what == "segments" ? segments_report(*flags)
                                                                       : primitives_report(*flags);
                    if (!flags->output.empty()) {
                        write_file_atomically(flags->output, text);
                    } else {
                        std::fwrite(text.data(), 1, text.size(), stdout);
                    }
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
