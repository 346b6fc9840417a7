#!/bin/bash
# changed_bytes.sh PROGRAM ATLAS COPIES: verifies the atlas, which must hold, and copies of it that have one byte changed each, at places
# drawn with a fixed seed: each must be found, with status 1 and the row named, or, where it is HDF5's own, with status 2.
set -eu
program=$1 atlas=$2 copies=$3

fail() {
  echo "changed_bytes.sh: $*" >&2
  exit 1
}
"$program" verify "$atlas" > whole.txt || fail "the archive itself does not hold: $(cat whole.txt)"

RANDOM=13
bytes=$(stat -c %s "$atlas")
rows=0 files=0
for ((n = 0; n < copies; n++)); do
  cp "$atlas" changed.h5
  at=$(((RANDOM * 32768 + RANDOM) % bytes))
  old=$(od -An -tu1 -j $at -N 1 changed.h5 | tr -d ' ')
  new=$(((old + 1 + RANDOM % 255) % 256))
  printf "%b" "\\0$(printf %o $new)" | dd of=changed.h5 bs=1 seek=$at conv=notrunc status=none
  cmp -s "$atlas" changed.h5 && fail "byte $at was not changed"
  status=0
  "$program" verify changed.h5 > found.txt 2>&1 || status=$?
  case $status in
    1)
      grep -Eq '^/[a-z_/]+ row [0-9]+: ' found.txt || fail "byte $at ($old to $new): no row is named: $(cat found.txt)"
      rows=$((rows + 1))
      ;;
    2) files=$((files + 1)) ;;
    *) fail "byte $at ($old to $new): status $status: $(cat found.txt)" ;;
  esac
done
"$program" verify "$atlas" > whole.txt || fail "the archive itself does not hold any more"
echo "$copies copies with one changed byte each: $rows found by a row's checksum, $files by HDF5 or the header; none missed, the archive itself holds"
