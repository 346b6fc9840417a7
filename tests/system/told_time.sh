#!/usr/bin/env bash
# told_time.sh PROGRAM SCENE: the time that a survey tells has what it took before its first task in it: here it stands still for 3 s.
set -euo pipefail
rm -rf out
ORBWEAVER_PAUSE_AT="the choice of scales" ORBWEAVER_PAUSE_SECONDS=3 "$1" survey "$2" -o out \
  --set limits.period=8.5 --set starts.sweep.step=0.1 --set survey.depth=0 >out.txt 2>&1
seconds=$(sed -n 's/^.* orbits, 0 failed, \([0-9]*\)\.[0-9]* s; peak memory.*$/\1/p' out.txt)
[ "${seconds:-0}" -ge 3 ] || { echo "told_time.sh: ${seconds:-nothing} s is told of a survey that took more than 3 s: $(cat out.txt)" >&2; exit 1; }
