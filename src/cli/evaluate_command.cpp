#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "checks.h"
#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/report/timeline_svg.h"
#include "kinetome/stages/aligned_text.h"
#include "kinetome/stages/bundle_compression.h"
#include "kinetome/stages/evaluation.h"
#include "kinetome/stages/hierarchy_evaluation.h"
#include "kinetome/stages/label_rows.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/primitive_evaluation.h"
#include "kinetome/stages/stored_bundles.h"
#include "kinetome/stages/stored_evaluation.h"
#include "write_text.h"

namespace kinetome::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateFlags {
    fs::path store, truth, cycles, segments, primitives, pictures, output;
    std::string generation = "current", what = "segments", peer, format = "text";
    std::string clips, held_out = "all";
    std::shared_ptr<ReindexFlags> hierarchy;  ///< options of the pose hierarchy
    double rate = 120;
    EvaluationOptions evaluation;
};

void add_options(CLI::App& app, EvaluateFlags& flags) {
    app.add_option("STORE", flags.store, "store to read, unless tables are given");
    app.add_option("--truth", flags.truth,
                   "annotated activities: clip,first,end,label,end_lo,end_hi");
    app.add_option("--what", flags.what,
                   "segments, primitives, bundles (and what they compress to), bundle-segments (as "
                   "they cut takes), variance (inside clusters of primitives); recurrence (of "
                   "poses), estimation or compression (by a pose hierarchy), which need no "
                   "annotation")
        ->capture_default_str();
    app.add_option("--segments", flags.segments, "table as export segments writes it");
    app.add_option("--primitives", flags.primitives, "table as export primitives writes it");
    app.add_option("--cycles", flags.cycles, "annotated repetitions: clip,first,end,label");
    app.add_option("--peer", flags.peer,
                   "also score another method on the takes of STORE: ppca (Barbič et al. 2004)");
    app.add_option(
        "--clips", flags.clips,
        "takes whose pose hierarchy is evaluated: names, * and ? as in a shell, separated "
        "by commas");
    app.add_option("--held-out", flags.held_out,
                   "what an estimation is tested on: frames (a fifth, at random), blocks (of 4 s, "
                   "every 5th), takes (every 14th by name, or the last) or all")
        ->capture_default_str();
    flags.hierarchy = std::make_shared<ReindexFlags>(app, std::set<std::string>{"pose_hierarchy"});
    app.add_option("--rate", flags.rate, "frames a second of tables, where no STORE tells")
        ->check(above_zero())
        ->capture_default_str();
    app.add_option("--tolerance", flags.evaluation.boundary_tolerance,
                   "seconds by which a boundary may miss the zone where it is annotated")
        ->check(zero_or_above())
        ->capture_default_str();
    app.add_option("--svg", flags.pictures, "folder for a timeline of each annotated take");
    app.add_option("--format", flags.format, "text, csv or json")->capture_default_str();
    app.add_option("-o,--output", flags.output, "file to write (default: standard output)");
    app.add_option("--generation", flags.generation, "id, the beginning of one, or current");
}

bool is_about_hierarchy(const EvaluateFlags& flags) {
    return flags.what == "estimation" || flags.what == "compression";
}

void require(bool given, const std::string& advice) {
    if (!given) throw UsageError(advice);
}

bool is_one_of(const std::string& word, const std::set<std::string>& words) {
    return words.count(word) > 0;
}

/// What is given shall not be passed over.
void check_use(const EvaluateFlags& flags) {
    const auto of = [&](const char* option, bool given, const std::set<std::string>& whats) {
        require(!given || is_one_of(flags.what, whats),
                fmt::format("{} is of --what {}", option, fmt::join(whats, " or ")));
    };
    of("--clips", !flags.clips.empty(), {"compression", "estimation"});
    of("--held-out", flags.held_out != "all", {"estimation"});
    of("an option of the pose hierarchy", !flags.hierarchy->given().empty(),
       {"compression", "estimation"});
    of("--segments", !flags.segments.empty(), {"segments"});
    of("--primitives", !flags.primitives.empty(), {"primitives"});
    of("--cycles", !flags.cycles.empty(), {"primitives"});
    of("--svg", !flags.pictures.empty(), {"bundle-segments", "segments"});
    of("--peer", !flags.peer.empty(), {"bundle-segments", "segments"});
}

void check(const EvaluateFlags& flags) {
    require(is_one_of(flags.what, {"segments", "primitives", "bundles", "bundle-segments",
                                   "variance", "recurrence", "estimation", "compression"}),
            "--what " + flags.what +
                ": expected segments, primitives, bundles, bundle-segments, variance, recurrence, "
                "estimation or compression");
    require(is_one_of(flags.format, {"text", "csv", "json"}),
            "--format " + flags.format + ": expected text, csv or json");
    require(is_one_of(flags.peer, {"", "ppca"}), "--peer " + flags.peer + ": expected ppca");
    require(!flags.truth.empty() || flags.what == "recurrence" || is_about_hierarchy(flags),
            "give the annotation to compare with: --truth truth.csv");
    const bool has_table = (flags.what == "segments" && !flags.segments.empty()) ||
                           (flags.what == "primitives" && !flags.primitives.empty());
    require(!flags.store.empty() || has_table,
            is_one_of(flags.what, {"segments", "primitives"})
                ? fmt::format("give a STORE, or a table: --{0} {0}.csv", flags.what)
                : fmt::format("--what {}: give a STORE", flags.what));
    require(flags.peer.empty() || !flags.store.empty(),
            "--peer ppca needs the motion of the takes: give a STORE");
    check_use(flags);
}

/// What the flags name, read when it is asked for.
class EvaluationInput {
  public:
    explicit EvaluationInput(const EvaluateFlags& flags) : flags_(flags) {
        if (!flags.store.empty()) open_.emplace(flags.store, flags.generation);
    }

    const Generation& generation() const { return open_->generation; }

    std::vector<TruthRow> truth() const {
        auto rows = parse_truth_csv(read_source_file(flags_.truth), flags_.truth.string());
        if (rows.empty()) throw InputError::in_file(flags_.truth.string(), "no clip is annotated");
        return rows;
    }

    /// Where no timelines are made of it, which do not let a row fall by the way either.
    std::vector<TruthRow> truth_of_store() const {
        const std::vector<TruthRow> rows = truth();
        std::vector<CycleRow> spans;
        for (const TruthRow& row : rows) {
            spans.push_back({row.clip, row.first, row.end, row.label, row.line});
        }
        require_fitting_rows(spans, generation().catalog(), flags_.truth.string());
        return rows;
    }

    std::vector<CycleRow> cycles() const {
        if (flags_.cycles.empty()) return {};
        return parse_cycles_csv(read_source_file(flags_.cycles), flags_.cycles.string());
    }

    bool cut_by_bundles() const { return flags_.what == "bundle-segments"; }

    std::vector<SegmentedTake> segments() const {
        if (cut_by_bundles()) return stored_bundle_segments(generation());
        if (flags_.segments.empty()) return stored_segments(generation());
        auto takes = parse_segments_csv(read_source_file(flags_.segments), flags_.segments.string(),
                                        flags_.rate);
        if (open_) hold_to_store(takes, generation(), flags_.segments.string());
        return takes;
    }

    bool has_primitives() const {
        if (cut_by_bundles()) return false;
        return !flags_.primitives.empty() || (open_ && flags_.segments.empty());
    }
    std::vector<PrimitivesOfTake> primitives() const {
        if (flags_.primitives.empty()) return stored_primitives(generation());
        return parse_primitives_csv(read_source_file(flags_.primitives),
                                    flags_.primitives.string());
    }
    /// For messages.
    std::string primitives_path() const {
        return flags_.primitives.empty() ? (flags_.store / "current/primitives.h5").string()
                                         : flags_.primitives.string();
    }

    std::vector<AnnotatedTake> annotated() const {
        if (open_ || !flags_.segments.empty()) {
            return annotate(segments(), truth(), flags_.truth.string());
        }
        return annotated_alone(truth(), flags_.truth.string(), flags_.rate);
    }

  private:
    const EvaluateFlags& flags_;
    std::optional<OpenStore> open_;
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

/// Made if only it is missing; the folder that it lies in is there, as that of any other output.
void require_folder(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error) && !fs::create_directory(folder, error)) {
        throw create_error("create", folder, error ? error.value() : EEXIST);
    }
}

using SegmentsByClip = std::map<std::string, std::vector<Segment>>;

void draw(const std::vector<AnnotatedTake>& takes, const std::string& row_name,
          const std::vector<PrimitivesOfTake>& primitives, const SegmentsByClip& peer,
          const fs::path& folder) {
    std::map<std::string, std::vector<RowRange>> primitives_of;
    for (const PrimitivesOfTake& take : primitives) primitives_of[take.clip] = take.primitives;
    require_folder(folder);
    std::set<std::string> taken;
    for (const auto& [take, truth] : takes) {
        Timeline timeline{take.clip, truth.frames(), take.rate, {truth_row(truth)}, truth.classes};
        timeline.rows.push_back(
            segment_row(row_name, take.segments, primitives_of[take.clip], truth));
        if (!peer.empty()) {
            timeline.rows.push_back(segment_row("PPCA", peer.at(take.clip), {}, truth));
        }
        write_file_atomically(folder / picture_name(take.clip, taken), timeline_svg(timeline));
    }
}

std::string in_format(const Table& machine, const Table& human, const std::string& format) {
    if (format == "text") return aligned_text(human);
    return write_table(machine, parse_table_format(format));
}

std::string segments_report(const EvaluateFlags& flags, const EvaluationInput& input) {
    const std::vector<AnnotatedTake> takes = input.annotated();
    SegmentEvaluation evaluation = evaluate_segments(takes, flags.evaluation);
    SegmentsByClip peer;
    if (!flags.peer.empty()) {
        peer = segments_by_ppca(takes, input.generation());
        const auto of_peer = [&](const AnnotatedTake& take) { return peer.at(take.take.clip); };
        evaluation.beside.push_back({"PPCA", mean_score(takes, of_peer, flags.evaluation)});
    }
    if (!flags.pictures.empty()) {
        const auto primitives =
            input.has_primitives() ? input.primitives() : std::vector<PrimitivesOfTake>();
        draw(takes, input.cut_by_bundles() ? "bundles" : "segments", primitives, peer,
             flags.pictures);
    }
    return in_format(evaluation_table(evaluation), evaluation_summary(evaluation), flags.format);
}

Table hierarchy_table(const EvaluateFlags& flags, const Generation& generation,
                      const Workers& workers) {
    const ReindexOptions resolved = flags.hierarchy->resolve();
    const HierarchyEvaluationOptions options{resolved.principal_markers, resolved.pose_hierarchy};
    const auto takes = stored_markers(generation, flags.clips);
    if (flags.what == "compression") return compression_table(takes, options, workers);
    return estimation_table(takes, parse_held_out(flags.held_out), options, workers);
}

std::string report_on(const EvaluateFlags& flags, const EvaluationInput& input,
                      const Workers& workers) {
    if (is_one_of(flags.what, {"segments", "bundle-segments"}))
        return segments_report(flags, input);
    Table table;
    if (is_about_hierarchy(flags)) {
        table = hierarchy_table(flags, input.generation(), workers);
    } else if (flags.what == "bundles") {
        table = bundle_score_table(stored_bundle_score(input.generation(), input.truth_of_store()));
        append_compression(stored_bundle_compression(input.generation()), table);
    } else if (flags.what == "recurrence") {
        table = recurrence_table(stored_recurrence(input.generation()));
    } else if (flags.what == "primitives") {
        table = evaluation_table(evaluate_primitives(input.annotated(), input.primitives(),
                                                     input.primitives_path(), input.cycles(),
                                                     flags.cycles.string()));
    } else {
        std::vector<std::string> clips;
        for (const AnnotatedTake& take : input.annotated()) clips.push_back(take.take.clip);
        table = variance_table(stored_cluster_variances(input.generation(), clips));
    }
    return in_format(table, table, flags.format);
}

}  // namespace

Command evaluate_command() {
    return {"evaluate",
            "how good segments, primitives, bundles or the pose hierarchy are, by annotations or "
            "held-out takes",
            "kinetome evaluate motion.store --truth truth.csv --svg pictures",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<EvaluateFlags>();
                add_options(app, *flags);
                return [=](const Invocation& invocation) {
                    check(*flags);
                    const std::string text =
                        report_on(*flags, EvaluationInput(*flags), invocation.resources().threads);
                    write_text(flags->output, text);
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
