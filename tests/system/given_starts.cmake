# Surveys from given orbits in a short form: the same archive on 1, 2 and 3 ranks, and after kills.
set(of_pendulum "${scene}")
# The first two states lie on the family of the fourth, whose winding numbers come first.
string(CONCAT states "[{state: [0, 0, -5.0444829, 9.5780458], period: 0.8211037}, "
  "{state: [0, 180, 4.2829949, 9.7374310], period: 0.7692796}, {state: [0, 0, 8.1215228, -8.3236785], period: 0.9913897}, "
  "{state: [0, 180, -3.9008232, -8.8543736], period: 0.8430239, name: Outer}, "
  "{state: [0, 180, 7.8737448, 7.8093862], period: 0.8114095}]")
set(short.rotations --set "limits.energy=[15,40]" --set "starts.fixed_points.grid=[[0],[0]]" --set survey.subharmonics=1
  --set "starts.states=${states}")
set(says.rotations "starts.states, entry 1: Orbit n(0,1) T=0.821104 E=20 lies on Outer, at T = 0.8211037|starts.states, entry 2: Orbit n(0,1) T=0.76928 E=23.0475 lies on Outer|5 families (2 of them left out by limits), ")
set(short.recurrences --set starts.recurrences.time=400 --set starts.recurrences.tolerance=0.2 --set starts.recurrences.most=3)
set(says.recurrences "3 families, |starts.recurrences: ")
foreach(name IN ITEMS rotations recurrences)
  set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/${name}.yaml")
  same_on_ranks(${name} RANKS 1 2 3 SCENE "${scene}" SAYS "${says.${name}}" OPTIONS ${short.${name}})
  broken_off_test(${name}.kills system 300 kills.sh 2 1 -- ${short.${name}} --set output.flush_seconds=0.1
    --set output.flush_orbits=5)
endforeach()
# With two steps none of these families passes another's start: what they pass when they go on is left out as well.
set(folder "${runs}/system.rotations.few_steps/out")
set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/rotations.yaml")
system_test(rotations.few_steps 2 0 "OUT=7 families (2 of them left out by limits), |0 contradictions" "FRESH=${folder}"
  "HAS=${folder}/atlas.h5" survey "${scene}" -o out ${short.rotations} --set limits.steps=2)
system_test(rotations.more_steps 3 0 "OUT=${says.rotations}|0 contradictions|, 0 failed" survey "${scene}" -o "${folder}" --resume
  ${short.rotations})
orbweaver_add_ctest(system.rotations.same_after_more_steps 1 system 60 $<TARGET_FILE:compare_archives>
  "${runs}/system.rotations.ranks1/out/atlas.h5" "${folder}/atlas.h5")
set_tests_properties(system.rotations.few_steps PROPERTIES FIXTURES_SETUP rotations.few_steps)
set_tests_properties(system.rotations.more_steps PROPERTIES FIXTURES_REQUIRED rotations.few_steps FIXTURES_SETUP rotations.more_steps)
set_tests_properties(system.rotations.same_after_more_steps PROPERTIES FIXTURES_REQUIRED "rotations1;rotations.more_steps")
set(scene "${of_pendulum}")
# The chain and the figure-eight in short forms, of a chain of four links its modes: the same archive on 1, 2 and 3 ranks, and with the long
# tests after kills.
set(short.chain --set system.parameters.links=4 --set "starts.sweep.period=[1.5,12]" --set "limits.energy=[-.inf,-9.5]")
set(says.chain "4 families, 10 crossings, ")
set(short.three_bodies_figure_eight --set "limits.parameter=[0.9995,1.001]")
set(says.three_bodies_figure_eight "2 families, 2 crossings|  Eight B ")
foreach(name IN ITEMS chain three_bodies_figure_eight)
  set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/${name}.yaml")
  same_on_ranks(${name} RANKS 1 2 3 SCENE "${scene}" SAYS "${says.${name}}" OPTIONS ${short.${name}})
  broken_off_test(${name}.kills "system;long" 600 kills.sh 5 1 -- ${short.${name}} --set output.flush_seconds=0.1
    --set output.flush_orbits=5)
endforeach()
set(scene "${of_pendulum}")
