#!/bin/bash
# Kills a survey while it stands still at every place of a flush where something is half done, and resumes it; the archive
# must be that of an undisturbed run. Arguments: ROUNDS, then those of survey_runs.sh.
rounds=$1
shift
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

places=("write segment-000001.h5" "publish segment-000002.h5" "publish journal-000001" "replace checkpoint" "publish atlas.h5"
  "store a payload" "sync payloads" "publish checkpoint" "publish segment-000001.h5" "write segment-000002.h5" "publish journal-000002" "write segment-000003.h5")
for ((round = 0; round < rounds; ++round)); do
  place=${places[round % ${#places[@]}]}
  rm -rf "$folder/killed"
  ranks=$((round % 3 + 1))
  : > "$folder/log"
  ORBWEAVER_PAUSE_AT=$place ORBWEAVER_PAUSE_SECONDS=600 survey killed "$ranks" --resume &
  job=$!
  until grep -q "paused at $place" "$folder/log"; do
    kill -0 $job 2> /dev/null || fail "$place: the run ended without coming there"
    sleep 0.02
  done
  kill -9 "$(ranks_of killed | head -1)"
  wait $job
  wait_for_end killed
  survey killed $((round % 4 + 1)) --resume || fail "$place: the resumed run failed"
  expect_same killed
  echo "round $((round + 1)): killed at \"$place\" on $ranks ranks, resumed"
done
echo "$rounds of $rounds: a flush that is cut off anywhere leaves a state to go on from"
