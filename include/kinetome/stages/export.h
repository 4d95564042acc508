// Tables that users take out of a store (design §7, CSV contracts).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinetome/base/file_writer.h"
#include "kinetome/stages/open_store.h"

namespace kinetome {

/// A table of texts, whole numbers and numbers.
struct Table {
    using Cell = std::variant<std::string, int64_t, double>;
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;
};

enum class TableFormat { csv, json };

/// Throws UsageError for another name.
TableFormat parse_table_format(std::string_view name);

/// CSV by RFC 4180, text cells guarded against spreadsheet formulas; or a JSON array of objects.
std::string write_table(const Table& table, TableFormat format);

/// The same of a table that is written as it is made.
class TableWriter {
  public:
    /// `take` outlives it.
    TableWriter(const Table& header, TableFormat format, const TakeText& take);

    /// The rows; the columns are those of the header.
    void append(const Table& table);
    void close();

  private:
    TableFormat format_;
    const TakeText& take_;
    bool empty_ = true;
};

/// clip,source,class,rate,frames,state,reason
Table clip_table(const Generation& generation);

/// clip,first,end,letter: frames at the source's rate, from 0, end exclusive.
Table letter_table(const Generation& generation);

/// bundle,clip,first,end,degenerate: frames at the source's rate, from 0, end exclusive; degenerate
/// is 1 where the bundle has one member, else 0.
Table bundle_table(const Generation& generation);

/// clip,frame,neighbour,distance: frames at the source's rate, distance in cm. Clip by clip, as the
/// whole may be larger than the memory.
void write_neighbors(const Generation& generation, TableFormat format, const TakeText& take);

/// clip,first,end,kind,activity_cluster: frames at the source's rate, from 0, end exclusive.
Table segment_table(const Generation& generation);

/// clip,first,end,activity_first,cluster,label: likewise; labels as stored_primitives gives them.
Table primitive_table(const OpenStore& open, const std::filesystem::path& labels = {});

/// class,node,parent,below,above,leaf,frames,error_mm: nodes of the pose hierarchies; -1 where
/// there is none, error (RMS, per marker) of leaves alone.
Table hierarchy_table(const Generation& generation);

/// WHAT of `export`, by name, but for neighbors, graphs and pictures. Throws UsageError listing
/// what there is.
Table export_table(const OpenStore& open, std::string_view what,
                   const std::filesystem::path& labels = {});

}  // namespace kinetome
