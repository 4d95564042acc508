#include "kinetome/stages/bundle_query.h"

#include <algorithm>

#include "kinetome/models/bundle_compression.h"
#include "kinetome/models/signature_match.h"
#include "kinetome/stages/node_blend.h"
#include "kinetome/stages/stored_bundles.h"

namespace kinetome {
namespace {

RowRange frames_of(const ClipPrimitive& member) {
    return {member.first, member.end};
}

double seconds_of(const ClipPrimitive& member, const ClipSource& source) {
    return static_cast<double>(frames_of(member).size()) / source.kind(member.clip).rate;
}

const ClipPrimitive& representative(const std::vector<ClipPrimitive>& members,
                                    const ClipSource& source) {
    std::vector<double> seconds;
    for (const ClipPrimitive& member : members) seconds.push_back(seconds_of(member, source));
    return members[representative_of(seconds)];
}

/// Of query_table.
struct AnswerPlace {
    std::string clip;
    RowRange frames;

    explicit AnswerPlace(const std::vector<Table::Cell>& row)
        : clip(std::get<std::string>(row.at(1))),
          frames{std::get<int64_t>(row.at(2)), std::get<int64_t>(row.at(3))} {}
};

bool is_member(const AnswerPlace& answer, const std::vector<ClipPrimitive>& members,
               double overlap) {
    return std::ranges::any_of(members, [&](const ClipPrimitive& member) {
        return member.clip == answer.clip &&
               is_same_place(frames_of(member), answer.frames, overlap);
    });
}

void keep_first(int64_t count, Table& table) {
    table.rows.resize(std::min(table.rows.size(), static_cast<size_t>(count)));
    for (size_t i = 0; i < table.rows.size(); ++i) table.rows[i][0] = static_cast<int64_t>(i) + 1;
}

}  // namespace

Table bundle_query_table(const OpenStore& open, const std::string& bundle,
                         const std::filesystem::path& labels, SignatureQuery query, int threads) {
    const std::vector<ClipPrimitive> members = motions_of_node(
        stored_bundle_members(open, labels), bundle, options_of_bundle_walk({}).style, "--bundle");
    const ClipPrimitive& asked = representative(members, clip_source(open.generation));
    query.clip = asked.clip;
    query.file.clear();
    query.frames = frames_of(asked);
    const int64_t wanted = query.answers;
    // Members are among the nearest; how many answers they take is seen when they are there.
    for (query.answers += static_cast<int64_t>(members.size());; query.answers *= 2) {
        Table table = query_table(open.generation, query, threads);
        const auto found = static_cast<int64_t>(table.rows.size());
        std::erase_if(table.rows, [&](const auto& row) {
            return is_member(AnswerPlace(row), members, query.search.match.overlap);
        });
        if (static_cast<int64_t>(table.rows.size()) < wanted && found == query.answers) continue;
        keep_first(wanted, table);
        return table;
    }
}

}  // namespace kinetome
