# The layers in the order of docs/architecture.md. A layer may include only those before it; tests/structure checks the includes.
set(ORBWEAVER_LAYERS
  core document model ad numerics systems taylor scene loop loss equations spectrum corrector starts continuation bifurcation certificate archive queue
  survey refine prove cost report)

# g++ 12 reports its own AVX-512 intrinsics as maybe-uninitialized wherever Eigen inlines them.
set(ORBWEAVER_WARNING_FLAGS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wno-maybe-uninitialized)
# In a unity build the helpers of one source are global to the next, and no source is the main file; with more inlined, g++ 12 warns
# of bounds within strings of the standard library where there is nothing wrong. Other builds warn of all.
set(ORBWEAVER_NO_WARNINGS_OF_BOUNDS -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
if(ORBWEAVER_UNITY_BUILD)
  list(APPEND ORBWEAVER_WARNING_FLAGS -Wno-shadow -Wshadow=local -Wno-subobject-linkage ${ORBWEAVER_NO_WARNINGS_OF_BOUNDS})
endif()
if(ORBWEAVER_WARNINGS_AS_ERRORS)
  list(APPEND ORBWEAVER_WARNING_FLAGS -Werror)
endif()

add_library(orbweaver_build_flags INTERFACE)
target_compile_features(orbweaver_build_flags INTERFACE cxx_std_20)
target_compile_options(orbweaver_build_flags INTERFACE ${ORBWEAVER_WARNING_FLAGS})
# Also of programs that use the installed libraries: the alignment of Eigen's types follows the instruction set.
add_library(orbweaver_machine INTERFACE)
set(ORBWEAVER_MACHINE_FLAGS "")
if(ORBWEAVER_NATIVE)
  list(APPEND ORBWEAVER_MACHINE_FLAGS -march=native)
elseif(ORBWEAVER_BASELINE)
  list(APPEND ORBWEAVER_MACHINE_FLAGS "-march=${ORBWEAVER_BASELINE}")
endif()
# g++ 12 with AVX-512 compiles some vector constants wrongly ({c, c, 0, 0} becomes {c, c, c, c}).
if(ORBWEAVER_MACHINE_FLAGS AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"
    AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND ORBWEAVER_MACHINE_FLAGS -mno-avx512f)
endif()
target_compile_options(orbweaver_machine INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${ORBWEAVER_MACHINE_FLAGS}>")
install(TARGETS orbweaver_machine EXPORT OrbweaverTargets)
set_target_properties(orbweaver_machine PROPERTIES EXPORT_NAME machine)
target_link_libraries(orbweaver_build_flags INTERFACE orbweaver_machine)
if(ORBWEAVER_SANITIZE)
  # Those left out check every access once more, and double the time of compiling: a batch of systems took 202 s with them, 104 s without.
  # A null or wild pointer is AddressSanitizer's to find.
  target_compile_options(orbweaver_build_flags INTERFACE -fsanitize=address,undefined
    -fno-sanitize=null,alignment,vptr,object-size -fno-omit-frame-pointer)
  target_link_options(orbweaver_build_flags INTERFACE -fsanitize=address,undefined)
endif()

# PETSc's pkg-config file asks for it, and a precompiled header wants the same macros in all sources.
target_compile_definitions(orbweaver_build_flags INTERFACE _FORTIFY_SOURCE=2)

# Headers of others that most sources include, read once (docs/building.md). Sources include what they use all the same. No header
# whose code every object would then hold, as that of CLI11 with its virtual functions.
set(ORBWEAVER_COMMON_HEADERS
  <algorithm> <array> <chrono> <cmath> <complex> <cstddef> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
  <numbers> <numeric> <optional> <set> <span> <sstream> <string> <string_view> <tuple> <utility> <variant> <vector>
  <Eigen/Dense> <fmt/format.h> <fmt/ranges.h>)
if(ORBWEAVER_PRECOMPILED_HEADERS)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
  add_library(orbweaver_precompiled OBJECT "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_link_libraries(orbweaver_precompiled PRIVATE orbweaver_build_flags Eigen3::Eigen fmt::fmt)
  target_precompile_headers(orbweaver_precompiled PRIVATE ${ORBWEAVER_COMMON_HEADERS})
endif()
function(orbweaver_precompiled_headers target)
  if(ORBWEAVER_PRECOMPILED_HEADERS)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)  # its macros must be those of the header
    target_precompile_headers(${target} REUSE_FROM orbweaver_precompiled)
  endif()
endfunction()

# Several sources of a target in one translation unit (docs/building.md): what they share is read and instantiated once.
# `batch` sources at a time. Tests have a namespace each; in larger batches of the layers names would meet.
function(orbweaver_unity_build target batch)
  if(ORBWEAVER_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()

# orbweaver_layer(<name> [EXCEPT folder ...] [DEPENDS layer-or-library ...])
# One static library a layer: target orbweaver_<name>, alias orbweaver::<name>, of every .cpp in the layer's folder and its
# subfolders. Private headers are named by their path from that folder.
function(orbweaver_layer name)
  cmake_parse_arguments(LAYER "" "FOLDER" "EXCEPT;DEPENDS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}"
    "${CMAKE_CURRENT_SOURCE_DIR}/${LAYER_FOLDER}/*.cpp")
  foreach(folder IN LISTS LAYER_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "^${folder}/")
  endforeach()
  if(sources)
    add_library(orbweaver_${name} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(orbweaver_${name} PRIVATE $<BUILD_INTERFACE:orbweaver_build_flags>)
    orbweaver_precompiled_headers(orbweaver_${name})
    orbweaver_unity_build(orbweaver_${name} 8)
    target_include_directories(orbweaver_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  else()
    add_library(orbweaver_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(orbweaver::${name} ALIAS orbweaver_${name})
  target_include_directories(orbweaver_${name} ${scope}
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_compile_features(orbweaver_${name} ${scope} cxx_std_20)
  target_link_libraries(orbweaver_${name} ${scope} ${LAYER_DEPENDS} orbweaver_machine)
  set_target_properties(orbweaver_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS orbweaver_${name} EXPORT OrbweaverTargets)
endfunction()
