#include "kinetome/stages/label_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

using Rows = std::vector<const CycleRow*>;

const CatalogClip* find_clip(const Catalog& catalog, const std::string& name) {
    const auto found = std::ranges::lower_bound(catalog.clips, name, {}, &CatalogClip::name);
    return found == catalog.clips.end() || found->name != name ? nullptr : &*found;
}

std::string why_not_indexed(const std::string& name, const CatalogClip* clip) {
    const std::string quoted = quote_for_message(name);
    if (clip) return fmt::format("clip {} is quarantined: {}", quoted, clip->quarantined);
    return fmt::format(
        "no clip {} is indexed; kinetome export STORE clips lists those that are: leave its rows "
        "out, or write its name as there",
        quoted);
}

void require_inside(const Rows& rows, const CatalogClip& clip, const std::string& path) {
    for (const CycleRow* const row : rows) {
        if (row->end <= clip.frames) continue;
        throw InputError::at_line(
            path, row->line,
            fmt::format("expected an end of at most {}, the frames of clip {}, found {}",
                        clip.frames, quote_for_message(clip.name), row->end));
    }
}

/// Of each label, the row so far that ends last is the one that another label may not meet.
void require_one_label_a_frame(Rows rows, const std::string& path) {
    std::ranges::stable_sort(rows, {}, &CycleRow::first);
    std::map<std::string, const CycleRow*> last_of;
    for (const CycleRow* const row : rows) {
        for (const auto& [label, last] : last_of) {
            if (label == row->label || last->end <= row->first) continue;
            const auto [earlier, later] = std::minmax(last->line, row->line);
            throw InputError::at_line(
                path, later,
                fmt::format("frames {} to {} of clip {} are {} here and {} in line {}: they can "
                            "have one label only",
                            row->first, std::min(row->end, last->end), quote_for_message(row->clip),
                            quote_for_message(later == row->line ? row->label : label),
                            quote_for_message(later == row->line ? label : row->label), earlier));
        }
        const CycleRow*& last = last_of[row->label];
        if (!last || last->end < row->end) last = row;
    }
}

}  // namespace

void require_fitting_rows(std::span<const CycleRow> rows, const Catalog& catalog,
                          const std::string& path, UnknownClips unknown) {
    std::map<std::string, Rows> rows_of;
    for (const CycleRow& row : rows) rows_of[row.clip].push_back(&row);
    for (const auto& [name, of_clip] : rows_of) {
        const CatalogClip* const clip = find_clip(catalog, name);
        if (!clip || !clip->indexed()) {
            if (unknown == UnknownClips::passed_over) continue;
            throw InputError::at_line(path, of_clip.front()->line, why_not_indexed(name, clip));
        }
        require_inside(of_clip, *clip, path);
        require_one_label_a_frame(of_clip, path);
    }
}

std::vector<CycleRow> read_label_rows(const std::filesystem::path& file, const Catalog& catalog,
                                      UnknownClips unknown) {
    std::vector<CycleRow> rows = parse_labels_csv(read_source_file(file), file.string());
    require_fitting_rows(rows, catalog, file.string(), unknown);
    return rows;
}

}  // namespace kinetome
