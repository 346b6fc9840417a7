#!/bin/bash
# A survey whose work never returns, as a field may: a stop or limits.time ends it with status 3 and the work's name, and it goes on
# afterwards. The work stands still at a pause point for an hour. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

# hung NAME RANKS PLACE WORK [more options ...]: without options a signal stops it.
hung() {
  local name=$1 ranks=$2 place=$3 work=$4
  : > "$folder/$name.log"
  (
    log=$folder/$name.log
    ORBWEAVER_PAUSE_AT=$place ORBWEAVER_PAUSE_SECONDS=3600 mpirun -n "$ranks" \
      "$program" survey "$scene" -o "$folder/$name" --quiet "${options[@]}" "${@:5}" >> "$log" 2>&1 &
    job=$!
    for ((n = 0; n < 1200; ++n)); do
      ! grep -q "paused at" "$log" || break
      sleep 0.1
    done
    began=$(milliseconds)
    [ $# -gt 4 ] || kill -USR1 $job
    wait $job
    status=$?
    took=$(($(milliseconds) - began))
    [ $status = 3 ] || { echo "$name: status $status instead of 3"; tail -5 "$log"; exit 1; }
    grep -q "$work was asked to stop and has not come to an end of a step for 10 s" "$log" ||
      { echo "$name: its work is not named"; tail -5 "$log"; exit 1; }
    [ $took -lt 40000 ] || { echo "$name: ended after $took ms"; exit 1; }
    echo "$name: ended after $took ms"
  ) &
  jobs+=($!)
}
jobs=()
hung task1 1 "store a payload" "task .* on rank 0"
hung task2 2 "store a payload" "task .* on rank [01]"
hung starts 1 "the search for starts" "the search for starts"
hung scales 2 "the choice of scales" "the choice of scales"
hung timed 1 "store a payload" "task .* on rank 0" --set limits.time=8
hung timed_starts 1 "the search for starts" "the search for starts" --set limits.time=8
for job in "${jobs[@]}"; do wait "$job" || failed=1; done
[ -z "${failed:-}" ] || exit 1
for name in task1 task2 starts scales timed timed_starts; do
  survey $name 1 --resume || fail "$name: the resumed run failed"
  [[ $name == timed* ]] || expect_same $name  # the scene's text is another there
done
