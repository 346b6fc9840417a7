#!/usr/bin/env bash
# results.sh RESULTS.md PROGRAM FIGURES [files]: what docs/results.md says, against what `./quickstart figures` has left in the folder FIGURES:
# the files that it names are there; its blocks of commands print what stands below them; each number of a column "ours" is one of theirs,
# as far as it is written. With `files` only the first, of a survey with other limits.
set -euo pipefail
results=$1 program=$2 figures=$3 only=${4:-}
rm -rf work && mkdir work

fail() {
  echo "results.sh: $*" >&2
  exit 1
}

# Files that are named: `figure_1.svg` and the like, in backticks or behind -o.
grep -oE '(figure|table)_[0-9a-z_]+\.(svg|txt|csv)' "$results" | sort -u >work/files
(($(wc -l <work/files) >= 12)) || fail "only $(wc -l <work/files) files are named in $results"
while IFS= read -r file; do
  [[ -s "$figures/$file" ]] || fail "$file is named in $results, and $figures does not hold it"
  [[ "$file" != *.svg ]] || grep -q '</svg>' "$figures/$file" || fail "$file is not whole"
done <work/files
# And the other way round: nothing is made that is not spoken of.
for file in "$figures"/figure_* "$figures"/table_*; do
  grep -q "${file##*/}" "$results" || fail "${file##*/} is not spoken of in $results"
done
[[ "$only" != files ]] || { echo "$(wc -l <work/files) files"; exit 0; }

# Blocks: the commands, and what should stand below them.
awk '/^```console$/ {on = 1; next} /^```$/ {on = 0} on' "$results" >work/written
: >work/printed
: >work/outputs
blocks=0
while IFS= read -r line; do
  [[ "$line" == '$ '* ]] || continue
  printf '%s\n' "$line" >>work/printed
  command=${line#'$ '}
  command=${command//build\/release\/drivers\/orbweaver/"'$program'"}
  command=${command//out\/figures/"'$figures'"}
  bash -c "$command" >work/one 2>work/said || fail "$line: status $?: $(cat work/said)"
  cat work/one >>work/printed
  cat work/one >>work/outputs
  blocks=$((blocks + 1))
done <work/written
((blocks >= 4)) || fail "only $blocks commands are in the blocks of $results"

# Line by line: the words are the same, and numbers to one in a hundred thousand or in their last digit.
cat >work/compare.awk <<'AWK'
function words(line) {
  gsub(/-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/, "#", line)
  gsub(/[ \t]+/, " ", line)
  sub(/ $/, "", line)
  return line
}
# What is written, one in the last digit; whole numbers are the same.
function unit_of(number,   exponent) {
  if (number !~ /[.e]/) return 0
  exponent = 0
  if (match(number, /e/)) { exponent = substr(number, RSTART + 1) + 0; number = substr(number, 1, RSTART - 1) }
  return 10 ^ (exponent - (index(number, ".") ? length(number) - index(number, ".") : 0))
}
function differ(a, b,   room) {
  room = 1.1 * unit_of(b)
  if (room > 0 && room < 1e-5 * (a < 0 ? -a : a)) room = 1e-5 * (a < 0 ? -a : a)
  return a - b > room || b - a > room
}
function fail(text) {
  printf "line %d of the blocks: %s\n  written: %s\n  printed: %s\n", FNR, text, written[FNR], $0
  failed = 1
  exit 1
}
NR == FNR { written[FNR] = $0; lines = FNR; next }
{
  if (substr($0, 1, 2) == "$ ") { if ($0 != written[FNR]) fail("another command"); next }
  if (words($0) != words(written[FNR])) fail("other words")
  here = $0
  there = written[FNR]
  while (match(here, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/)) {
    a = substr(here, RSTART, RLENGTH)
    here = substr(here, RSTART + RLENGTH)
    match(there, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/)
    b = substr(there, RSTART, RLENGTH)
    there = substr(there, RSTART + RLENGTH)
    if (differ(a, b)) fail("another number")
  }
}
END { if (!failed && FNR != lines) { print "the blocks have " lines " lines, and " FNR " are printed"; exit 1 } }
AWK
awk -f work/compare.awk work/written work/printed >&2 || fail "a block of $results is not what its command prints"

# Numbers of the columns "ours ..." with at least four digits, or an exponent.
cat >work/numbers.awk <<'AWK'
/^\|/ {
  count = split($0, cells, "|")
  if (!in_table) {
    in_table = 1
    for (i = 1; i <= count; i++) ours[i] = cells[i] ~ /^ *ours/
    next
  }
  for (i = 1; i <= count; i++) {
    if (!ours[i]) continue
    text = cells[i]
    while (match(text, /[0-9]+\.[0-9]+(e[-+]?[0-9]+)?/)) {
      number = substr(text, RSTART, RLENGTH)
      text = substr(text, RSTART + RLENGTH)
      digits = number
      sub(/e.*/, "", digits)
      gsub(/\./, "", digits)
      if (length(digits) >= 4 || number ~ /e/) print number
    }
  }
  next
}
{ in_table = 0; delete ours }
AWK
awk -f work/numbers.awk "$results" >work/ours
(($(wc -l <work/ours) >= 20)) || fail "only $(wc -l <work/ours) numbers in the columns of $results"
grep -oE -- '-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?' work/outputs >work/known
awk '
  NR == FNR { known[n++] = $0 + 0; next }
  {
    exponent = 0
    digits = $0
    if (match(digits, /e/)) { exponent = substr(digits, RSTART + 1) + 0; digits = substr(digits, 1, RSTART - 1) }
    decimals = length(digits) - index(digits, ".")
    unit = 10 ^ (exponent - decimals)
    for (i = 0; i < n; i++) if (known[i] - $0 <= 0.51 * unit && $0 - known[i] <= 0.51 * unit) next
    print $0
  }' work/known work/ours >work/unknown
[[ ! -s work/unknown ]] || fail "numbers of $results that no command of its blocks prints: $(tr '\n' ' ' <work/unknown)"

# The curves of figure 7 have a dip each, sharper than thirty dots are high, below the mark of the crossing: that once around below the branch
# point, that twice around below the doubling. `dip COLOUR MARK`: of the paths of this colour, and gnuplot's point.
dip() {
  awk -v colour="$1" -v mark="$2" '
    /<path stroke=/ { on = index($0, "stroke=\x27" colour "\x27") > 0 }
    on {
      line = $0
      while (match(line, /[0-9.]+,[0-9.]+ /)) {
        split(substr(line, RSTART, RLENGTH), point, ",")
        line = substr(line, RSTART + RLENGTH)
        if (point[2] + 0 < bottom) { x[n] = point[1] + 0; y[n++] = point[2] + 0 }
      }
    }
    /stroke=.black.*Z/ { if (match($0, /L[0-9.]+,[0-9.]+ /)) bottom = substr($0, index($0, "L") + index(substr($0, index($0, "L")), ",")) + 0 }
    index($0, "href=\x27#" mark "\x27 transform=") && !at { match($0, /translate\([0-9.]+/); at = substr($0, RSTART + 10) + 0 }
    END {
      for (i = 10; i + 10 < n; i++)
        if (y[i] >= y[i - 1] && y[i] > y[i + 1] && y[i] - y[i - 10] > 30 && y[i] - y[i + 10] > 30) { dips++; place = x[i] }
      printf "%d dips, the last at %g; %s at %g\n", dips, place, mark, at
      exit !(dips == 1 && place - at < 1.5 && at - place < 1.5)
    }' "$figures/figure_7.svg"
}
dip "rgb(  0, 114, 178)" gpPt5 >work/once || fail "figure_7.svg, once around: $(cat work/once)"
dip "rgb(213,  94,   0)" gpPt3 >work/twice || fail "figure_7.svg, twice around: $(cat work/twice)"
echo "$(wc -l <work/files) files, $blocks commands, $(wc -l <work/ours) numbers"
