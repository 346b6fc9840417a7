# What a machine can do to a survey: each fault gives a message that says what, where and what to do, and the status of
# the README, on any number of ranks; CTest's time limit ends a hang.
set(fine_scene "${PROJECT_SOURCE_DIR}/drivers/scenes/double_pendulum_half_degree.yaml")
# Some 400 orbits: enough for a dozen flushes.
set(coarse --set continuation.step=2deg --set limits.period=12 --set starts.sweep.step=0.05 --set output.flush_seconds=0.2 --set output.flush_orbits=25)
set(fine --set continuation.step=0.5deg --set limits.period=12 --set starts.sweep.step=0.01 --set output.flush_seconds=0.2 --set output.flush_orbits=100)

# full_disk_test(<name> <ranks> <limit> <place> [KEY=value of run_program.cmake ...]): no file may grow beyond <limit> once the
# survey comes to <place> (full_disk.sh).
function(full_disk_test name ranks limit place)
  set(command "$<TARGET_FILE:orbweaver>" survey "${fine_scene}" -o out ${coarse} -q)
  if(ranks GREATER 1)
    set(command ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${command})
  endif()
  list(JOIN command "|" command)
  set(keys ${ARGN})
  list(TRANSFORM keys PREPEND "-D")
  orbweaver_add_ctest(system.${name} ${ranks} system 120 ${CMAKE_COMMAND}
    "-DCOMMAND=${CMAKE_CURRENT_FUNCTION_LIST_DIR}/full_disk.sh|${limit}|${place}|${command}" -DSTATUS=3 ${keys}
    -P "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/run_program.cmake")
endfunction()

foreach(ranks IN ITEMS 1 2 3)
  set(tag ranks${ranks})
  # A folder that is a file, one under a file, one where nobody may write.
  set(folder "${runs}/system.output_is_a_file.${tag}/out")
  system_test(output_is_a_file.${tag} ${ranks} 3 "ERR=cannot create the folder out|Not a directory|give -o a place where you may write"
    "FRESH=${folder}" "LEFTOVER=${folder}" "SAME=${folder}" survey "${scene}" -o out ${limits})
  system_test(output_below_a_file.${tag} ${ranks} 3 "ERR=cannot create the folder out/file/inside|Not a directory"
    "FRESH=${runs}/system.output_below_a_file.${tag}/out" "LEFTOVER=${runs}/system.output_below_a_file.${tag}/out/file"
    "SAME=${runs}/system.output_below_a_file.${tag}/out/file" survey "${scene}" -o out/file/inside ${limits})
  system_test(output_in_proc.${tag} ${ranks} 3 "ERR=cannot create the folder /proc/orbweaver|give -o a place where you may write"
    survey "${scene}" -o /proc/orbweaver ${limits})
  # A disk that is full at the first flush, and one that holds the segments but not the atlas made of them.
  foreach(limit IN ITEMS "20000:" "20000:20000" "2000:2000")
    string(REPLACE ":" "_" name "full_disk.${limit}.${tag}")
    set(folder "${runs}/system.${name}/out")
    full_disk_test(${name} ${ranks} ${limit} "sync payloads"
      "ERR=orbweaver: the run was ended on all ranks: |cannot |'out/segments/|.part'|File too large|Check the folder, its permissions and the free space."
      "GONE=${folder}/segments/segment-000001.h5.part")
  endforeach()
  # One that is filled by others after the space was reserved.
  set(folder "${runs}/system.full_disk_in_a_flush.${tag}/out")
  full_disk_test(full_disk_in_a_flush.${tag} ${ranks} 2000: "write segment-000001.h5"
    "ERR=orbweaver: the run was ended on all ranks: flush 0 failed|cannot write /|'out/segments/segment-000001.h5.part'|the free space."
    "GONE=${folder}/segments/segment-000001.h5.part")
  set(folder "${runs}/system.full_disk_at_the_end.${tag}/out")
  full_disk_test(full_disk_at_the_end.${tag} ${ranks} 1800000: "publish segment-000001.h5"
    "ERR=cannot reserve disk space for 'out/atlas.h5.part'|File too large|the free space"
    "HAS=${folder}/segments/segment-000001.h5" "GONE=${folder}/atlas.h5")
endforeach()

# A survey ended by a full disk after two flushes is resumed, whole or with a file of it damaged: it comes to the archive of an
# undisturbed one, or is refused and stays as it was.
set(broken "${runs}/system.broken_off")
full_disk_test(broken_off 2 20000: "write segment-000003.h5" "ERR=File too large|the free space" "HAS=${broken}/out/segments/checkpoint.previous"
  "GONE=${broken}/out/atlas.h5")
set(whole "${runs}/system.not_broken_off/out")
system_test(not_broken_off 1 0 "OUT=4 families" "FRESH=${whole}" survey "${fine_scene}" -o out ${coarse})
set_tests_properties(system.broken_off system.not_broken_off PROPERTIES FIXTURES_SETUP broken_off)
foreach(case IN ITEMS as_it_is part_files torn_last_segment deleted_last_segment torn_journal torn_checkpoint
    wrong_checksum torn_first_segment deleted_first_segment exchanged_segments deleted_payloads changed_payloads
    no_checksum_holds newer_version newer_previous link_to_itself
    folder other_scene narrower)
  orbweaver_add_ctest(system.damaged.${case} 2 system 180 "${CMAKE_CURRENT_SOURCE_DIR}/damaged.sh" ${case}
    $<TARGET_FILE:orbweaver> $<TARGET_FILE:compare_archives> "${broken}" "${whole}/atlas.h5" "${fine_scene}" ${coarse})
  set_tests_properties(system.damaged.${case} PROPERTIES FIXTURES_REQUIRED broken_off)
endforeach()

# Not a number, on the rank count that CMakeLists.txt leaves out.
set(folder "${runs}/system.overflow.ranks2/out")
system_test(overflow.ranks2 2 1 "OUT=failed: Equilibrium 1: | is not finite|archive: " "FRESH=${folder}" "HAS=${folder}/atlas.h5"
  survey "${scene}" -o out --set system.parameters.g=1e300)

# Ten times the orbits, no more memory: whoever kept the 34 MB of rows would need that much more.
foreach(ranks IN ITEMS 1 2)
  set(command "$<TARGET_FILE:orbweaver>" survey "${fine_scene}" -o out ${fine} --set limits.steps=100000
    --set output.flush_orbits=100 -q)
  if(ranks GREATER 1)
    set(command ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${command})
  endif()
  set(labels system)
  if(ranks EQUAL 1)
    list(APPEND labels long)
  endif()
  orbweaver_add_ctest(system.memory.ranks${ranks} ${ranks} "${labels}" 180
    "${CMAKE_CURRENT_SOURCE_DIR}/memory.sh" 20 ${command})
endforeach()
