#!/bin/bash
# Asks surveys that are within one long piece of work to stop: a sweep of a million periods, and corrections with 100,000 harmonics.
# Status and checkpoint must be there within 2 s. Arguments: those of survey_runs.sh, the first option being how often.
. "$(dirname "$0")/survey_runs.sh"
times=${options[0]}
begin_anew
RANDOM=7
sweep=(--set "starts.sweep.period=[1, 20]" --set starts.sweep.step=2e-5 --set survey.depth=0)
harmonics=(--set "continuation.cutoff=[100000, 100000]" --set limits.period=12)
longest=0
for ((n = 0; n < times; n++)); do
  for kind in sweep harmonics; do
    for ranks in 1 2; do
      signal=$([ $((RANDOM % 2)) = 0 ] && echo TERM || echo USR1)
      rm -rf "$folder/$kind"
      : > "$folder/log"
      declare -n words=$kind
      options=("${words[@]}")
      survey $kind $ranks &
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
      # mpirun takes a while itself to end
      ((took < 2000)) || fail "$kind on $ranks ranks, SIG$signal: $took ms"
    done
  done
done
echo "$((4 * times)) stops, the longest took $longest ms"
