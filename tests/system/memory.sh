#!/usr/bin/env bash
# memory.sh MEBIBYTES COMMAND...: COMMAND is a survey but for its step. Fails if any rank's peak memory is more than MEBIBYTES
# larger with a tenth of the step, and so ten times the orbits: then somebody keeps rows that were flushed.
set -eu
allowed=$1
shift
run() {
  rm -rf out
  "$@" | tee /dev/stderr | sed -n 's/^.* \([0-9]*\) orbits, 0 failed.*peak memory per rank: \([0-9 ]*\) MiB$/\1 \2/p'
}
read -r few short <<<"$(run "$@" --set continuation.step=1deg)"
read -r many long <<<"$(run "$@" --set continuation.step=0.1deg)"
read -ra before <<<"$short"
read -ra after <<<"$long"
((many > 9 * few)) || { echo "memory.sh: $many orbits are not about ten times $few" >&2; exit 1; }
bytes=$(stat -c %s out/atlas.h5)
((bytes / 1048576 > 3 * allowed / 2)) || { echo "memory.sh: the archive is too small to tell" >&2; exit 1; }
for rank in "${!before[@]}"; do
  echo "rank $rank: ${before[rank]} MiB with $few orbits, ${after[rank]} MiB with $many" >&2
  ((after[rank] - before[rank] <= allowed)) || { echo "memory.sh: more than $allowed MiB more" >&2; exit 1; }
done
