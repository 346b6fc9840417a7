#!/bin/bash
# Signals that come while the program starts are kept: the survey ends with status 4 and goes on. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew

# Whether a process is the program, no longer the shell that begins it, and blocks or catches SIGTERM, as the program does from its first
# line on; until then its shared libraries are loaded. No other process is begun to see it: the program starts in 0.1 s.
keeps_signals() {
  local name value rest kept=0
  [ "/proc/$1/exe" -ef "$program" ] || return 1
  while read -r name value rest; do
    case $name in SigBlk: | SigCgt:) kept=$((kept | 0x$value)) ;; esac
  done 2> /dev/null < "/proc/$1/status"
  ((kept & 0x4000))
}

# stopped SIGNAL WHEN COMMAND ...: begins a survey that stands still at $place, has COMMAND wait for the moment, sends
# the signal and expects status 4.
stopped() {
  rm -rf "$folder/early"
  : > "$folder/log"
  ORBWEAVER_PAUSE_AT=$place ORBWEAVER_PAUSE_SECONDS=0.5 \
    "$program" survey "$scene" -o "$folder/early" --quiet "${options[@]}" >> "$folder/log" 2>&1 &
  job=$!
  "${@:3}"
  [ -e "$folder/early/segments" ] || early=$((early + 1))
  kill -"$1" $job
  wait $job
  local status=$?
  [ $status = 4 ] || fail "SIG$1 $2: status $status instead of 4"
}
wait_at_place() {
  wait_until_held $job
}
wait_from_first_line() {
  until keeps_signals $job; do
    kill -0 $job 2> /dev/null || fail "the survey ended before it was asked to stop"
    sleep 0.002
  done
  sleep "$1"
}

for signal in TERM USR1 INT HUP; do
  # Before MPI starts, and when it has, the survey has not begun, however fast the machine.
  early=0
  for place in "begin" "begin survey"; do
    stopped $signal "at \`$place\`" wait_at_place
  done
  [ $early = 2 ] || fail "SIG$signal: the survey had begun before it was asked to stop"
  # MPI takes some 0.1 s to start: while it does, and after.
  place="write segment-000001.h5"
  for delay in 0 0.02 0.04 0.06 0.3; do
    stopped $signal "after $delay s" wait_from_first_line $delay
  done
done
survey early 1 --resume || fail "the resumed run failed"
