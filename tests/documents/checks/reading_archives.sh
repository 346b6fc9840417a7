# Sourced by follow.sh: what the programs of docs/reading_archives.md wrote and said, as far as they could be run here.
if [[ "$ran_commands" == *"h5dump "* ]]; then
  expect 'closed integral of p dq'
  expect 'energy x time'
fi
if [[ "$ran_commands" == *"python3 "* ]]; then
  expect 'conserved energy'
  expect 'closed to [0-9.]+e-(09|1[0-9])'
  [[ -s families.png ]] || fail "no families.png"
fi
[[ "$ran_commands" != *build/orbit* ]] || expect '^In-Phase, T = 8.2'

rows=$(orbweaver show "$atlas" orbits --csv --columns step,period | tail -n +2)
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

if [[ "$ran_commands" == *"./pendulum "* ]]; then
  # Where AUTO stopped, and the family's energy at that period by another way.
  read -r label unfolding period energy <<<"$(awk '$1 != 0 {print $4, $5, $(NF - 1), $NF}' b.more | tail -1)"
  echo "AUTO: label $label, PAR(10) $unfolding, T $period, E $energy"
  [[ "$(awk '$1 != 0' b.more | wc -l)" -ge 3 ]] || fail "AUTO made no orbits: $(cat b.more)"
  known=$(orbweaver refine "$atlas" In-Phase T=9.5 -n 12 2>/dev/null | awk '$1 == "energy" {print $2}')
  awk -v t="$period" -v e="$energy" -v x="$known" -v mu="$unfolding" 'function abs(a) {return a < 0 ? -a : a}
    BEGIN {exit !(abs(t - 9.5) < 1e-6 && abs(e - x) < 1e-6 && abs(mu) < 1e-7)}' ||
    fail "AUTO ended at T = $period, E = $energy, PAR(10) = $unfolding; the family has E = $known at T = 9.5"
fi
