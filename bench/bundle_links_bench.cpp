// Are bundles of different bodies linked where they hold the same activity, and nowhere else?
//
//   bundle_links_bench [--frames N] [--subjects N] [--seeds N...] [--reach R] [--candidates N]
//       [--company S] [--threads N]
//       Generated corpora, one a seed.
//   bundle_links_bench CORPUS TRUTH [--reach R] ...
//       CORPUS: a folder with NN/NN.asf and NN/NN_*.amc
//       TRUTH: CSV of its annotated activities (clip,first,end,label,end_lo,end_hi)
//
// A bundle has a label when it fills 0.9 of its frames; it counts when another subject has a bundle
// of that label. A link that joins different labels is in a blend when one label fills as much of
// both bundles, frames between two activities being of either. Performances of one label may be of
// forms that share no movement, such as hooks and straight punches: those that count by form are
// bundles of which another subject has the form, too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "activity_blends.h"
#include "activity_form.h"
#include "cost.h"
#include "generated_corpus.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/models/bundle_link_rows.h"
#include "kinetome/models/bundle_links.h"
#include "kinetome/models/motion_bundle.h"
#include "kinetome/models/truth_timeline.h"
#include "program.h"
#include "spelled_takes.h"

namespace {

using namespace kinetome;

namespace fs = std::filesystem;

struct Options {
    fs::path corpus, truth;
    int64_t frames = 160'000, subjects = 4;
    std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
    int threads = 2;
    BundleLinkOptions links;
};

constexpr double labelled_share = 0.9;
constexpr auto row_frames = static_cast<int64_t>(bench::pose_rate / bundle_link_rate);

/// Bundles of all subjects, each found among the takes of its own.
struct SubjectBundles {
    MatrixF rows;
    std::vector<RowRange> clips;
    std::vector<int32_t> subject_of_clip;
    std::vector<BundleMember> members;  ///< in rows
    std::vector<int32_t> subject_of, label_of, form_of;
    std::vector<std::set<int32_t>> labels_with_blends;  ///< frames of a blend being of both
    std::vector<std::string> labels;                    ///< by number
};

/// Of one take each, by frame.
struct Truth {
    std::vector<FrameClasses> labels, blends, forms;
};

/// Labels that fill enough of a bundle, a frame being of all `by_frame` say.
std::set<int32_t> labels_of(const MotionString& string, const SubstringBundle& bundle,
                            std::initializer_list<std::span<const FrameClasses>> by_frame) {
    std::map<int32_t, int64_t> counts;
    int64_t frames = 0;
    for (const Substring& member : bundle.members) {
        const auto clip = static_cast<size_t>(string.clip[static_cast<size_t>(member.first)]);
        const auto end = std::lround(string.mean_frame(member.last));
        for (auto frame = std::lround(string.mean_frame(member.first)); frame < end; ++frame) {
            for (const auto& classes : by_frame)
                ++counts[classes[clip][static_cast<size_t>(frame)]];
            ++frames;
        }
    }
    std::set<int32_t> labels;
    for (const auto& [label, count] : counts) {
        if (label != no_class && double(count) >= labelled_share * double(frames))
            labels.insert(label);
    }
    return labels;
}

int32_t label_of(const MotionString& string, const SubstringBundle& bundle,
                 std::span<const FrameClasses> classes) {
    const std::set<int32_t> labels = labels_of(string, bundle, {classes});
    return labels.empty() ? no_class : *labels.begin();
}

/// Bundles of takes of one subject.
void add_subject(const std::vector<Clip>& clips, const Truth& truth, int32_t subject, int threads,
                 SubjectBundles& all) {
    const size_t before = all.clips.size();
    const std::vector<std::string> names(clips.size());
    const bench::SpelledTakes takes(bench::PoseTakes::of_clips(names, clips), {}, threads);
    const MotionString& string = takes.string;
    for (const Clip& clip : clips) {
        const MatrixF points = bundle_link_rows(clip);
        const int64_t first = all.rows.rows();
        all.rows.conservativeResize(first + points.rows(), points.cols());
        all.rows.bottomRows(points.rows()) = points;
        all.clips.push_back({first, first + points.rows()});
        all.subject_of_clip.push_back(subject);
    }
    const auto bundles =
        find_motion_bundles(string, accessibility(takes.mixture, takes.tau, threads), takes.lambda,
                            {}, {.threads = threads});
    for (const SubstringBundle& bundle : bundles) {
        if (bundle.is_degenerate()) break;
        const auto number = static_cast<int32_t>(all.subject_of.size());
        for (const Substring& member : bundle.members) {
            const auto clip = int32_t(before) + string.clip[static_cast<size_t>(member.first)];
            const auto row = [&](int32_t letter) {
                return std::lround(string.mean_frame(letter)) / row_frames;
            };
            const int64_t rows = all.clips[static_cast<size_t>(clip)].size();
            const int64_t first = std::min(row(member.first), rows - 1);
            all.members.push_back(
                {number, {clip, first, std::clamp(row(member.last) + 1, first + 1, rows)}});
        }
        all.subject_of.push_back(subject);
        all.label_of.push_back(label_of(string, bundle, truth.labels));
        all.labels_with_blends.push_back(labels_of(string, bundle, {truth.labels, truth.blends}));
        all.form_of.push_back(label_of(string, bundle, truth.forms));
    }
}

/// Labels with the form that each segment of the take has.
FrameClasses forms_of(const TakePlan& plan, std::map<std::string, int32_t>& numbers) {
    FrameClasses classes(size_t(plan.frames), no_class);
    for (const SegmentPlan& segment : plan.segments) {
        const auto number = numbers.emplace(bench::motion_of(segment), int32_t(numbers.size()));
        std::fill(classes.begin() + segment.first, classes.begin() + segment.end,
                  number.first->second);
    }
    return classes;
}

SubjectBundles of_generated(const Options& options, uint64_t seed) {
    const bench::GeneratedCorpus corpus(options.frames, options.subjects, seed, options.threads);
    SubjectBundles all;
    all.labels = corpus.labels;
    std::map<std::string, int32_t> forms;
    for (size_t begin = 0, end = 0; begin < corpus.plans.size(); begin = end) {
        Truth truth;
        while (end < corpus.plans.size() &&
               corpus.plans[end].subject == corpus.plans[begin].subject) {
            truth.labels.push_back(corpus.classes[end]);
            truth.blends.push_back(corpus.blends[end]);
            truth.forms.push_back(forms_of(corpus.plans[end], forms));
            ++end;
        }
        add_subject({corpus.clips.begin() + std::ptrdiff_t(begin),
                     corpus.clips.begin() + std::ptrdiff_t(end)},
                    truth, int32_t(corpus.plans[begin].subject), options.threads, all);
    }
    return all;
}

/// Those of one more take; an annotation counts at the pose rate.
void add_labels(const TruthTimeline& timeline, int64_t frames,
                std::map<std::string, int32_t>& numbers, Truth& truth) {
    for (const std::string& label : timeline.classes)
        numbers.emplace(label, int32_t(numbers.size()));
    auto& classes = truth.labels.emplace_back(size_t(frames), no_class);
    for (const TrueActivity& activity : timeline.activities) {
        std::fill(classes.begin() + activity.frames.first, classes.begin() + activity.frames.end,
                  numbers.at(timeline.classes[size_t(activity.label)]));
    }
    truth.blends.push_back(bench::blended_with(timeline, frames, numbers));
}

/// Subjects are the folders.
SubjectBundles of_takes(const Options& options) {
    std::map<std::string, std::vector<TruthRow>> rows_of;
    for (const TruthRow& row :
         parse_truth_csv(read_source_file(options.truth), options.truth.string()))
        rows_of[row.clip].push_back(row);
    std::map<std::string, std::vector<fs::path>> subjects;
    for (const fs::path& file : bench::amc_files(options.corpus))
        subjects[file.parent_path().filename().string()].push_back(file);
    SubjectBundles all;
    std::map<std::string, int32_t> numbers;
    int32_t subject = 0;
    for (auto& [name, files] : subjects) {
        std::ranges::sort(files);
        std::vector<Clip> clips;
        Truth truth;
        for (const fs::path& file : files) {
            clips.push_back(resample(bench::read_take(file), bench::pose_rate));
            const int64_t frames = clips.back().frames();
            add_labels(truth_timeline(rows_of[file.stem().string()], frames, bench::pose_rate,
                                      options.truth.string()),
                       frames, numbers, truth);
        }
        truth.forms = truth.labels;
        add_subject(clips, truth, subject++, options.threads, all);
    }
    all.labels.resize(numbers.size());
    for (const auto& [label, number] : numbers) all.labels[size_t(number)] = label;
    return all;
}

/// How many bundles are of a class that another subject has, and how many of those are linked with
/// one of their label.
struct Linked {
    int64_t counted = 0, linked = 0;
    double share() const { return counted ? double(linked) / double(counted) : 0; }
    Linked& operator+=(const Linked& more) {
        counted += more.counted;
        linked += more.linked;
        return *this;
    }
};

Linked count_linked(const SubjectBundles& all, const std::vector<int32_t>& classes,
                    const std::set<int32_t>& linked) {
    std::map<int32_t, std::set<int32_t>> subjects_with;
    for (size_t b = 0; b < classes.size(); ++b) subjects_with[classes[b]].insert(all.subject_of[b]);
    Linked count;
    for (size_t b = 0; b < classes.size(); ++b) {
        if (classes[b] == no_class || subjects_with[classes[b]].size() < 2) continue;
        ++count.counted;
        count.linked += int64_t(linked.count(int32_t(b)));
    }
    return count;
}

using LabelPairs = std::map<std::pair<std::string, std::string>, int64_t>;

/// Of one corpus.
struct Judgement {
    double usual_cost = 0, cpu = 0;
    int64_t bundles = 0, links = 0;
    int64_t labelled = 0;  ///< links between bundles with labels
    Linked by_label, by_form;
    LabelPairs different;   ///< links between labels
    int64_t in_blends = 0;  ///< of those

    int64_t wrong() const {
        int64_t count = 0;
        for (const auto& [labels, of_pair] : different) count += of_pair;
        return count;
    }
};

bool share_label(const SubjectBundles& all, const BundleLink& link) {
    const auto& there = all.labels_with_blends[size_t(link.second)];
    return std::ranges::any_of(all.labels_with_blends[size_t(link.first)],
                               [&](int32_t label) { return there.contains(label); });
}

Judgement judge(const Options& options, const SubjectBundles& all) {
    BundleLinks links;
    const bench::Cost cost = bench::cost_of([&] {
        links = link_bundles(all.rows, all.clips, all.members, all.subject_of_clip, options.links,
                             options.threads);
    });
    Judgement judgement;
    std::set<int32_t> linked;
    for (const BundleLink& link : links.links) {
        const int32_t a = all.label_of[size_t(link.first)], b = all.label_of[size_t(link.second)];
        if (a == no_class || b == no_class) continue;
        ++judgement.labelled;
        if (a == b) {
            linked.insert({link.first, link.second});
            continue;
        }
        ++judgement.different[std::minmax(all.labels[size_t(a)], all.labels[size_t(b)])];
        judgement.in_blends += share_label(all, link);
    }
    judgement.usual_cost = links.usual_cost;
    judgement.cpu = cost.cpu;
    judgement.bundles = int64_t(all.subject_of.size());
    judgement.links = int64_t(links.links.size());
    judgement.by_label = count_linked(all, all.label_of, linked);
    judgement.by_form = count_linked(all, all.form_of, linked);
    return judgement;
}

void print(const LabelPairs& different) {
    for (const auto& [labels, count] : different)
        fmt::print("     {} of {} and {}\n", count, labels.first, labels.second);
}

void print(const std::string& name, const Judgement& judgement) {
    fmt::print(
        "{:>4} {:>7} {:>7} {:>10.3f} {:>6} {:>8} {:>7.3f} {:>7} {:>7.3f} {:>9} {:>6} {:>7.1f}\n",
        name, judgement.bundles, judgement.by_label.counted, judgement.usual_cost, judgement.links,
        judgement.labelled, judgement.by_label.share(), judgement.by_form.counted,
        judgement.by_form.share(), judgement.wrong(), judgement.in_blends, judgement.cpu);
    print(judgement.different);
    std::fflush(stdout);
}

/// Links should reach nine of ten bundles, and join no different labels.
void print_all(const std::vector<Judgement>& corpora) {
    constexpr double asked = 0.9;
    Linked by_label, by_form;
    int64_t labelled = 0, wrong = 0, in_blends = 0;
    LabelPairs different;
    double least = 1;
    for (const Judgement& one : corpora) {
        by_label += one.by_label;
        by_form += one.by_form;
        labelled += one.labelled;
        wrong += one.wrong();
        in_blends += one.in_blends;
        for (const auto& [labels, count] : one.different) different[labels] += count;
        least = std::min(least, one.by_label.share());
    }
    const auto count = [&](const auto& is) { return std::ranges::count_if(corpora, is); };
    const auto is_linked = [](const Judgement& one) { return one.by_label.share() >= asked; };
    const auto has_none = [](const Judgement& one) { return one.wrong() == 0; };
    const auto has_none_but_in_blends = [](const Judgement& one) {
        return one.wrong() == one.in_blends;
    };
    fmt::print(
        "all {} corpora: {:.3f} of {} bundles linked (least {:.3f}), by form {:.3f} of {}\n"
        "{} of {} links join different labels, {} of them in blends\n"
        "nine of ten linked in {}; no different labels in {}, none outside blends in {}\n",
        corpora.size(), by_label.share(), by_label.counted, least, by_form.share(), by_form.counted,
        wrong, labelled, in_blends, count(is_linked), count(has_none),
        count(has_none_but_in_blends));
    print(different);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    bench::Program program(
        "Which bundles of different bodies are linked, and which should not be?");
    using enum bench::Program::Need;
    program.argument("CORPUS", options.corpus, "folder of takes", optional);
    program.argument("TRUTH", options.truth, "their activities", optional);
    program.count("--frames", options.frames, "of each corpus");
    program.count("--subjects", options.subjects, "of each corpus");
    program.option("--seeds", options.seeds, "of the corpora");
    program.option("--reach", options.links.reach, "times the usual cost");
    program.count("--candidates", options.links.candidates, "of each body, for a bundle");
    program.option("--company", options.links.company, "share of what agrees with both");
    program.count("--threads", options.threads);
    return program.run(argc, argv, [&] {
        fmt::print(
            "seed bundles counted usual cost  links labelled  linked by form  linked different "
            "blends   cpu s\n");
        if (!options.corpus.empty()) {
            print("-", judge(options, of_takes(options)));
            return true;
        }
        std::vector<Judgement> corpora;
        for (const uint64_t seed : options.seeds) {
            corpora.push_back(judge(options, of_generated(options, seed)));
            print(std::to_string(seed), corpora.back());
        }
        print_all(corpora);
        return true;
    });
}
