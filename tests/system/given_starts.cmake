# Surveys from given orbits in a short form: the same archive on 1, 2 and 3 ranks, and after kills.
set(of_pendulum "${scene}")
# Rotations of the outer rod and of both; two more states lie on the first family, one of them as its mirror image.
set(short.rotations --set "limits.energy=[15,40]" --set "starts.fixed_points.grid=[]" --set survey.subharmonics=1
  --set "starts.states=[@STATES@]")
set(says.rotations "2 families, |starts.states, entry 2: |starts.states, entry 4: |lies on Outer")
set(short.recurrences --set starts.recurrences.time=600 --set starts.recurrences.tolerance=0.2 --set starts.recurrences.most=4)
set(says.recurrences "4 families, |starts.recurrences: ")
foreach(name IN ITEMS rotations recurrences)
  set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/${name}.yaml")
  set(archives "")
  set(required "")
  foreach(ranks IN ITEMS 1 2 3)
    set(folder "${runs}/system.${name}.ranks${ranks}/out")
    system_test(${name}.ranks${ranks} ${ranks} 0 "OUT=${says.${name}}|0 contradictions|, 0 failed|archive: " "FRESH=${folder}"
      "HAS=${folder}/atlas.h5" survey "${scene}" -o out ${short.${name}})
    set_tests_properties(system.${name}.ranks${ranks} PROPERTIES FIXTURES_SETUP "${name}${ranks}")
    list(APPEND archives "${folder}/atlas.h5")
    list(APPEND required "${name}${ranks}")
  endforeach()
  orbweaver_add_ctest(system.${name}.same_archive 1 system 60 $<TARGET_FILE:compare_archives> ${archives})
  set_tests_properties(system.${name}.same_archive PROPERTIES FIXTURES_REQUIRED "${required}")
  broken_off_test(${name}.kills system 300 kills.sh 3 1 -- ${short.${name}} --set output.flush_seconds=0.1
    --set output.flush_orbits=5)
endforeach()
set(scene "${of_pendulum}")
