#!/bin/bash
# Asks surveys to stop at random moments of long work: a sweep of a million periods, steps with 100,000 harmonics, locations with as
# many, and full certificates of such orbits. Status and checkpoint must be there within 2 s (3 s under mpirun).
# Arguments: those of survey_runs.sh, the first option being how often.
. "$(dirname "$0")/survey_runs.sh"
times=${options[0]}
begin_anew
RANDOM=7
harmonics=(--set "continuation.cutoff=[100000, 100000]" --set starts.sweep.step=1)
sweep=(--set "starts.sweep.period=[1, 20]" --set starts.sweep.step=2e-5 --set survey.depth=0)
steps=("${harmonics[@]}" --set survey.depth=0)
locations=("${harmonics[@]}" --set limits.period=8.6 --set "starts.fixed_points.grid=[[0], [0]]" --set survey.depth=2)
certificates=("${harmonics[@]}" --set limits.steps=4 --set compute.certificate=full)
# Milliseconds behind the first checkpoint in which the work is under way on one rank; a machine that is loaded has more of it.
declare -A lasts=([sweep]=1000 [steps]=8000 [locations]=8000 [certificates]=6000)
longest=0 stopped=0 ended=0
for ((n = 0; n < times; n++)); do
  for kind in sweep steps locations certificates; do
    ranks=$((1 + (n + stopped + ended) % 2))
    signal=$([ $((RANDOM % 2)) = 0 ] && echo TERM || echo USR1)
    rm -rf "$folder/$kind"
    : > "$folder/log"
    declare -n words=$kind
    options=("${words[@]}")
    if [ $ranks = 1 ]; then
      "$program" survey "$scene" -o "$folder/$kind" --quiet "${options[@]}" >> "$folder/log" 2>&1 &
    else
      survey $kind $ranks &
    fi
    job=$!
    until [ -e "$folder/$kind/segments/checkpoint" ]; do sleep 0.02; done
    delay=$((RANDOM % lasts[$kind]))
    sleep $((delay / 1000)).$(printf '%03d' $((delay % 1000)))
    began=$(milliseconds)
    victim=$(ranks_of $kind | tail -1)
    [ -n "$victim" ] && kill -$signal "$victim" 2> /dev/null
    wait $job
    status=$?
    took=$(($(milliseconds) - began))
    # One that is through, or within the last lines of its summary, has nothing to stop.
    if [ $status = 0 ]; then
      ended=$((ended + 1))
      continue
    fi
    [ $status = 4 ] || fail "$kind on $ranks ranks, SIG$signal after $delay ms: status $status instead of 4 after $took ms"
    [ -e "$folder/$kind/segments/checkpoint" ] || fail "$kind on $ranks ranks, SIG$signal after $delay ms: no checkpoint"
    ((took <= longest)) || longest=$took
    # mpirun takes a second itself to end
    ((took < 1000 + 1000 * ranks)) || fail "$kind on $ranks ranks, SIG$signal after $delay ms: $took ms"
    stopped=$((stopped + 1))
  done
done
((stopped > ended)) || fail "$ended of $((stopped + ended)) surveys had ended before they were asked to stop"
echo "$stopped stops, the longest took $longest ms; $ended surveys had ended before"
