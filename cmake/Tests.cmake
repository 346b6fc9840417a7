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
  "ASAN_OPTIONS=fast_unwind_on_malloc=0"
  "UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1"
  "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp")

# Half of a test's compile time is optimisation, for code that runs once. Not -O0: the linker may take a template of Eigen that a test
# has compiled for the libraries too. g++ 12 then warns of bounds within strings of the standard library where there is nothing wrong.
set(ORBWEAVER_TEST_OPTIMISATION
  "$<$<CONFIG:Release>:-O1;-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>")

# 150 programs of 10 MB each: gold links one in a quarter of the time of GNU ld.
include(CheckLinkerFlag)
check_linker_flag(CXX "-fuse-ld=gold" ORBWEAVER_HAS_GOLD)

# As orbweaver_precompiled, with GoogleMock.
if(ORBWEAVER_PRECOMPILED_HEADERS)
  add_library(orbweaver_test_precompiled OBJECT EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_link_libraries(orbweaver_test_precompiled PRIVATE orbweaver_build_flags Eigen3::Eigen fmt::fmt GTest::gmock)
  target_compile_options(orbweaver_test_precompiled PRIVATE ${ORBWEAVER_TEST_OPTIMISATION})
  target_precompile_headers(orbweaver_test_precompiled PRIVATE ${ORBWEAVER_COMMON_HEADERS} <gmock/gmock.h> <gtest/gtest.h>)
endif()

# orbweaver_test(<name> LAYER <layer> SOURCES ... [DEPENDS ...] [RANKS 1 2 3] [TIMEOUT seconds] [LABELS ...] [LONG_TESTS ...])
# A GoogleTest program. Without RANKS it runs alone; with RANKS it runs under mpirun once for each rank count.
# LONG_TESTS (Suite.Test, or a pattern of them) run in a CTest of their own, <name>.long, with the label long, on the last of RANKS.
# SESSION links a main that starts MPI, PETSc and SLEPc around the tests, as RANKS does; with WITHOUT_PETSC that one starts MPI only.
function(orbweaver_test name)
  cmake_parse_arguments(TEST "SESSION;WITHOUT_PETSC" "LAYER;TIMEOUT" "SOURCES;DEPENDS;RANKS;LABELS;LONG_TESTS" ${ARGN})
  set(target test_${name})
  add_executable(${target} ${TEST_SOURCES})
  if(TEST_WITHOUT_PETSC AND TEST_RANKS)
    target_link_libraries(${target} PRIVATE orbweaver_test_main_without_petsc GTest::gmock)
  elseif(TEST_SESSION OR TEST_RANKS)
    target_link_libraries(${target} PRIVATE orbweaver_test_main GTest::gmock)
  else()
    target_link_libraries(${target} PRIVATE GTest::gmock GTest::gtest_main)
  endif()
  target_link_libraries(${target} PRIVATE orbweaver_build_flags ${TEST_DEPENDS})
  target_compile_options(${target} PRIVATE ${ORBWEAVER_TEST_OPTIMISATION})
  if(ORBWEAVER_HAS_GOLD)
    target_link_options(${target} PRIVATE "-fuse-ld=gold")
  endif()
  if(ORBWEAVER_PRECOMPILED_HEADERS)
    target_link_libraries(${target} PRIVATE Eigen3::Eigen fmt::fmt)
    target_precompile_headers(${target} REUSE_FROM orbweaver_test_precompiled)
  endif()
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_compile_definitions(${target} PRIVATE
    ORBWEAVER_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ORBWEAVER_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  list(JOIN TEST_LONG_TESTS ":" long_tests)
  if(long_tests)
    set(all_but_long "--gtest_filter=-${long_tests}")
  endif()
  if(NOT TEST_RANKS)
    orbweaver_add_ctest(${name} 1 "${TEST_LAYER};${TEST_LABELS}" ${TEST_TIMEOUT} $<TARGET_FILE:${target}> ${all_but_long})
  endif()
  set(launcher "")
  foreach(ranks IN LISTS TEST_RANKS)
    set(launcher ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks})
    orbweaver_add_ctest(${name}.ranks${ranks} ${ranks} "${TEST_LAYER};mpi;${TEST_LABELS}" ${TEST_TIMEOUT}
      ${launcher} $<TARGET_FILE:${target}> ${all_but_long})
  endforeach()
  if(long_tests)
    orbweaver_add_ctest(${name}.long 1 "${TEST_LAYER};long" 1200 ${launcher} $<TARGET_FILE:${target}> "--gtest_filter=${long_tests}")
  endif()
endfunction()

# orbweaver_add_ctest(<name> <ranks> <labels> <timeout> <command> [args...])
# Any command as a CTest in the common environment. It is given a processor a worker: rank 0 sleeps while it waits.
function(orbweaver_add_ctest name ranks labels timeout)
  math(EXPR processors "${ranks} - 1")
  if(processors LESS 1)
    set(processors 1)
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
