#include <fmt/format.h>

#include <memory>

#include "checks.h"
#include "command.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/resample.h"
#include "kinetome/formats/write_bvh.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/take_estimate.h"
#include "kinetome/stages/take_file.h"

namespace kinetome::cli {
namespace {

namespace fs = std::filesystem;

struct EstimateFlags {
    fs::path store, file, output, meter;
    std::string generation = "current";
    TakeFileOptions take;
    double blend_band = default_blend_band;
};

void add_options(CLI::App& app, EstimateFlags& flags) {
    app.add_option("STORE", flags.store, "store whose pose hierarchy is used")->required();
    app.add_option("--file", flags.file, "take whose principal markers are taken as known")
        ->required();
    app.add_option("-o,--output", flags.output, "BVH file for the motion that they tell");
    app.add_option("--meter", flags.meter,
                   "CSV file for the error of each frame and where the leaf changes");
    app.add_option("--blend-band", flags.blend_band,
                   "half gaps from a plane in which the maps of both sides are blended; 0: none")
        ->check(zero_or_above())
        ->capture_default_str();
    app.add_option("--amc-rate", flags.take.rate, "frames a second of an AMC take")
        ->check(above_zero())
        ->capture_default_str();
    app.add_option("--joint-map", flags.take.joint_map,
                   "TOML file: which joint has which role, for rigs with unknown names");
    app.add_option("--generation", flags.generation, "id, the beginning of one, or current");
}

void print_estimate(const TakeEstimate& estimate, const ClassHierarchy& model) {
    std::vector<std::string> known;
    for (const int32_t marker : model.principal.markers) {
        known.push_back(model.marker_names[static_cast<size_t>(marker)]);
    }
    int64_t changes = 0;
    for (size_t i = 1; i < estimate.leaves.size(); ++i) {
        changes += estimate.leaves[i] != estimate.leaves[i - 1];
    }
    fmt::print("principal     {}\n", fmt::join(known, " "));
    fmt::print("motion        {} frames at {:g} a second, {} changes of leaf\n",
               estimate.errors.size(), estimate.take.rate, changes);
    fmt::print("rms_mm {:.2f}\n", estimate.rms);
}

/// Of those that were asked for all or none; the motion at the rate of the take.
void write_results(const EstimateFlags& flags, const TakeEstimate& estimate, double rate) {
    std::string motion, meter;
    std::vector<FileText> files;
    if (!flags.output.empty()) {
        motion = write_bvh(resample(estimated_motion(estimate), rate));
        files.push_back({flags.output, motion});
    }
    if (!flags.meter.empty()) {
        meter = write_table(meter_table(estimate), TableFormat::csv);
        files.push_back({flags.meter, meter});
    }
    write_files_atomically(files);
}

}  // namespace

Command estimate_command() {
    return {"estimate", "the whole body of a take from its principal markers",
            "kinetome estimate motion.store --file new/35_01.amc -o estimated.bvh",
            [](CLI::App& app) -> Run {
                auto flags = std::make_shared<EstimateFlags>();
                add_options(app, *flags);
                return [=](const Invocation&) {
                    if (!flags->output.empty() && flags->output.extension() != ".bvh") {
                        throw UsageError(fmt::format("-o {}: expected a name that ends in .bvh",
                                                     path_for_message(flags->output.string())));
                    }
                    const OpenStore open(flags->store, flags->generation);
                    const Clip take = read_take_file(flags->file, flags->take);
                    const ClassHierarchy model = model_for(open.generation, take);
                    const TakeEstimate estimate = estimate_take(model, take, flags->blend_band);
                    write_results(*flags, estimate, take.rate);
                    print_estimate(estimate, model);
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
