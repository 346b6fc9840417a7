#!/usr/bin/env bash
# address_space.sh PROGRAM SCENE: under `ulimit -v` and `-d` that are too small for the program, `check` and `survey` end with status 3 and
# the number needed, which is enough; nothing goes on for ever.
set -uo pipefail
program=$1 scene=$2
quick=(--set limits.period=8.5 --set starts.sweep.step=0.1 --set survey.depth=0 -q)
fail() { echo "address_space.sh: $*" >&2; exit 1; }

# limited OPTION KIBIBYTES COMMAND...
limited() {
  rm -rf out
  (ulimit "$1" "$2" && exec timeout -k 1 60 "${@:3}" >out.txt 2>&1)
}
for option in -v -d; do
  # Refused before MPI starts; then where MPI has taken what there was, under mpirun, where ranks share memory.
  smaller=(200000 300000 400000)
  [ $option = -v ] || smaller=(20000 100000 140000)
  for kibibytes in "${smaller[@]}"; do
    for command in "check $scene" "survey $scene -o out"; do
      limited $option "$kibibytes" "$program" $command
      status=$?
      [ $status = 3 ] || fail "$command under ulimit $option $kibibytes: status $status: $(tail -3 out.txt)"
      needed=$(sed -n "s/.*expected \`ulimit $option \([0-9]*\)\` (KiB) or more, got $kibibytes.*/\1/p" out.txt)
      [ -n "$needed" ] || fail "$command under ulimit $option $kibibytes says: $(cat out.txt)"
    done
  done
  limited $option $((needed + 60000)) "$program" survey "$scene" -o out "${quick[@]}" ||
    fail "the survey ends with $? under ulimit $option $((needed + 60000)), which is said to be enough: $(tail -3 out.txt)"
done
limited -v 440000 mpirun -n 2 "$program" survey "$scene" -o out "${quick[@]}"
status=$?
if [ $status != 0 ]; then
  [ $status = 3 ] || fail "two ranks: status $status: $(tail -3 out.txt)"
  grep -q 'expected `ulimit -v [0-9]*` (KiB) or more, got 440000' out.txt || fail "two ranks: $(cat out.txt)"
fi
