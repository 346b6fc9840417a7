#!/bin/bash
# cost_fails.sh PROGRAM: what ends `cost` on one of several ranks ends it on all, and is told once.
set -u
program=$1
export OMPI_MCA_rmaps_base_oversubscribe=1
rm -rf work && mkdir work && cd work || exit 1
cat > scene.yaml << 'SCENE'
system: {name: harmonic_oscillator}
starts: {fixed_points: {grid: [[0]]}}
limits: {energy: [0, 10]}
SCENE

# ended STATUS TEXT OPTIONS...
ended() {
  local status=$1 text=$2 got=0
  shift 2
  timeout 60 mpirun -n 2 "$program" cost scene.yaml --quick "$@" > said 2>&1 || got=$?
  if ((got != status)) || [ "$(grep -cF -- "$text" said)" != 1 ]; then
    echo "cost_fails.sh: expected status $status and once '$text', got $got: $*"
    cat -v said
    exit 1
  fi
}
mkdir -p out/digits.csv
ended 2 "cannot write out/digits.csv: it is a folder" --only digits -o out
touch file
ended 3 "cannot make file" --only digits -o file
ended 2 "expected ladders among" --only nothing
ended 2 "expected --family to be one of" --family nobody
echo "four failures, each told once"
