# Fails, naming it, on anything committed at the top level that does not belong there, such as what a test has left.
# Without git, or outside a clone, there is nothing to look at. Run as
#   cmake -DROOT=<tree> -P check_top_level.cmake
cmake_minimum_required(VERSION 3.25)
set(belongs "^(src|include|drivers|tests|docs|cmake|\\.ci)/|^(CMakeLists\\.txt|CMakePresets\\.json|README\\.md|LICENSE|CHANGELOG\\.md|CITATION\\.cff|quickstart|\\.[^/]+)$")
execute_process(COMMAND git -C "${ROOT}" ls-files --cached
  RESULT_VARIABLE status OUTPUT_VARIABLE listed ERROR_QUIET)
if(NOT status EQUAL 0 OR listed STREQUAL "")
  message(NOTICE "${ROOT} is no clone: not looked at")
  return()
endif()
string(STRIP "${listed}" listed)
string(REPLACE "\n" ";" files "${listed}")
list(FILTER files EXCLUDE REGEX "${belongs}")
if(files)
  list(JOIN files "\n" names)
  message(FATAL_ERROR "committed outside the folders of the project:\n${names}")
endif()
message(NOTICE "what is committed lies where it belongs")
