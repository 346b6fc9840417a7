#!/usr/bin/env bash
# terminal.sh PROGRAM SCENE: what the program writes to a terminal, made by `script`, of 60, 80 and 120 columns: a bar and lines within the
# width; colours, unless NO_COLOR is set or TERM is `dumb`; pages. To a pipe it writes no escape sequence, alone and under mpirun.
set -euo pipefail
program=$1 scene=$2
quick=(--set limits.period=8.5 --set starts.sweep.step=0.1 --set survey.depth=0)
small_steps=(--set continuation.step=0.2deg)  # a bar is drawn ten times a second
fail() { echo "terminal.sh: $*" >&2; exit 1; }
command -v script >/dev/null || { echo "skipped: no script here (Debian: bsdutils)"; exit 77; }
export LC_ALL=C PAGER=cat
unset NO_COLOR COLUMNS LESS 2>/dev/null || true
escape=$'\x1b'

# on_terminal COLUMNS FILE COMMAND...: what the command shows on a terminal, into FILE; its status.
on_terminal() {
  local columns=$1 file=$2
  shift 2
  TERM=${term-xterm} script -qec "stty cols $columns rows 40; $(printf '%q ' "$@")" /dev/null </dev/null >"$file" || return $?
}
# Without escape sequences and carriage returns.
plain() { sed -e "s/$escape\[[0-9;]*[A-Za-z]//g" -e 's/\r//g' "$1"; }
has() { grep -qF -- "$2" "$1" || fail "$1 lacks '$2': $(cat -v "$1" | tail -5)"; }
lacks() { ! grep -qF -- "$2" "$1" || fail "$1 has '$2': $(grep -F -- "$2" "$1" | cat -v | head -3)"; }

for columns in 60 80 120; do
  rm -rf out
  on_terminal $columns live.txt "$program" --ranks 2 survey "$scene" -o out "${quick[@]}" "${small_steps[@]}" || fail "a survey: status $?"
  plain live.txt | sed '/^[0-9]* families, /,$d' | grep -v '^orbweaver' >progress.txt
  widest=$(awk '{if (length($0) > most) most = length($0)} END {print most + 0}' progress.txt)
  ((widest > columns / 2 && widest < columns)) || fail "$columns columns: a line has $widest: $(sort progress.txt | tail -3)"
  grep -q '^\[#*-*\] [0-9]* of [0-9]* tasks, [0-9]* orbits' progress.txt || fail "no bar: $(tail -3 progress.txt)"
  grep -q 'In-Phase .* orbits.* period limit (T = 8.5)' progress.txt || fail "no line of a family"
  has live.txt "$escape[1mfamily"
done
# A pipe: nothing but text, alone, under mpirun, which gives its ranks terminals of their own, and by --ranks.
for start in "$program" "mpirun -n 2 $program" "$program --ranks 2"; do
  rm -rf out
  $start survey "$scene" -o out "${quick[@]}" 2>&1 | cat >piped.txt
  lacks piped.txt "$escape"
  has piped.txt 'archive: out/atlas.h5'
done
rm -rf out
term=dumb on_terminal 80 dumb.txt "$program" survey "$scene" -o out "${quick[@]}"
lacks dumb.txt "$escape"
has dumb.txt 'Out-Phase     24 orbits'
rm -rf out
NO_COLOR=1 on_terminal 80 uncoloured.txt "$program" survey "$scene" -o out "${quick[@]}" --set survey.depth=1
lacks uncoloured.txt "${escape}[1m"
has uncoloured.txt "${escape}[J"

# Pages, of what stands on a terminal alone.
PAGER='sed s/^/PAGED:/' on_terminal 80 paged.txt "$program" show out/atlas.h5
has paged.txt 'PAGED:parameters   g = 1 m/s^2'
[[ $(plain paged.txt | grep -vc '^PAGED:') == 0 ]] || fail "lines beside the pager: $(grep -v PAGED: paged.txt)"
PAGER='sed s/^/PAGED:/' "$program" show out/atlas.h5 families >unpaged.txt
lacks unpaged.txt PAGED
lacks unpaged.txt "$escape"
on_terminal 60 shown.txt "$program" show out/atlas.h5 families
has shown.txt "$escape[1mfamily"
has shown.txt "period-doubling"
PAGER='head -1' on_terminal 80 left.txt "$program" show out/atlas.h5 orbits || fail "a pager that is left: status $?"

# Errors stand out.
status=0
on_terminal 80 error.txt "$program" --ranks 2 survey nowhere.yaml -o nowhere || status=$?
((status == 2)) || fail "no scene: status $status"
has error.txt "$escape[1;31morbweaver:$escape[0m nowhere.yaml"
