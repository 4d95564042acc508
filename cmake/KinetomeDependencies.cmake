# Every outside library, looked for once, with a message that says what to install.
macro(kinetome_require package debian)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR
      "Kinetome needs ${package}, which was not found.\n"
      "On Debian: apt-get install ${debian}   (or run scripts/setup.sh, which installs everything)")
  endif()
endmacro()

kinetome_require(OpenMP g++ COMPONENTS CXX)
kinetome_require(Eigen3 libeigen3-dev)
kinetome_require(TBB libtbb-dev)
kinetome_require(spdlog libspdlog-dev)
kinetome_require(fmt libfmt-dev)
kinetome_require(CLI11 libcli11-dev)
kinetome_require(tomlplusplus libtomlplusplus-dev)
kinetome_require(nlohmann_json nlohmann-json3-dev)
kinetome_require(xxHash libxxhash-dev)
kinetome_require(FLANN "libflann-dev liblz4-dev")
if(KINETOME_WITH_MPI)
  kinetome_require(MPI "libopenmpi-dev openmpi-bin" COMPONENTS C)
endif()
# The serial library: its blosc and lz4 plugins exist in Debian, those of the MPI build do not.
set(HDF5_PREFER_PARALLEL OFF)
find_package(HDF5 QUIET COMPONENTS C)
if(NOT HDF5_FOUND)
  message(FATAL_ERROR "Kinetome needs HDF5 1.10 or later, which was not found.\n"
    "On Debian: apt-get install libhdf5-dev   (or run scripts/setup.sh, which installs everything)")
endif()

add_library(KinetomeDep::hdf5 INTERFACE IMPORTED)
target_include_directories(KinetomeDep::hdf5 INTERFACE ${HDF5_INCLUDE_DIRS})
target_link_libraries(KinetomeDep::hdf5 INTERFACE ${HDF5_C_LIBRARIES})

add_library(KinetomeDep::base INTERFACE IMPORTED)
target_link_libraries(KinetomeDep::base INTERFACE
  OpenMP::OpenMP_CXX Eigen3::Eigen spdlog::spdlog fmt::fmt xxHash::xxHash)
