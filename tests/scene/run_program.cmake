# Runs PROGRAM with ARGUMENTS (joined by `|`); fails unless it ends with STATUS, its stdout holds OUT and its stderr holds ERR. Where OUT or
# ERR is empty, that stream must be empty too.
string(REPLACE "|" ";" ARGUMENTS "${ARGUMENTS}")
execute_process(COMMAND "${PROGRAM}" ${ARGUMENTS} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)

function(expect_text name text expected)
  if(expected STREQUAL "" AND NOT text STREQUAL "")
    message(FATAL_ERROR "${name}: expected nothing, got:\n${text}")
  endif()
  string(FIND "${text}" "${expected}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${name}: expected to find\n${expected}\ngot:\n${text}")
  endif()
endfunction()

if(NOT status STREQUAL STATUS)
  message(FATAL_ERROR "exit status: expected ${STATUS}, got ${status}; stderr:\n${err}")
endif()
expect_text(stdout "${out}" "${OUT}")
expect_text(stderr "${err}" "${ERR}")
