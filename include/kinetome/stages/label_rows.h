// Tables of labelled frames, held against the clips they speak of.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinetome/formats/annotation.h"
#include "kinetome/store/catalog.h"

namespace kinetome {

/// What to do with rows of clips that the store does not have.
enum class UnknownClips { refused, passed_over };

/// Throws InputError naming the line of a row of a clip that is not indexed, of one that goes
/// beyond its clip, and of one that gives another label to frames that a row before it labels.
void require_fitting_rows(std::span<const CycleRow> rows, const Catalog& catalog,
                          const std::string& path, UnknownClips unknown = UnknownClips::refused);

/// The rows of a table (parse_labels_csv) that fit.
std::vector<CycleRow> read_label_rows(const std::filesystem::path& file, const Catalog& catalog,
                                      UnknownClips unknown = UnknownClips::refused);

}  // namespace kinetome
