#!/usr/bin/env bash
# The table of docs/accuracy.md, "Crossings to 25 digits": those of an archive's base families up to a period, and the first one of each of
# their branches, a row each.
#   tests/refine/crossings.sh build/release/drivers/orbweaver out/double_pendulum/atlas.h5 12
set -euo pipefail
readonly program=${1:?usage: crossings.sh PROGRAM ATLAS PERIOD} atlas=$2 most=$3
echo '| family | kind | row | T | E | s |'
echo '|---|---|---|---|---|---|'
# Rows: those of families without a parent, and of each child of these the first.
mapfile -t rows < <(awk -F, -v most="$most" '
  FNR == 1 { for (i = 1; i <= NF; ++i) at[FILENAME, $i] = i; next }
  FILENAME == ARGV[1] { name[FNR - 2] = $at[FILENAME, "name"]; parent[FNR - 2] = $at[FILENAME, "parent"]; next }
  { family = $at[FILENAME, "family"]; kind = $at[FILENAME, "kind"]
    base = parent[family] < 0 && $at[FILENAME, "period"] <= most
    child = parent[family] >= 0 && parent[parent[family]] < 0 && !seen[family]++
    if (base || child) print FNR - 2 "," name[family] "," kind }
' <("$program" show "$atlas" families --csv) <("$program" show "$atlas" crossings --csv))
for row in "${rows[@]}"; do
  IFS=, read -r number family kind <<< "$row"
  begin=$(date +%s.%N)
  text=$("$program" refine "$atlas" --crossing "$number" --digits 25 2> /dev/null) || text=""
  seconds=$(echo "$(date +%s.%N) - $begin" | bc)
  value() { sed -nE "s/^  $1 +(-?[0-9.]+) .*/\1/p" <<< "$text"; }
  printf '| %s | %s | %s | %s | %s | %.1f |\n' "$family" "$kind" "$number" "$(value period)" "$(value energy)" "$seconds"
done
