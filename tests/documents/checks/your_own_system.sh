# Sourced by follow.sh: what docs/your_own_system.md says was found.
expect '^ +coordinates +q1, q2, p1, p2$'
expect '^10 families'
orbweaver show out/atlas.h5 orbits --csv >orbits.csv
# In the first family both masses swing alike, to rounding, however far it has been followed: extrapolation multiplies what is not.
awk -F, 'NR == 1 {for (n = 1; n <= NF; ++n) at[$n] = n; next}
  $at["family"] == "Equilibrium 1, mode 1" || $at["family"] == 0 {
    apart = $at["state_q1"] - $at["state_q2"]; if (apart < 0) apart = -apart
    if (apart > 1e-14 * (1 + $at["state_q1"])) exit 1
    ++rows
  }
  END {exit rows < 20}' orbits.csv || fail "the masses do not swing alike: $(cut -d, -f1-6 orbits.csv | tail -3)"
expect '^Equilibrium 1, Hopf point 1 .* 9\.04369'
expect '^ +1 +6 +hopf +2 +1 +2 +elliptic +6\.283185307'
# A drive declares its half turn: nothing is missing, and the response turns twice.
orbweaver check response.yaml >checked.txt
! grep -q 'not declared' checked.txt || fail "check misses a symmetry: $(grep 'not declared' checked.txt)"
grep -q 'H: -x, -v, phase + 180 deg' checked.txt || fail "check does not know H: $(grep symmetries checked.txt)"
(($(orbweaver show out_response crossings --csv | grep -c fold-parameter) == 2)) || fail "the response does not turn twice"
expect '^ +terms +lattice; held: momentum = 0, from which p1 follows'
orbweaver check polar.yaml >checked.txt
grep -q '^  coordinates   r, pr$' checked.txt || fail "the angle is not left out: $(cat checked.txt)"
