// pose_hierarchy.h5: principal markers, tree, local linear models and marker maps of each class.
#pragma once

#include <string>
#include <vector>

#include "kinetome/models/hierarchy_growth.h"
#include "kinetome/models/principal_markers.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// The piecewise-linear model of a class of skeletons.
struct ClassHierarchy {
    PrincipalMarkers principal;
    PoseHierarchy hierarchy;
    MarkerMaps maps;
    std::vector<std::string> marker_names;  ///< of all f / 3 markers
    double pose_rate = 0;                   ///< frames a second of the poses it was made of
};

/// `group`: "/<class>".
void write_pose_hierarchy(ArtifactWriter& file, const std::string& group,
                          const ClassHierarchy& model);
/// Throws StoreError when the file does not hold that class.
ClassHierarchy read_pose_hierarchy(const ArtifactReader& file, const std::string& group);

/// Classes that a file holds, in name order.
std::vector<std::string> hierarchy_classes(const ArtifactReader& file);

}  // namespace kinetome
