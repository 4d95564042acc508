#include "kinetome/synthesis/take_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace kinetome {
namespace {

constexpr int64_t shortest_take = 600;
constexpr int64_t longest_take = 7200;
constexpr double mean_excess = 978;  // over the shortest; with the cut at the longest: 1,570 in all

constexpr double subject_spread = 1.0;
constexpr double take_spread = 0.5;
constexpr double segment_spread = 0.6;
constexpr double cycle_spread = 0.7;

/// How often an activity is chosen, and how many cycles of it at a time.
struct Habit {
    double weight;
    int fewest_cycles, most_cycles;
};

Habit habit_of(Activity activity) {
    constexpr std::array<Habit, static_cast<size_t>(Activity::count)> habits = {{
        {4.0, 3, 10},  // walk
        {2.0, 4, 12},  // run
        {1.5, 2, 5},   // jump
        {1.2, 3, 8},   // punch_left
        {1.2, 3, 8},   // punch_right
        {0.8, 2, 5},   // kick_left
        {0.8, 2, 5},   // kick_right
        {1.0, 2, 5},   // squat
        {1.0, 3, 8},   // arm_circles
        {0.8, 4, 9},   // wave
        {1.0, 1, 2},   // sit
        {2.0, 1, 2},   // idle
    }};
    return habits[static_cast<size_t>(activity)];
}

Activity random_activity(RandomStream& random) {
    double total = 0;
    for (size_t i = 0; i < static_cast<size_t>(Activity::count); ++i)
        total += habit_of(static_cast<Activity>(i)).weight;
    double drawn = random.uniform(0, total);
    for (size_t i = 0; i < static_cast<size_t>(Activity::count); ++i) {
        const auto activity = static_cast<Activity>(i);
        drawn -= habit_of(activity).weight;
        if (drawn < 0) return activity;
    }
    return Activity::idle;
}

/// What one take is about: as in a recording session, a few activities that come again.
std::vector<Activity> random_repertoire(RandomStream& random) {
    const double kind = random.uniform();
    const size_t wanted = kind < 0.25 ? 1 : 2 + random.below(5);
    std::vector<Activity> repertoire;
    while (repertoire.size() < wanted) {
        const Activity activity = random_activity(random);
        if (std::ranges::find(repertoire, activity) == repertoire.end())
            repertoire.push_back(activity);
    }
    return repertoire;
}

double cycle_frames(Activity activity, const Traits& traits, RandomStream& random) {
    const double jitter = std::exp(0.03 * std::clamp(random.normal(), -2.5, 2.5));
    return usual_cycle_seconds(activity) / traits[Trait::tempo] * jitter * synthesis_rate;
}

/// Builds the segments of one take one after another.
class TakePlanner {
  public:
    TakePlanner(int64_t frames, const Style& style, RandomStream& random)
        : frames_(frames), style_(style), random_(random), repertoire_(random_repertoire(random)) {}

    std::vector<SegmentPlan> plan() {
        while (segments_.empty() || segments_.back().end < frames_) add_segment();
        SegmentPlan& last = segments_.back();
        last.blend_first = last.blend_end = last.end;
        return std::move(segments_);
    }

  private:
    /// One that is seen to differ from the last, if the take has more than one.
    size_t next_in_repertoire() {
        const size_t choice = random_.below(repertoire_.size());
        if (segments_.empty() || repertoire_[choice] != segments_.back().activity) return choice;
        return (choice + 1) % repertoire_.size();
    }

    void add_segment() {
        SegmentPlan segment;
        segment.activity = repertoire_[next_in_repertoire()];
        segment.first = segments_.empty() ? 0 : segments_.back().end;
        segment.mirrored = mirrored_;
        Style style = style_;
        style += random_style(segment_spread, random_);
        choose_form(segment.activity, style.traits, random_);
        segment.carriage = style.carriage;

        const Habit habit = habit_of(segment.activity);
        const auto choices = static_cast<uint64_t>(habit.most_cycles - habit.fewest_cycles + 1);
        auto cycles = habit.fewest_cycles + static_cast<int64_t>(random_.below(choices));
        if (repertoire_.size() == 1) cycles = frames_;
        double at = static_cast<double>(segment.first);
        for (int64_t i = 0; i < cycles && at < static_cast<double>(frames_); ++i)
            at = add_cycle(segment, style.traits, at);
        segment.end = std::llround(at);
        if (frames_ - segment.end < shortest_segment) segment.end = frames_;

        const double blend_seconds = random_.uniform(0.36, 0.6);
        const int64_t half = std::llround(blend_seconds * synthesis_rate / 2);
        segment.blend_first = segment.end - half;
        segment.blend_end = segment.end + half;
        // The cycles go on through the blend, and one further for the last to be shaped after.
        while (at <= static_cast<double>(segment.blend_end + 1))
            at = add_cycle(segment, style.traits, at);
        segments_.push_back(std::move(segment));
    }

    double add_cycle(SegmentPlan& segment, const Traits& traits, double at) {
        CyclePlan cycle;
        cycle.first = at;
        cycle.traits = combine(traits, random_cycle_traits(cycle_spread, random_));
        cycle.frames = cycle_frames(segment.activity, cycle.traits, random_);
        segment.cycles.push_back(cycle);
        return at + cycle.frames;
    }

    static constexpr int64_t shortest_segment = 150;

    int64_t frames_;
    Style style_;
    RandomStream& random_;
    std::vector<Activity> repertoire_;
    bool mirrored_ = random_.uniform() < 0.3;  ///< left-handed in this take
    std::vector<SegmentPlan> segments_;
};

}  // namespace

Activity SegmentPlan::label() const {
    if (!mirrored) return activity;
    switch (activity) {
        case Activity::punch_left:
            return Activity::punch_right;
        case Activity::punch_right:
            return Activity::punch_left;
        case Activity::kick_left:
            return Activity::kick_right;
        case Activity::kick_right:
            return Activity::kick_left;
        default:
            return activity;
    }
}

std::string TakePlan::subject_name() const {
    return fmt::format("{:02}", subject);
}
std::string TakePlan::name() const {
    return fmt::format("{:02}_{:02}", subject, number);
}

std::vector<int64_t> take_lengths(int64_t frames, uint64_t seed) {
    RandomStream random(seed, "take lengths");
    const double longest_excess = static_cast<double>(longest_take - shortest_take);
    const double kept = 1 - std::exp(-longest_excess / mean_excess);
    std::vector<int64_t> lengths;
    for (int64_t left = frames; left > 0;) {
        const double excess = -mean_excess * std::log(1 - kept * random.uniform());
        int64_t length = shortest_take + static_cast<int64_t>(excess);
        if (left - length < shortest_take) length = left <= longest_take ? left : left / 2;
        lengths.push_back(length);
        left -= length;
    }
    return lengths;
}

int64_t subject_count(int64_t takes, int64_t subjects) {
    const int64_t wanted = subjects > 0 ? subjects : (takes + 6) / 12;
    return std::clamp<int64_t>(wanted, 1, std::max<int64_t>(takes, 1));
}

int64_t subject_of_take(int64_t take, int64_t takes, int64_t subjects) {
    return take * subjects / takes + 1;
}

TakePlan plan_take(int64_t index, int64_t frames, int64_t subject, int64_t number, uint64_t seed) {
    RandomStream person(seed, "subject style", static_cast<uint64_t>(subject));
    RandomStream random(seed, "take plan", static_cast<uint64_t>(index));
    Style style = random_style(subject_spread, person);
    style += random_style(take_spread, random);
    TakePlan plan;
    plan.index = index;
    plan.subject = subject;
    plan.number = number;
    plan.frames = frames;
    plan.segments = TakePlanner(frames, style, random).plan();
    return plan;
}

}  // namespace kinetome
