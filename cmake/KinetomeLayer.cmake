# Flags every target of this project is built with.
add_library(kinetome_options INTERFACE)
target_compile_features(kinetome_options INTERFACE cxx_std_20)
target_compile_options(kinetome_options INTERFACE
  -march=${KINETOME_ARCH} -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  $<$<BOOL:${KINETOME_WERROR}>:-Werror>
  # GCC 12 finds overlaps in joined std::strings where there are none (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # ... and unset values in its own AVX-512 headers, in std::optional and under sanitizers.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
# Eigen must not start threads of its own: the thread count is given once, and bits depend on none.
target_compile_definitions(kinetome_options INTERFACE
  KINETOME_ARCH="${KINETOME_ARCH}" EIGEN_DONT_PARALLELIZE)
if(KINETOME_SANITIZE)
  target_compile_options(kinetome_options INTERFACE
    -fsanitize=${KINETOME_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)  # else undefined behaviour is printed, and the test passes
  target_link_options(kinetome_options INTERFACE -fsanitize=${KINETOME_SANITIZE})
endif()

# kinetome_precompile(TARGET FROM [HEADER ...]): TARGET uses what FROM precompiled; FROM itself names the headers. Both
# must have the same compile options.
function(kinetome_precompile target from)
  if(target STREQUAL from)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
  # The first lets ccache see what was precompiled. The others: GCC forgets that a precompiled header is the system's,
  # and finds overlaps and bounds in it where there are none (bug 105651 again).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess
    -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
endfunction()

# kinetome_layer(NAME [USES lower layers] [LINKS external targets])
# makes the library kinetome_NAME of src/NAME with the headers in include/kinetome/NAME.
# Headers of a layer are found only through its target, so the link order is the include order.
function(kinetome_layer name)
  cmake_parse_arguments(layer "" "" "USES;LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/kinetome/${name}/*.h)
  set(target kinetome_${name})

  # A private include root with this layer's headers alone.
  set(root ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root}/kinetome)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/include/kinetome/${name} ${root}/kinetome/${name} SYMBOLIC)

  if(sources)
    set(scope PUBLIC)
    add_library(${target} STATIC ${sources} ${headers})
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src/${name})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:kinetome_options>)
    if(KINETOME_PRECOMPILE STREQUAL "all")
      kinetome_precompile(${target} kinetome_base)
    endif()
  else()  # headers alone
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  add_library(kinetome::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${root}> $<INSTALL_INTERFACE:include>)
  list(TRANSFORM layer_USES PREPEND kinetome_)
  target_link_libraries(${target} ${scope} ${layer_USES} ${layer_LINKS})
  target_compile_features(${target} ${scope} cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY KINETOME_LAYERS ${target})
endfunction()
