# Families in a parameter: the same archive on 1, 2 and 3 ranks and with vectors of any width, which is verified, and after kills.
foreach(name IN ITEMS van_der_pol lorenz duffing damped_driven_double_pendulum)
  set(short_form "")
  if(name STREQUAL van_der_pol)  # the whole, to mu = 1000, is below
    set(short_form --set "limits.parameter=[0.01,10]" --set compute.stability=true)
  elseif(name STREQUAL damped_driven_double_pendulum)  # the first doubling, and the torus point of the doubled family
    set(short_form --set survey.depth=1 --set "limits.parameter=[1.4115,1.4243]")
  endif()
  same_on_ranks(${name} RANKS 1 2 3 VECTORS 128 256 SCENE "${PROJECT_SOURCE_DIR}/drivers/scenes/${name}.yaml"
    OPTIONS ${short_form})
  system_test(${name}.verify 2 0 "OUT=section points|: all hold" verify "${runs}/system.${name}.ranks1/out/atlas.h5")
  set_tests_properties(system.${name}.verify PROPERTIES FIXTURES_REQUIRED "${name}1")
endforeach()
set(folder "${runs}/system.van_der_pol.whole/out")
system_test(van_der_pol.whole 2 0 "OUT=1 families|0 contradictions|, 0 failed" "FRESH=${folder}" "HAS=${folder}/atlas.h5"
  survey "${PROJECT_SOURCE_DIR}/drivers/scenes/van_der_pol.yaml" -o out)
system_test(van_der_pol.whole.verify 2 0 "OUT=all hold" verify "${folder}/atlas.h5")
set_tests_properties(system.van_der_pol.whole PROPERTIES FIXTURES_SETUP van_der_pol.whole LABELS "system;long" TIMEOUT 1200)
set_tests_properties(system.van_der_pol.whole.verify PROPERTIES FIXTURES_REQUIRED van_der_pol.whole LABELS "system;long" TIMEOUT 1200)
changed_bytes_test(lorenz.changed_bytes system "${runs}/system.lorenz.ranks1/out/atlas.h5" lorenz1 10)
system_test(lorenz.show 1 0 "OUT=rho          13.9266 .. 24.7356|Equilibrium 1, Hopf point 1|Equilibrium 3, Hopf point 1"
  show "${runs}/system.lorenz.ranks1/out/atlas.h5")
system_test(duffing.show_crossings 1 0 "OUT=drive_frequency|1.7797|fold-parameter"
  show "${runs}/system.duffing.ranks1/out/atlas.h5" crossings)
system_test(damped_driven_double_pendulum.show_crossings 1 0
  "OUT=Strong    6.981317008        1.421973053  period-doubling|Strong D  13.96263402        1.424088756  torus"
  show "${runs}/system.damped_driven_double_pendulum.ranks1/out/atlas.h5" crossings)
set_tests_properties(system.damped_driven_double_pendulum.show_crossings PROPERTIES
  FIXTURES_REQUIRED damped_driven_double_pendulum1)
set_tests_properties(system.lorenz.show PROPERTIES FIXTURES_REQUIRED lorenz1)
set_tests_properties(system.duffing.show_crossings PROPERTIES FIXTURES_REQUIRED duffing1)

# Orbits at a value of the parameter that moves, while the energy or T is held, to many digits: as many as the energy that was found has. Those expected are Duffing's in closed form:
# T = 4 K(m)/sqrt(alpha + x^2), m = x^2/(2 (alpha + x^2)), by arithmetic-geometric means.
foreach(hold IN ITEMS energy period)
  set(folder "${runs}/system.duffing.held_${hold}/out")
  system_test(duffing.held_${hold} 1 0 "OUT=Spring|0 failed" "FRESH=${folder}" survey "${PROJECT_SOURCE_DIR}/drivers/scenes/duffing.yaml" -o out
    --set "system={name: duffing, parameters: {alpha: 1, beta: 1}}" --set "continuation={free: alpha, hold: ${hold}}"
    --set "starts={states: [{state: [1, 0], period: 4.768, name: Spring}]}" --set "limits={parameter: [0.8, 2]}")
  set_tests_properties(system.duffing.held_${hold} PROPERTIES FIXTURES_SETUP duffing.held_${hold})
  if(hold STREQUAL energy)
    set(expected "energy             0.749999054442|period             4.34987783913|x(0)               0.889543153606")
  else()
    set(expected "held               alpha = 1.5, T = 4.76|energy             0.263063107755|x(0)               0.563214051618")
  endif()
  system_test(duffing.held_${hold}.refine 1 0 "OUT=${expected}" refine "${folder}/atlas.h5" Spring alpha=1.5 -n 25)
  set_tests_properties(system.duffing.held_${hold}.refine PROPERTIES FIXTURES_REQUIRED duffing.held_${hold})
endforeach()

set(of_pendulum "${scene}")
set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/lorenz.yaml")
broken_off_test(lorenz.kills "system;long" 300 kills.sh 3 1 -- --set output.flush_seconds=0.1 --set output.flush_orbits=5)
# A curve of torus points to a strong resonance, killed and resumed on its way.
set(scene "${PROJECT_SOURCE_DIR}/drivers/scenes/damped_driven_double_pendulum.yaml")
set(beside_torus "{state: [142.543227, 51.7950766, 0, 1.9202047, 793.885987], period: 13.962634015954636}")
broken_off_test(torus_loci.kills "system;long" 300 kills.sh 3 1 -- --set "starts={states: [${beside_torus}]}"
  --set system.parameters.torque1_amplitude=2.03960946 --set system.parameters.c1=0.4396474 --set survey.depth=0
  --set "limits.parameter=[2.03,2.041]" --set "loci=[{of: [torus], free: [c1], range: [0.435,0.445]}]"
  --set output.flush_seconds=0.1)
set(scene "${of_pendulum}")
