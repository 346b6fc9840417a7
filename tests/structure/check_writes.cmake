# Fails, naming file and line, where a source opens a file for writing but those that all others do it through
# (orbweaver/core/output_file.hpp and posix_file.hpp): these follow no link and empty nothing. Run as
#   cmake -DROOT=<tree> -P check_writes.cmake
cmake_minimum_required(VERSION 3.25)
# HDF5 creates a file where core has made a new one: layout_file, text_table. A lock is no output.
set(writers src/core/posix_file.cpp src/core/output_file.cpp src/archive/file/layout_file.cpp src/archive/file/text_table.cpp
  src/archive/file/folder_lock.cpp)
set(opens "ofstream[ \t]*[({]|ofstream [a-z_]+|[^i]fstream [a-z_]+|f(re)?open[ \t]*\\(|O_CREAT|O_TRUNC|O_APPEND|[^a-z_]creat[ \t]*\\(|H5Fcreate|H5F_ACC_TRUNC|MPI_File_open|copy_file")
file(GLOB_RECURSE files RELATIVE "${ROOT}"
  "${ROOT}/include/*.hpp" "${ROOT}/src/*.hpp" "${ROOT}/src/*.cpp" "${ROOT}/drivers/*.hpp" "${ROOT}/drivers/*.cpp" "${ROOT}/drivers/*.in")
list(REMOVE_ITEM files ${writers})
if(NOT files)
  message(FATAL_ERROR "no sources below ${ROOT}")
endif()
set(faults 0)
foreach(file IN LISTS files)
  file(STRINGS "${ROOT}/${file}" lines REGEX "${opens}")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^[ \t]*//")
      message(NOTICE "${file}: opens a file for writing, past core's: ${line}")
      math(EXPR faults "${faults} + 1")
    endif()
  endforeach()
endforeach()
list(LENGTH files count)
if(faults GREATER 0)
  message(FATAL_ERROR "${faults} lines of ${count} sources open files for writing")
endif()
message(NOTICE "${count} sources write through core")
