# Fails, naming file and line, on a line of a source that is longer than 120 columns. Run as
#   cmake -DROOT=<tree> -P check_widths.cmake
cmake_minimum_required(VERSION 3.25)
set(longest 120)
file(GLOB_RECURSE files RELATIVE "${ROOT}"
  "${ROOT}/include/*.hpp" "${ROOT}/src/*.hpp" "${ROOT}/src/*.cpp" "${ROOT}/drivers/*.hpp" "${ROOT}/drivers/*.cpp"
  "${ROOT}/tests/*.hpp" "${ROOT}/tests/*.cpp")
list(LENGTH files count)
if(count EQUAL 0)
  message(FATAL_ERROR "no sources below ${ROOT}")
endif()
string(REPEAT "." ${longest} as_long)
set(faults 0)
foreach(file IN LISTS files)
  file(STRINGS "${ROOT}/${file}" lines REGEX "^${as_long}." ENCODING UTF-8)
  foreach(line IN LISTS lines)
    message(NOTICE "${file}: longer than ${longest} columns: ${line}")
    math(EXPR faults "${faults} + 1")
  endforeach()
endforeach()
if(faults GREATER 0)
  message(FATAL_ERROR "${faults} lines of ${count} sources are longer than ${longest} columns")
endif()
message(NOTICE "the lines of ${count} sources are within ${longest} columns")
