# The scenes that no other file runs on several ranks, in short forms: the same archive on 1, 2 and 3 ranks.
set(short.henon_heiles)
set(short.swinging_spring --set "limits.energy=[-.inf,-0.9]")
set(short.pcr3bp_earth_moon --set "starts.fixed_points.grid=[[0.488],[0.866]]" --set "starts.fixed_points.names={}"
  --set "starts.fixed_points.letters={}" --set "starts.sweep.period=[6,7]" --set survey.depth=1)
set(short.pcr3bp_mu_0.001 --set "starts.fixed_points.grid=[[0.499],[0.866]]" --set "starts.sweep.period=[6.2,6.5]"
  --set starts.sweep.step=0.01 --set survey.depth=0 --set survey.subharmonics=1)
set(short.double_pendulum_half_degree --set limits.period=8.5 --set continuation.step=2deg)
set(short.double_pendulum_deep --set limits.period=9.5 --set survey.depth=1)
set(says.henon_heiles "8 families, 8 crossings, ")
set(says.swinging_spring "9 families, 3 crossings, ")
set(says.pcr3bp_earth_moon "2 families, 10 crossings, ")
set(says.pcr3bp_mu_0.001 "1 families, 0 crossings, ")
set(says.double_pendulum_half_degree "4 families, 5 crossings, ")
set(says.double_pendulum_deep "7 families, 14 crossings, ")
foreach(name IN ITEMS henon_heiles swinging_spring pcr3bp_earth_moon pcr3bp_mu_0.001 double_pendulum_half_degree
    double_pendulum_deep)
  same_on_ranks(${name} RANKS 1 2 3 SCENE "${PROJECT_SOURCE_DIR}/drivers/scenes/${name}.yaml" SAYS "${says.${name}}"
    OPTIONS ${short.${name}})
endforeach()
