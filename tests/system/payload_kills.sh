#!/bin/bash
# Kills a survey that has ended while it moves the payloads that wider limits may ask for; with those limits it must come to the
# archive that they give at once. Arguments: those of survey_runs.sh, with the wide limits.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

narrow=(--set limits.period=17)
ranks=1
for place in "count on moved payloads" "count on moved payloads alone" "remove payloads"; do
  rm -rf "$folder/killed"
  : > "$folder/log"
  held 600 "$place" survey killed $((ranks % 3 + 1)) "${narrow[@]}" &
  job=$!
  wait_until_held $job
  kill -9 "$(ranks_of killed | head -1)"
  wait $job
  wait_for_end killed
  survey killed $ranks "${narrow[@]}" --resume || fail "$place: the finished survey was not accepted"
  "$compare" "$folder/whole/atlas.h5" "$folder/killed/atlas.h5" > /dev/null 2>&1 && fail "$place: the narrow limits cut nothing off"
  survey killed $((ranks % 3 + 1)) --resume || fail "$place: the resume with wider limits failed"
  expect_same killed
  echo "killed at \"$place\", resumed with wider limits"
  ranks=$((ranks + 1))
done
