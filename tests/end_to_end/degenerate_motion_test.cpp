// Takes that hardly are motions: a frame, a pose that is held, fewer frames than a leaf has
// dimensions, limbs that never move. The piecewise-linear model, what it estimates, compresses and
// finds are numbers, or a refusal that helps.
#include <regex>

#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

constexpr int usage = 64, bad_input = 65, some_quarantined = 3;

const std::vector<std::string> model_stages{"--only", "frames,features,pose_hierarchy,signatures"};

struct TakeText {
    std::string header;
    std::vector<std::vector<std::string>> frames;  ///< lines, without the frame's number
};

TakeText parsed(const std::string& amc) {
    TakeText take;
    for (const std::string& line : lines_of(amc)) {
        if (std::regex_match(line, std::regex("[0-9]+"))) {
            take.frames.emplace_back();
        } else if (take.frames.empty()) {
            take.header += line + "\n";
        } else {
            take.frames.back().push_back(line);
        }
    }
    return take;
}

std::string text_of(const TakeText& take) {
    std::string text = take.header;
    for (size_t i = 0; i < take.frames.size(); ++i) {
        text += std::to_string(i + 1) + "\n" + joined(take.frames[i]);
    }
    return text;
}

/// The take with all bones but those of the right arm as in its first frame.
TakeText with_one_moving_arm(TakeText take) {
    for (auto& frame : take.frames) {
        for (size_t bone = 0; bone < frame.size(); ++bone) {
            const bool moves = frame[bone].starts_with("rhumerus") ||
                               frame[bone].starts_with("rradius") ||
                               frame[bone].starts_with("rwrist");
            if (!moves) frame[bone] = take.frames.front()[bone];
        }
    }
    return take;
}

/// All that is there is a number.
void require_numbers(const std::string& text) {
    INFO(text.substr(0, 2000));
    CHECK_FALSE(std::regex_search(text, std::regex("(^|[^a-z_])(nan|inf)([^a-z]|$)")));
}

/// A store of takes of one performer, 01_01 and on.
class DegenerateStore {
  public:
    explicit DegenerateStore(const std::vector<TakeText>& takes, int expected = 0) {
        corpus_.add_skeleton("01/01.asf");
        for (size_t i = 0; i < takes.size(); ++i) {
            corpus_.add("01/01_0" + std::to_string(i + 1) + ".amc", text_of(takes[i]));
        }
        indexed_ = require_program(reindex(corpus_.path(), store(), model_stages), expected);
    }

    std::string store() const { return corpus_.store().string(); }
    std::string take(const std::string& clip) const {
        return (corpus_.path() / "01" / (clip + ".amc")).string();
    }
    std::string file(const std::string& name) const { return (corpus_.folder() / name).string(); }
    const CommandResult& indexed() const { return indexed_; }

    CommandResult command(const std::string& name, std::vector<std::string> more,
                          int expected = 0) const {
        more.insert(more.begin(), {name, store()});
        CommandResult result = require_program(more, expected);
        require_numbers(result.output);
        return result;
    }

    /// Every use of the model that needs no more than one take.
    void use_with(const std::string& clip) const {
        CHECK(lines_of(command("export", {"hierarchy"}).output).size() > 1);
        CHECK(lines_of(command("export", {"signatures"}).output).size() > 1);
        for (const std::string rule : {"rms", "max"}) {
            command("evaluate", {"--what", "compression", "--leaf-rule", rule});
        }
        command("estimate", {"--file", take(clip), "-o", file("e.bvh"), "--meter", file("m.csv")});
        command("compress", {"--clip", clip, "-o", file("c.motion")});
        require_program({"decompress", file("c.motion"), "-o", file("c.bvh")});
        for (const std::string written : {"e.bvh", "m.csv", "c.bvh"}) {
            require_numbers(::text_of(file(written)));
        }
        for (const std::string rule : {"pace", "repeats", "edit"}) {
            const auto found =
                lines_of(command("query", {"--clip", clip, "--match-rule", rule}).output);
            REQUIRE(found.size() > 1);
            CHECK(std::stod(found[1].substr(found[1].rfind(',') + 1)) < 3);  // mm: it is there
        }
        command("query", {"--file", take(clip), "--rerank"});
        command("query", {"--clip", clip, "--frames", "0:1", "--match-tolerance", "0"});
    }

  private:
    SmallCorpus corpus_;
    CommandResult indexed_;
};

const TakeText& some_motion() {
    static const TakeText take = parsed(make_performer().amc);
    return take;
}

TakeText frames_of(const TakeText& take, size_t count) {
    return {take.header, {take.frames.begin(), take.frames.begin() + long(count)}};
}

TakeText held_pose(size_t count) {
    return {some_motion().header, {count, some_motion().frames.front()}};
}

}  // namespace

TEST_CASE("hardly a motion makes a model of numbers all the same", "[degenerate]") {
    const std::map<std::string, TakeText> takes{
        {"one frame", frames_of(some_motion(), 1)},
        {"fewer frames than dimensions", frames_of(some_motion(), 3)},
        {"one pose, held", held_pose(150)},
        {"one arm moves", with_one_moving_arm(some_motion())},
    };
    for (const auto& [what, take] : takes) {
        INFO(what);
        const DegenerateStore store({take});
        store.use_with("01_01");
        CHECK(contains(
            store.command("evaluate", {"--what", "estimation", "--held-out", "takes"}, usage)
                .errors,
            "too few to hold out takes"));
    }
}

TEST_CASE("takes that hardly move are found and estimated among others", "[degenerate]") {
    const DegenerateStore store(
        {frames_of(some_motion(), 1), frames_of(some_motion(), 3), held_pose(150), some_motion()});
    for (const std::string clip : {"01_01", "01_02", "01_03", "01_04"}) store.use_with(clip);
    for (const std::string way : {"frames", "takes"}) {
        store.command("evaluate", {"--what", "estimation", "--held-out", way});
    }
}

TEST_CASE("an error that nothing can be compared with has no ratio", "[degenerate]") {
    const DegenerateStore store({held_pose(250)});
    const auto rows = lines_of(store
                                   .command("evaluate", {"--what", "estimation", "--held-out",
                                                         "frames", "--format", "csv"})
                                   .output);
    REQUIRE(rows.size() > 2);
    CHECK(rows[1].ends_with(",global linear,0,0,0,,"));
}

TEST_CASE("a take with a missing marker is refused by whoever reads it", "[degenerate]") {
    TakeText no_number = some_motion(), no_bone = some_motion();
    std::string& bone = no_number.frames[70].back();
    bone = bone.substr(0, bone.find(' ')) + " nan";
    for (auto& frame : no_bone.frames) frame.pop_back();
    const DegenerateStore store({no_number, no_bone, some_motion()}, some_quarantined);
    CHECK(contains(store.indexed().output, "1 indexed (1 new"));
    CHECK(contains(store.indexed().output, "2 quarantined"));
    store.use_with("01_03");
    const std::map<std::string, std::string> reasons{
        {"01_01", "expected a finite number, found 'nan'"}, {"01_02", "expected bone '"}};
    for (const auto& [clip, reason] : reasons) {
        for (const std::string command : {"estimate", "query"}) {
            const auto refused =
                store.command(command, {"--file", store.take(clip)}, bad_input).errors;
            CHECK(contains(refused, clip + ".amc:"));
            CHECK(contains(refused, reason));
        }
        CHECK(contains(store.command("query", {"--clip", clip}, usage).errors, "no clip"));
        store.command("compress", {"--clip", clip, "-o", store.file("x.motion")}, usage);
    }
}
