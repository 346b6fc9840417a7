#!/usr/bin/env bash
# ranks.sh PROGRAM SCENE: `--ranks` starts ranks by mpirun. A status other than 0 is followed by nothing of mpirun's, a signal reaches the
# ranks by its own name, and what has ended a rank is told.
set -euo pipefail
program=$1 scene=$2
quick=(--set limits.period=8.5 --set starts.sweep.step=0.1 --set survey.depth=0)
fail() { echo "ranks.sh: $*" >&2; exit 1; }
has() { grep -qF -- "$2" "$1" || fail "$1 lacks '$2': $(tail -5 "$1")"; }
lacks() { ! grep -qF -- "$2" "$1" || fail "$1 has '$2': $(grep -F -- "$2" "$1" | head -3)"; }

rm -rf out
status=0
"$program" --ranks 2 survey "$scene" -o out --set limits.families=1 "${quick[@]}" -- -collocation_tao_gatol 1e-30 -collocation_rounding 1e-30 >missed.txt 2>&1 || status=$?
((status == 1)) || fail "a missed goal: status $status: $(tail -3 missed.txt)"
has missed.txt '1 failed'
lacks missed.txt mpirun
lacks missed.txt -----

status=0
mpirun -n 2 "$program" survey "$scene" -o out --set nothing=1 >plain.txt 2>&1 || status=$?
((status == 2)) || fail "under mpirun: status $status: $(tail -3 plain.txt)"
has plain.txt 'orbweaver: lines of mpirun may follow that say no more: `orbweaver --ranks N ...`'
has plain.txt -----

# Signals: SIGINT stops a survey so that it can be resumed; a rank that is killed is told.
survey_in_background() {
  rm -rf out background.txt  # the one before says the same
  "$program" --ranks 2 survey "$scene" -o out >background.txt 2>&1 &
  launcher=$!
  for ((n = 0; n < 600; ++n)); do
    ! grep -qs 'In-Phase .* orbits' background.txt || return 0
    sleep 0.1
  done
  fail "no progress: $(cat background.txt)"
}
for signal in INT HUP; do
  survey_in_background
  status=0
  kill -$signal $launcher
  wait $launcher || status=$?
  ((status == 4)) || fail "SIG$signal: status $status: $(tail -3 background.txt)"
  has background.txt "stopped by SIG$signal; the survey goes on"
  lacks background.txt mpirun
done
# The second SIGINT ends all at once, with the status of the signal. The ranks stand still meanwhile, so that the first does not.
rm -rf out background.txt
ORBWEAVER_PAUSE_AT="write segment-000001.h5" ORBWEAVER_PAUSE_SECONDS=60 "$program" --ranks 2 survey "$scene" -o out >background.txt 2>&1 &
launcher=$!
for ((n = 0; n < 600; ++n)); do
  ! grep -qs 'paused at' background.txt || break
  sleep 0.1
done
status=0
kill -INT $launcher
sleep 1
kill -INT $launcher
SECONDS=0
wait $launcher || status=$?
((status == 130)) || fail "two SIGINT: status $status: $(tail -3 background.txt)"
((SECONDS < 10)) || fail "two SIGINT: $SECONDS s"
for ((n = 0; n < 100; ++n)); do
  pgrep -f -- "^$program survey $scene -o out\$" >/dev/null || break
  sleep 0.1
done
((n < 100)) || fail "two SIGINT: a rank goes on"
survey_in_background
status=0
kill -KILL "$(pgrep -P "$(pgrep -P $launcher)" | tail -1)"
wait $launcher || status=$?
((status == 3)) || fail "a killed rank: status $status: $(tail -3 background.txt)"
has background.txt 'orbweaver: signal 9 (Killed) has ended a rank'
status=0
PATH=$PWD/nothing "$program" --ranks 2 survey "$scene" -o nowhere >no_mpirun.txt 2>&1 || status=$?
((status == 3)) && grep -q 'install it (Debian: openmpi-bin)' no_mpirun.txt || fail "without mpirun: status $status: $(cat no_mpirun.txt)"
status=0
"$program" --ranks 2 systems >no_ranks.txt 2>&1 || status=$?
((status == 2)) && grep -q 'systems runs on one rank' no_ranks.txt || fail "systems on ranks: status $status: $(cat no_ranks.txt)"
