#!/usr/bin/env bash
# full_disk.sh BYTES SEGMENTS COMMAND...: runs COMMAND, a survey into ./out, alone or under mpirun. Once SEGMENTS segments stand
# there with a checkpoint after them (0: once MPI has started), no process of it can write a file beyond BYTES. Exits with the
# status of COMMAND.
set -u
bytes=$1
segments=$2
shift 2
rm -rf out
# It stands still before the next one, however fast the machine.
if ((segments > 0)); then
  export ORBWEAVER_PAUSE_SECONDS=1
  ORBWEAVER_PAUSE_AT=$(printf 'write segment-%06d.h5' $((segments + 1)))
  export ORBWEAVER_PAUSE_AT
fi
"$@" &
pid=$!
written() { find out/segments -name 'segment-*.h5' ! -newer out/segments/checkpoint 2>/dev/null | wc -l; }
for ((i = 0; i < 4000; ++i)); do
  [[ -d out/segments && $(written) -ge $segments ]] && break
  kill -0 "$pid" 2>/dev/null || break
  sleep 0.01
done
for process in "$pid" $(pgrep -P "$pid"); do
  prlimit --pid "$process" --fsize="$bytes:" || kill "$pid"
done
wait "$pid"
