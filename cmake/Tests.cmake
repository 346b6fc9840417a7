# Test registration. Every test runs in a working folder of its own, with one BLAS thread and oversubscription allowed.
find_package(GTest 1.12 REQUIRED)
include(GoogleTest)

set(ORBWEAVER_TEST_ENVIRONMENT
  "OMP_NUM_THREADS=1"
  "OPENBLAS_NUM_THREADS=1"
  "OMPI_ALLOW_RUN_AS_ROOT=1"
  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"
  "OMPI_MCA_rmaps_base_oversubscribe=1"
  "OMPI_MCA_btl_base_warn_component_unused=0"
  "ASAN_OPTIONS=fast_unwind_on_malloc=0:allocator_may_return_null=1"
  "UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1"
  "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp")

# Half of a test's compile time is optimisation, for code that runs once. Not -O0: the linker may take a template of Eigen that a test
# has compiled for the libraries too. For the same reason all tests see orbweaver/numerics/decompositions.hpp: with a decomposition
# compiled here two surveys beside it ended otherwise. g++ 12 then warns of bounds within strings of the standard library where there is
# nothing wrong.
set(ORBWEAVER_TEST_OPTIMISATION
  "$<$<CONFIG:Release>:-O1;${ORBWEAVER_NO_WARNINGS_OF_BOUNDS}>")

# Programs of 10 MB and more: gold links one in a quarter of the time of GNU ld.
include(CheckLinkerFlag)
check_linker_flag(CXX "-fuse-ld=gold" ORBWEAVER_HAS_GOLD)

# As orbweaver_precompiled, with GoogleMock.
if(ORBWEAVER_PRECOMPILED_HEADERS)
  add_library(orbweaver_test_precompiled OBJECT EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_link_libraries(orbweaver_test_precompiled PRIVATE orbweaver_build_flags Eigen3::Eigen fmt::fmt GTest::gmock)
  target_compile_options(orbweaver_test_precompiled PRIVATE ${ORBWEAVER_TEST_OPTIMISATION})
  target_include_directories(orbweaver_test_precompiled PRIVATE "${PROJECT_SOURCE_DIR}/include")
  target_precompile_headers(orbweaver_test_precompiled PRIVATE ${ORBWEAVER_COMMON_HEADERS} <gmock/gmock.h> <gtest/gtest.h>
    <orbweaver/numerics/decompositions.hpp>)
endif()

# The program that the tests of a layer share: <kind> is `session` (test_<layer>: a main that starts MPI, PETSc and SLEPc around the
# tests), `mpi` (test_<layer>: MPI only) or `single` (test_<layer>_single: neither). Few programs: each takes a second to link, and
# what its sources share is compiled once for several of them.
function(orbweaver_test_program layer kind target)
  set(name test_${layer})
  if(kind STREQUAL "single")
    set(name test_${layer}_single)
  endif()
  set(${target} ${name} PARENT_SCOPE)
  if(TARGET ${name})
    return()
  endif()
  add_executable(${name})
  set(main_of_session orbweaver_test_main)
  set(main_of_mpi orbweaver_test_main_without_petsc)
  set(main_of_single GTest::gtest_main)
  target_link_libraries(${name} PRIVATE ${main_of_${kind}} GTest::gmock orbweaver_build_flags)
  # Designated initializers name the options that a test is about; the others keep their defaults.
  target_compile_options(${name} PRIVATE ${ORBWEAVER_TEST_OPTIMISATION} -Wno-missing-field-initializers)
  if(ORBWEAVER_HAS_GOLD)
    target_link_options(${name} PRIVATE "-fuse-ld=gold")
  endif()
  if(ORBWEAVER_PRECOMPILED_HEADERS)
    target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt)
    target_precompile_headers(${name} REUSE_FROM orbweaver_test_precompiled)
  endif()
  orbweaver_unity_build(${name} 16)
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  if(IS_DIRECTORY "${PROJECT_SOURCE_DIR}/src/${layer}")
    target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/src/${layer}")
  endif()
  target_compile_definitions(${name} PRIVATE
    ORBWEAVER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ORBWEAVER_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_property(GLOBAL APPEND PROPERTY ORBWEAVER_TEST_PROGRAMS ${name})
endfunction()

# The suites of GoogleTest in these sources, as patterns of a filter.
function(orbweaver_suites_of sources patterns)
  set(found "")
  foreach(source IN LISTS sources)
    file(STRINGS "${source}" lines REGEX "^(TEST|TEST_F|TEST_P|TYPED_TEST)\\([A-Za-z0-9_]+,")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "^([A-Z_]+)\\(([A-Za-z0-9_]+)," unused "${line}")
      if(CMAKE_MATCH_1 STREQUAL "TEST_P")
        list(APPEND found "*/${CMAKE_MATCH_2}.*")
      elseif(CMAKE_MATCH_1 STREQUAL "TYPED_TEST")
        list(APPEND found "${CMAKE_MATCH_2}/*")
      else()
        list(APPEND found "${CMAKE_MATCH_2}.*")
      endif()
    endforeach()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}")
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${patterns} "${found}" PARENT_SCOPE)
endfunction()

# orbweaver_test(<name> LAYER <layer> SOURCES ... [DEPENDS ...] [INCLUDES folder ...] [RANKS 1 2 3] [LONG_ON ranks ...]
#   [TIMEOUT seconds] [LABELS ...] [ONLY_ON ranks test ...] [LONG_TESTS ...] [LONG_RANKS ranks])
# The suites of GoogleTest in some sources, in the layer's program. Without RANKS they run alone; with RANKS they run under mpirun
# once for each rank count, those of LONG_ON (some of RANKS) with the label long. ONLY_ON: these tests (Suite.Test, or a pattern of them) on one of the rank counts only. LONG_TESTS run in
# a CTest of their own, <name>.long, with the label long, on LONG_RANKS or the last of RANKS.
# SESSION starts MPI, PETSc and SLEPc around the tests, as RANKS does; with WITHOUT_PETSC that is MPI only.
function(orbweaver_test name)
  cmake_parse_arguments(TEST "SESSION;WITHOUT_PETSC" "LAYER;TIMEOUT;LONG_RANKS"
    "SOURCES;DEPENDS;INCLUDES;RANKS;LONG_ON;LABELS;ONLY_ON;LONG_TESTS" ${ARGN})
  set(kind single)
  if(TEST_WITHOUT_PETSC AND TEST_RANKS)
    set(kind mpi)
  elseif(TEST_SESSION OR TEST_RANKS)
    set(kind session)
  endif()
  orbweaver_test_program(${TEST_LAYER} ${kind} target)
  set(sources "")
  foreach(source IN LISTS TEST_SOURCES)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND sources "${source}")
  endforeach()
  target_sources(${target} PRIVATE ${sources})
  target_link_libraries(${target} PRIVATE ${TEST_DEPENDS})
  target_include_directories(${target} PRIVATE ${TEST_INCLUDES})

  orbweaver_suites_of("${sources}" suites)
  if(NOT suites)
    message(FATAL_ERROR "${name}: no tests of GoogleTest in ${TEST_SOURCES}")
  endif()
  foreach(suite IN LISTS suites)
    get_property(others GLOBAL PROPERTY ORBWEAVER_SUITES_OF_${target})
    if(suite IN_LIST others)
      message(FATAL_ERROR "${name}: the suite ${suite} is one of another test of ${target} too: each would run both")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY ORBWEAVER_SUITES_OF_${target} ${suites})
  list(JOIN suites ":" filter)

  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  if(NOT TEST_RANKS)
    orbweaver_filter("${filter}" "${TEST_LONG_TESTS}" filtered)
    orbweaver_add_ctest(${name} 1 "${TEST_LAYER};${TEST_LABELS}" ${TEST_TIMEOUT} $<TARGET_FILE:${target}> ${filtered})
  endif()
  set(only_on -1)
  if(TEST_ONLY_ON)
    list(POP_FRONT TEST_ONLY_ON only_on)
  endif()
  foreach(ranks IN LISTS TEST_RANKS)
    set(left_out ${TEST_LONG_TESTS})
    if(NOT ranks EQUAL only_on)
      list(APPEND left_out ${TEST_ONLY_ON})
    endif()
    orbweaver_filter("${filter}" "${left_out}" filtered)
    set(labels ${TEST_LAYER} mpi ${TEST_LABELS})
    if(ranks IN_LIST TEST_LONG_ON)
      list(APPEND labels long)
    endif()
    orbweaver_add_ctest(${name}.ranks${ranks} ${ranks} "${labels}" ${TEST_TIMEOUT}
      ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} $<TARGET_FILE:${target}> ${filtered})
  endforeach()
  if(TEST_LONG_TESTS)
    set(launcher "")
    if(TEST_RANKS)
      list(GET TEST_RANKS -1 ranks)
      if(TEST_LONG_RANKS)
        set(ranks ${TEST_LONG_RANKS})
      endif()
      set(launcher ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks})
    endif()
    list(JOIN TEST_LONG_TESTS ":" filter)
    orbweaver_add_ctest(${name}.long 1 "${TEST_LAYER};long" 1200 ${launcher} $<TARGET_FILE:${target}> "--gtest_filter=${filter}")
  endif()
endfunction()

# --gtest_filter=<filter>-<left out>
function(orbweaver_filter filter left_out argument)
  if(left_out)
    list(JOIN left_out ":" left_out)
    string(APPEND filter ":-${left_out}")
  endif()
  set(${argument} "--gtest_filter=${filter}" PARENT_SCOPE)
endfunction()

# After all calls of orbweaver_test: whether each test of the programs is one of a CTest.
function(orbweaver_test_of_filters)
  get_property(programs GLOBAL PROPERTY ORBWEAVER_TEST_PROGRAMS)
  set(lines "")
  foreach(program IN LISTS programs)
    get_property(suites GLOBAL PROPERTY ORBWEAVER_SUITES_OF_${program})
    list(JOIN suites ":" filter)
    string(APPEND lines "$<TARGET_FILE:${program}>|${filter}\n")
  endforeach()
  file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/test_programs.txt" CONTENT "${lines}")
  orbweaver_add_ctest(structure_all_tests_run 1 structure 60 ${CMAKE_COMMAND}
    "-DPROGRAMS=${PROJECT_BINARY_DIR}/test_programs.txt" -P "${PROJECT_SOURCE_DIR}/tests/structure/check_all_tests_run.cmake")
endfunction()

# orbweaver_add_ctest(<name> <ranks> <labels> <timeout> <command> [args...])
# Any command as a CTest in the common environment. Ranks wait for one another most of the time and rank 0 sleeps meanwhile: up to three of
# them count as one processor, more as two. What wants two begins when nothing else is left: those of one processor take each that is free.
function(orbweaver_add_ctest name ranks labels timeout)
  set(processors 1)
  if(ranks GREATER 3)
    set(processors 2)
  endif()
  set(folder "${PROJECT_BINARY_DIR}/test_runs/${name}")
  file(MAKE_DIRECTORY "${folder}")
  if(ORBWEAVER_SANITIZE)
    math(EXPR timeout "10 * ${timeout}")
  endif()
  add_test(NAME ${name} COMMAND ${ARGN} WORKING_DIRECTORY "${folder}")
  list(REMOVE_ITEM labels "")
  set_tests_properties(${name} PROPERTIES
    PROCESSORS ${processors} LABELS "${labels}" TIMEOUT ${timeout}
    ENVIRONMENT "${ORBWEAVER_TEST_ENVIRONMENT}")
endfunction()
