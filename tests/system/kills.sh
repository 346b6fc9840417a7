#!/bin/bash
# Kills a survey with SIGKILL at random moments (mpirun, rank 0 or a worker) and resumes it on 1 to 4 ranks, again and again;
# the archive must be that of an undisturbed run in every dataset. Arguments: KILLS SEED, then those of survey_runs.sh.
kills=$1
RANDOM=$2
shift 2
. "$(dirname "$0")/survey_runs.sh"
begin_anew

began=$(milliseconds)
survey whole 2 || fail "the undisturbed run failed"
lasted=$(($(milliseconds) - began))

killed=0 surveys=0
while [ "$killed" -lt "$kills" ]; do
  surveys=$((surveys + 1))
  rm -rf "$folder/killed"
  ended=no
  while [ "$ended" = no ]; do
    ranks=$((RANDOM % 4 + 1))
    survey killed "$ranks" --resume &
    job=$!
    if [ "$killed" -lt "$kills" ]; then
      after=$(((RANDOM * 32768 + RANDOM) % (lasted * 6 / 10) + 100))
      sleep "$((after / 1000)).$(printf '%03d' $((after % 1000)))"
      case $((RANDOM % 3)) in
        0) victim=$(mpirun_of killed) what=mpirun ;;
        1) victim=$(ranks_of killed | head -1) what="rank 0" ;;
        2) victim=$(ranks_of killed | tail -1) what="the last rank" ;;
      esac
      if [ -n "$victim" ] && kill -9 "$victim" 2> /dev/null; then
        killed=$((killed + 1))
        echo "kill $killed: $what of $ranks ranks after $after ms"
        wait $job
        wait_for_end killed
        continue
      fi
    fi
    wait $job || fail "a resumed run failed"
    ended=yes
  done
  expect_same killed
done
echo "$killed kills in $surveys surveys: every archive is that of the undisturbed run"
