#!/bin/bash
# Asks surveys that are within one long piece of work to stop: a sweep of a million periods.
# Status and checkpoint must be there within 2 s (3 s under mpirun). Arguments: those of survey_runs.sh, the first option being how often.
. "$(dirname "$0")/survey_runs.sh"
times=${options[0]}
begin_anew
RANDOM=7
sweep=(--set "starts.sweep.period=[1, 20]" --set starts.sweep.step=2e-5 --set survey.depth=0)
longest=0
for ((n = 0; n < times; n++)); do
  for kind in sweep; do
    for ranks in 1 2; do
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
      sleep 0.$((RANDOM % 10))
      began=$(milliseconds)
      kill -$signal "$(ranks_of $kind | tail -1)"
      wait $job
      status=$?
      took=$(($(milliseconds) - began))
      [ $status = 4 ] || fail "$kind on $ranks ranks, SIG$signal: status $status instead of 4 after $took ms"
      ((took <= longest)) || longest=$took
      # mpirun takes a second itself to end
      ((took < 1000 + 1000 * ranks)) || fail "$kind on $ranks ranks, SIG$signal: $took ms"
    done
  done
done
echo "$((2 * times)) stops, the longest took $longest ms"
