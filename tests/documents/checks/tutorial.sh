# Sourced by follow.sh: what docs/tutorial.md says was found.
expect '^  ID1b +period-doubling T 8.44293, m 2 '
expect '^ +RS@0; stable; ended: joined In-Phase at T = 17.33593865'
expect '^  0  In-Phase +8.442930705 +-2.325057314 +period-doubling +2  4  1 +2 .* ID1a, ID1b  -$'
expect '^  1  In-Phase .* -  +ID1a, ID1b$'
expect '^In-Phase .* joined Out-Phase at T = 8.50564.*3 times around'
expect '^  2  Doubled  17.58349622  1.488626556  period-doubling '
expect 'met a family of more symmetry \(T = 16.965135, m2 = 0.99234'
expect '^undecided: Doubled: ends on a family of more symmetry that this survey does not have'
expect ': all hold'
[[ -s tree.png && -s double_pendulum.html ]] || [[ "$ran_commands" != *plot* || "$ran_commands" != *page* ]] || fail "no picture, or no page"
