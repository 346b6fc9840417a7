# Bundles the page and writes it as a C++ source. Run as
#   cmake -DWEB=<sources> -DBUILD=<folder> -DOUT=<source to write> -DNODE=<node> -DNPM=<npm> -P embed.cmake
# Where Node, npm or the network is missing the source says so; an error in the page's own sources ends the build.
cmake_minimum_required(VERSION 3.25)

function(write_source bytes count reason)
  set(mark "")
  if(reason)
    set(mark "// missing\n")
  endif()
  file(WRITE "${OUT}" "${mark}#include \"page/page_template.hpp\"

namespace orbweaver::drivers {

namespace {

constexpr char bytes[] = {${bytes}0};

}  // namespace

std::string_view page_template() { return {bytes, ${count}}; }

std::string missing_page_reason() { return \"${reason}\"; }

}  // namespace orbweaver::drivers
")
endfunction()

function(leave_out reason)
  message(WARNING "orbweaver page is not built: ${reason}")
  write_source("" 0 "this program was built without it, since ${reason}. Then build again: ./quickstart page")
endfunction()

if(NOT NODE OR NOT NPM)
  leave_out("Node was not found: install it (apt-get install nodejs npm)")
  return()
endif()
file(MAKE_DIRECTORY "${BUILD}")
foreach(file package.json package-lock.json build.mjs tsconfig.json)
  file(COPY "${WEB}/${file}" DESTINATION "${BUILD}")
endforeach()
file(REMOVE_RECURSE "${BUILD}/src")
file(COPY "${WEB}/src" DESTINATION "${BUILD}")
# The libraries are those of the lock file, fetched once for each of its states.
file(SHA256 "${WEB}/package-lock.json" lock)
if(NOT EXISTS "${BUILD}/node_modules/${lock}")
  execute_process(COMMAND "${NPM}" ci --ignore-scripts --no-audit --no-fund --loglevel=error WORKING_DIRECTORY "${BUILD}"
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(NOTICE "${output}")
    set(code "")
    if(output MATCHES "npm (ERR!|error) code ([A-Z0-9_]+)")  # npm 9 and 10
      set(code "${CMAKE_MATCH_2}; ")
    endif()
    leave_out("npm could not fetch its libraries (${code}is the npm registry reachable?)")
    return()
  endif()
  file(TOUCH "${BUILD}/node_modules/${lock}")
endif()
execute_process(COMMAND "${NODE}" build.mjs WORKING_DIRECTORY "${BUILD}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "the page could not be bundled; the messages are above")
endif()
file(READ "${BUILD}/page.html" hex HEX)
string(LENGTH "${hex}" digits)
math(EXPR count "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
write_source("${bytes}" ${count} "")
