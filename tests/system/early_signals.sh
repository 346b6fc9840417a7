#!/bin/bash
# Signals that come while the program starts are kept: the survey ends with status 4 and goes on. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew

# Whether a process is the program, no longer the shell that begins it, and blocks or catches SIGTERM, as the program does from its first
# line on; until then its shared libraries are loaded.
keeps_signals() {
  local blocked caught
  [ "$(readlink -f "/proc/$1/exe" 2> /dev/null)" = "$(readlink -f "$program")" ] || return 1
  blocked=$(sed -n 's/^SigBlk:\t*//p' "/proc/$1/status" 2> /dev/null)
  caught=$(sed -n 's/^SigCgt:\t*//p' "/proc/$1/status" 2> /dev/null)
  [ -n "$blocked" ] && [ -n "$caught" ] && (((0x$blocked | 0x$caught) & 0x4000))
}

early=0
for signal in TERM USR1 INT; do
  for delay in 0 0.05 0.1 0.2 0.3; do
    rm -rf "$folder/early"
    # MPI takes some 0.3 s to start.
    ORBWEAVER_PAUSE_AT="write segment-000001.h5" ORBWEAVER_PAUSE_SECONDS=0.5 \
      "$program" survey "$scene" -o "$folder/early" --quiet "${options[@]}" >> "$folder/log" 2>&1 &
    job=$!
    until keeps_signals $job; do
      kill -0 $job 2> /dev/null || fail "the survey ended before it was asked to stop"
      sleep 0.01
    done
    sleep $delay
    [ -e "$folder/early/segments" ] || early=$((early + 1))
    kill -$signal $job
    wait $job
    status=$?
    [ $status = 4 ] || fail "SIG$signal after $delay s: status $status instead of 4"
  done
done
((early > 0)) || fail "no signal came before the survey had begun"
survey early 1 --resume || fail "the resumed run failed"
echo "$early signals came before the survey had begun"
