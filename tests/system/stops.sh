#!/bin/bash
# Asks a survey to stop (signals to mpirun, to rank 0, to a worker; wall time), which must end with status 4 and how to go
# on (but SIGTERM to mpirun, which ends the job), and resumes it; the archive must be that of an undisturbed run.
# Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

# expect_stopped STATUS WHAT
expect_stopped() {
  [ "$1" = 4 ] || fail "$2: exit status $1 instead of 4"
  grep -q "the survey goes on, on any number of ranks, with" "$folder/log" || fail "$2: no word on how to go on"
  grep -q -- "--set .* --resume" "$folder/log" || fail "$2: settings are not told"
  [ -e "$folder/stopped/segments/checkpoint" ] || fail "$2: no checkpoint"
}

place="write segment-000002.h5"
for case in "TERM rank0" "USR1 mpirun" "USR1 worker" "INT rank0" "HUP rank0"; do
  read -r signal whom <<< "$case"
  rm -rf "$folder/stopped"
  : > "$folder/log"
  held 1 "$place" survey stopped 3 &
  job=$!
  wait_until_held $job
  case $whom in
    mpirun) victim=$(mpirun_of stopped) ;;
    rank0) victim=$(ranks_of stopped | head -1) ;;
    worker) victim=$(ranks_of stopped | tail -1) ;;
  esac
  kill -"$signal" "$victim"
  wait $job
  expect_stopped $? "$case"
  survey stopped 2 && fail "$case: begun without --resume on an unfinished survey"
  survey stopped 2 --resume || fail "$case: the resumed run failed"
  expect_same stopped
  echo "$case: stopped and resumed"
done

# Open MPI 4.1's mpirun answers SIGTERM by ending the job itself, with a status of its own; the last checkpoint stands.
rm -rf "$folder/stopped"
: > "$folder/log"
held 1 "$place" survey stopped 3 &
job=$!
wait_until_held $job
kill -TERM "$(mpirun_of stopped)"
wait $job
status=$?
wait_for_end stopped
[ $status = 1 ] || grep -q "mpirun did not end with its ranks" "$folder/log" ||
  fail "TERM mpirun: exit status $status instead of mpirun's 1"
[ -e "$folder/stopped/segments/checkpoint" ] || fail "TERM mpirun: no checkpoint"
[ -e "$folder/stopped/atlas.h5" ] && fail "TERM mpirun: an archive of a survey that was ended"
survey stopped 2 --resume || fail "TERM mpirun: the resumed run failed"
expect_same stopped
echo "TERM mpirun: ended and resumed"

rm -rf "$folder/stopped"
: > "$folder/log"
held 1 "$place" survey stopped 2 --walltime 0:0.8
expect_stopped $? "--walltime"
mpirun -n 2 "$program" consolidate "$folder/stopped" >> "$folder/log" 2>&1
[ $? = 4 ] || fail "consolidate must end as the survey that it is of"
"$program" show "$folder/stopped/atlas.h5" families >> "$folder/log" || fail "the archive of a part cannot be shown"
survey stopped 2 --resume || fail "--walltime: the resumed run failed"
expect_same stopped
echo "--walltime: stopped, consolidated, resumed"

rm -rf "$folder/stopped"
: > "$folder/log"
held 1 "$place" survey stopped 1 &
job=$!
wait_until_held $job
kill -INT "$(ranks_of stopped | head -1)"
kill -INT "$(ranks_of stopped | head -1)" 2> /dev/null
wait $job
[ $? = 4 ] && echo "the second SIGINT came too late to be tested"
survey stopped 1 --resume || fail "after two SIGINT: the resumed run failed"
expect_same stopped
echo "two SIGINT: ended and resumed"
