#!/bin/bash
# A stop that comes while a checkpoint is written waits for that one: what it holds is not written a second time. Each is held for some
# seconds, as a large one takes. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
paused() { grep -c "paused at publish checkpoint" "$folder/log"; }
# One rank and no mpirun, which takes its own time to end.
ORBWEAVER_PAUSE_AT="publish checkpoint" ORBWEAVER_PAUSE_SECONDS=2 \
  "$program" survey "$scene" -o "$folder/stopped" --quiet "${options[@]}" >> "$folder/log" 2>&1 &
job=$!
until_is() {
  until "$@"; do
    kill -0 $job 2> /dev/null || fail "the survey ended before it came to $*"
    sleep 0.02
  done
}
# Rows are written before the checkpoint that lists them.
until_is [ -e "$folder/stopped/segments/segment-000001.h5" ]
before=$(paused)
one_more() { [ "$(paused)" -gt "$before" ]; }
until_is one_more
kill -TERM $job
wait $job
status=$?
[ $status = 4 ] || fail "status $status instead of 4"
[ "$(paused)" = $((before + 1)) ] || fail "$(paused) checkpoints were written instead of $((before + 1))"
"$program" survey "$scene" -o "$folder/stopped" --quiet --resume "${options[@]}" >> "$folder/log" 2>&1 || fail "it does not go on"
survey whole 1 || fail "the undisturbed run failed"
expect_same stopped
echo "one checkpoint was written behind the stop, and the survey went on from it"
