#!/usr/bin/env bash
# reading_archives.sh DOCUMENT SECTION PROGRAM ATLAS [PREFIX]: writes the files that a section of docs/reading_archives.md shows
# (```python NAME, ```cpp NAME, ...) and runs its programs and commands (```sh), on ATLAS in the place of out/double_pendulum/atlas.h5.
# Exit status 77, with a reason, where the section's interpreter is missing.
set -euo pipefail
document=$1 section=$2 program=$3 atlas=$4
export PREFIX=${5:-}
work=work
rm -rf "$work" && mkdir -p "$work/bin" "$work/out/double_pendulum" && cd "$work"
ln -s "$program" bin/orbweaver
ln -s "$atlas" out/double_pendulum/atlas.h5
export PATH="$PWD/bin:$PATH"

fail() {
  echo "reading_archives.sh: $*" >&2
  exit 1
}
skip() {
  echo "skipped: $*" >&2
  exit 77
}

# The first Python that has the modules.
python=''
for candidate in python3 /usr/bin/python3; do
  "$candidate" -c 'import h5py, scipy, matplotlib' 2>/dev/null && python=$candidate && break
done
case "$section" in
  Python) [[ -n "$python" ]] || skip "no Python with h5py, SciPy and Matplotlib (python3-h5py python3-scipy python3-matplotlib)" ;;
  h5dump) command -v h5dump >/dev/null || skip "h5dump is not installed (hdf5-tools)" ;;
  AUTO-07p)
    command -v gfortran >/dev/null || skip "gfortran is not installed"
    [[ -d "${AUTO_DIR:-/usr/lib/auto-07p}/lib" ]] || skip "AUTO-07p is not installed (auto-07p)"
    ;;
esac

kind='' file='' here='' ran=0
while IFS= read -r line; do
  case "$line" in
    '## '*) here=${line#'## '} ;;
    '```sh') kind=command ;;
    '```'*\ *) kind=file file=${line##* } ;;
    '```')
      if [[ "$here" == "$section" && "$kind" == file && "$file" == *.py ]]; then
        echo "== $file"
        "$python" "$file" >>said.txt || fail "$file ended with status $?"
        ran=$((ran + 1))
      fi
      kind=''
      ;;
    *)
      [[ "$here" == "$section" ]] || continue
      case "$kind" in
        file) printf '%s\n' "$line" >>"$file" ;;
        command)
          echo "== $line"
          bash -c "$line" </dev/null >>said.txt 2>&1 || fail "'$line' ended with status $?: $(tail -5 said.txt)"
          ran=$((ran + 1))
          ;;
      esac
      ;;
  esac
done <"$document"
((ran >= 2)) || fail "only $ran commands found in section '$section' of $document"
cat said.txt | cut -c1-200 | head -60
expect() { grep -qE "$1" said.txt || fail "nothing says '$1'"; }

case "$section" in
  Python)
    expect 'conserved energy'
    expect 'closed to [0-9.]+e-(09|1[0-9])'
    [[ -s families.png ]] || fail "no families.png"
    ;;
  h5dump)
    expect 'closed integral of p dq'
    expect 'energy x time'
    expect 'In-Phase'
    ;;
  C++) expect 'In-Phase, T = 8.2' ;;
  'CSV and JSON')
    rows=$("$program" show "$atlas" orbits --csv --columns step,period | tail -n +2)
    [[ "$(tail -n +2 orbits.csv | cut -d, -f2,3)" == "$rows" ]] || fail "orbits.csv has other periods than the archive"
    if command -v python3 >/dev/null; then
      python3 - <<'PY' || fail "inphase.json is not what it should be"
import csv, json
rows = [row for row in csv.DictReader(open("orbits.csv", newline="")) if row["family"] == "In-Phase"]
orbits = json.load(open("inphase.json", encoding="utf-8"))["orbits"]
assert len(rows) == len(orbits) > 5
for row, orbit in zip(rows, orbits):
    assert float(row["period"]) == orbit["period"] and float(row["state_th1"]) == orbit["state"][0]
PY
    fi
    ;;
  AUTO-07p)
    # Where AUTO stopped, and the family's energy at that period by another way.
    read -r label unfolding period energy <<<"$(awk '$1 != 0 {print $4, $5, $(NF - 1), $NF}' b.more | tail -1)"
    echo "AUTO: label $label, PAR(10) $unfolding, T $period, E $energy"
    [[ "$(awk '$1 != 0' b.more | wc -l)" -ge 3 ]] || fail "AUTO made no orbits: $(cat b.more)"
    expected=$("$program" refine "$atlas" In-Phase T=9.5 -n 12 2>/dev/null | awk '$1 == "energy" {print $2}')
    awk -v t="$period" -v e="$energy" -v x="$expected" -v mu="$unfolding" 'function abs(a) {return a < 0 ? -a : a}
      BEGIN {exit !(abs(t - 9.5) < 1e-6 && abs(e - x) < 1e-6 && abs(mu) < 1e-7)}' ||
      fail "AUTO ended at T = $period, E = $energy, PAR(10) = $unfolding; the family has E = $expected at T = 9.5"
    ;;
esac
echo "$ran programs and commands of $document, $section"
