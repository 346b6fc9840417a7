#!/usr/bin/env bash
# readme_commands.sh README PROGRAM SCENE: runs every command of the README's table of programs, with each of its
# options once; commands marked "later" must be refused.
set -euo pipefail
readme=$1 program=$2 scene=$3
quick=(--set limits.period=8.5 --set starts.sweep.step=0.05 --set 'starts.sweep.period=[2,9]')
rm -rf DIR
ran=0

try() {
  local expected=$1 status=0
  shift
  printf '== %s\n' "$*"
  "$@" || status=$?
  ((status == expected)) || { printf 'expected exit status %s, got %s\n' "$expected" "$status" >&2; exit 1; }
  ran=$((ran + 1))
}

# The words of a command with its placeholders filled in.
fill() {
  local word
  words=()
  for word in $1; do
    case "$word" in
      orbweaver) words+=("$program") ;;
      SCENE) words+=("$scene" "${quick[@]}") ;;
      ATLAS) words+=(DIR/atlas.h5) ;;
      FAMILY) words+=(In-Phase) ;;
      SYSTEM) words+=(double_pendulum) ;;
      ORBIT) words+=(T=8.45) ;;
      ROW) words+=(0) ;;
      N) words+=(20) ;;
      MODEL.cpp)
        awk '/^```cpp/ {on = 1; next} /^```/ {on = 0} on' "${readme%/*}/docs/your_own_system.md" >DIR/model.cpp
        words+=(DIR/model.cpp)
        ;;
      FILE.so) words+=(DIR/model.so) ;;
      FILE.html) words+=(DIR/atlas.html) ;;
      FILE.txt) words+=(DIR/refined.txt) ;;
      FILE.svg) words+=(DIR/picture.svg) ;;
      FILE.csv) words+=(DIR/orbits.csv) ;;
      FILE.f90) words+=(DIR/equations.f90) ;;
      FILE.auto) words+=(DIR/s.family) ;;
      PROOFS.h5) words+=(DIR/proofs.h5) ;;
      *) words+=("$word") ;;
    esac
  done
}

while IFS= read -r line; do
  row=${line//'\|'/'/'}
  IFS='|' read -r _ command _ now _ <<<"$row"
  command=${command//'`'/}
  base=$(sed 's/\[[^]]*\]//g' <<<"$command")
  fill "$base"
  if [[ "$now" =~ ^\ *later ]]; then
    try 2 "${words[@]}"
    continue
  fi
  # A program that was built without Node has no page, and says so.
  if [[ "${words[1]}" == page ]] && ! command -v npm >/dev/null; then
    try 3 "${words[@]}"
    continue
  fi
  if [[ "${words[1]}" == plot ]] && ! command -v gnuplot >/dev/null; then
    try 3 "${words[@]}"
    continue
  fi
  try 0 "${words[@]}"
  while IFS= read -r group; do
    [[ -n "$group" ]] || continue
    IFS='/' read -ra choices <<<"$group"
    for choice in "${choices[@]}"; do
      fill "$base $choice"
      try 0 "${words[@]}"
    done
    base="$base ${choices[0]}"
  done < <(grep -o '\[[^]]*\]' <<<"$command" | tr -d '[]' || true)
done < <(grep '^| `orbweaver ' "$readme")
((ran >= 10)) || { echo "only $ran commands found in $readme" >&2; exit 1; }
