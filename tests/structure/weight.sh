#!/bin/bash
# weight.sh ROOT: counts code lines (no comments, no blank ones) of src, include and the C++ of drivers, and the named numbers in them, by
# which the program decides (constants with a number in their definition). Fails where there are more than the limits, which only fall.
set -eu
most_lines=72765
most_numbers=1187

cd "$1"
sources() { find src include drivers \( -name '*.cpp' -o -name '*.hpp' -o -name '*.inl' \) -not -path '*/node_modules/*' -print0 | sort -z; }
lines=$(sources | xargs -0 cat | grep -v '^[[:space:]]*//' | grep -vc '^[[:space:]]*$')
numbers=$(sources | xargs -0 cat | grep -cE '^[[:space:]]*(static |inline )*constexpr (double|float|int|long|unsigned|auto|std::(size_t|u?int[0-9]+_t|ptrdiff_t)|Index|Eigen::Index) [a-z_]+(\{| =).*[0-9]' || true)
[ "$lines" -gt 10000 ] || { echo "weight.sh: no sources below $1" >&2; exit 1; }
echo "$lines code lines (at most $most_lines), $numbers named numbers (at most $most_numbers)"
[ "$lines" -le $most_lines ] && [ "$numbers" -le $most_numbers ]
