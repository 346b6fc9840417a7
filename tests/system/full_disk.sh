#!/usr/bin/env bash
# full_disk.sh LIMIT PLACE COMMAND...: runs COMMAND, a survey into ./out, alone or under mpirun. From where it first comes to PLACE
# (core::pause_point) no process of it can write a file beyond LIMIT bytes (`N:`, or `N:N` where it may not raise the limit itself).
# Exits with the status of COMMAND.
set -u
limit=$1
place=$2
shift 2
rm -rf out
: > errors
ORBWEAVER_PAUSE_AT=$place ORBWEAVER_PAUSE_SECONDS=1 "$@" 2> errors &
pid=$!
until grep -q "paused at" errors; do
  kill -0 "$pid" 2> /dev/null || break
  sleep 0.01
done
for process in "$pid" $(pgrep -P "$pid"); do
  prlimit --pid "$process" --fsize="$limit" || kill "$pid"
done
wait "$pid"
status=$?
cat errors >&2
exit $status
