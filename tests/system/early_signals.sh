#!/bin/bash
# Signals that come while the program starts are kept: the survey ends with status 4 and goes on. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
early=0
for signal in TERM USR1 INT; do
  for delay in 0.1 0.15 0.2 0.3 0.4; do
    rm -rf "$folder/early"
    # Its shared libraries take some 0.05 s to load, and MPI some 0.3 s to start.
    "$program" survey "$scene" -o "$folder/early" --quiet "${options[@]}" >> "$folder/log" 2>&1 &
    job=$!
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
