#!/usr/bin/env bash
# plots.sh PROGRAM ATLAS: every picture of an archive in every format and style, drawn by gnuplot; and what is said without gnuplot.
set -euo pipefail
program=$1 atlas=$2
rm -rf work && mkdir work && cd work

fail() {
  echo "plots.sh: $*" >&2
  exit 1
}
# A PATH without gnuplot.
mkdir bin tmp
export TMPDIR="$PWD/tmp"
status=0
PATH="$PWD/bin" "$program" plot "$atlas" tree -o tree.svg 2>said.txt || status=$?
((status == 3)) || fail "without gnuplot: status $status instead of 3: $(cat said.txt)"
grep -q 'apt-get install gnuplot-nox' said.txt || fail "without gnuplot: $(cat said.txt)"
[[ ! -e tree.svg && ! -e tree.svg.part ]] || fail "without gnuplot a picture was left"
command -v gnuplot >/dev/null || { echo "skipped: gnuplot is not installed (gnuplot-nox)" >&2; exit 77; }

drawn=0
draw() {
  local file=$1
  shift
  "$program" plot "$atlas" "$@" -o "$file" 2>said.txt || fail "plot $*: status $?: $(cat said.txt)"
  [[ ! -s said.txt ]] || fail "plot $*: $(cat said.txt)"
  local head
  head=$(head -c 8 "$file" | tr -d '\0')
  case "$file" in
    *.svg) grep -q '</svg>' "$file" || fail "$file is not whole" ;;
    *.pdf) [[ "$head" == %PDF* ]] || fail "$file is no PDF" ;;
    *.png) [[ "$head" == *PNG* ]] || fail "$file is no PNG" ;;
  esac
  drawn=$((drawn + 1))
}
for what in tree energy-period stability section; do draw $what.svg $what; done
for what in orbit strobe spectrum accuracy sweep; do draw $what.svg $what --family In-Phase; done
draw sweep_all.svg sweep --style wide
draw convergence.svg convergence --family In-Phase --step 3
draw tree.pdf tree --family In-Phase --family Up-Down
draw tree.png tree --style slide
(unset LANG LC_ALL LC_CTYPE; draw without_locale.svg sweep --style wide)
draw orbit.png orbit --family In-Phase --step 3
# What stands in the pictures.
grep -q '>In-Phase<' tree.svg || fail "the tree does not name In-Phase"
grep -q '>unstable<' tree.svg || fail "the tree does not say what is unstable"
grep -q 'period T \[s\]' tree.svg || fail "the tree has no period"
grep -q 'T = 8.2094' orbit.svg || fail "the orbits have no periods"
grep -q '>Out-Phase 3.4004<' sweep.svg || fail "the sweep does not name Out-Phase"
grep -q '>odd harmonics only<' sweep.svg || fail "the sweep has no odd harmonics"
grep -q 'th1 = 180°, th2 = 0°' sweep_all.svg || fail "the sweep does not name equilibria"
grep -qE '>Newton: [1-9]<' convergence.svg || fail "Newton's method takes no few iterations"
status=0
"$program" plot "$atlas" tree -o nowhere/tree.svg 2>said.txt || status=$?
((status == 3)) || fail "a folder that is not there: status $status: $(cat said.txt)"
grep -q 'cannot write nowhere/tree.svg: is there' said.txt || fail "a folder that is not there: $(cat said.txt)"
[[ -z "$(ls tmp)" ]] || fail "$(ls tmp) was left"
echo "$drawn pictures"
