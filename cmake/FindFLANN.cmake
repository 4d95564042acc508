# FLANN::FLANN: the headers, and lz4, which they call. Debian's packages have no CMake configuration.
find_path(FLANN_INCLUDE_DIR flann/algorithms/kdtree_single_index.h)
find_path(FLANN_LZ4_INCLUDE_DIR lz4.h)
find_library(FLANN_LZ4_LIBRARY lz4)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FLANN DEFAULT_MSG
  FLANN_INCLUDE_DIR FLANN_LZ4_INCLUDE_DIR FLANN_LZ4_LIBRARY)
if(FLANN_FOUND AND NOT TARGET FLANN::FLANN)
  add_library(FLANN::FLANN INTERFACE IMPORTED)
  set_target_properties(FLANN::FLANN PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${FLANN_INCLUDE_DIR};${FLANN_LZ4_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${FLANN_LZ4_LIBRARY}")
endif()
