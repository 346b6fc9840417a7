#!/usr/bin/env bash
# The table of docs/accuracy.md, "Hard cases": runs the hard suite of a build folder and prints its verdicts.
#   tests/hard/table.sh build/release
set -euo pipefail
readonly build=${1:?usage: tests/hard/table.sh BUILD_FOLDER}
echo '| case | what is true | bound | found | time |'
echo '|---|---|---|---|---|'
ctest --test-dir "$build" -L '^hard$' --verbose | sed -n 's/^[0-9]*: hard: \(.*\)$/| \1 |/p'
