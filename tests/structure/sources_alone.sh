#!/usr/bin/env bash
# sources_alone.sh SOURCES FOLDER COMPILER: whether every source compiles alone, as without ORBWEAVER_UNITY_BUILD, with all warnings as
# errors: a source of a unity build may lean on the includes and the helpers of those before it. Configures FOLDER; makes no objects.
set -euo pipefail
sources=$1 folder=$2 compiler=$3
cmake -S "$sources" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DORBWEAVER_UNITY_BUILD=OFF -DORBWEAVER_BUILD_TESTS=ON >"$folder.configured" || { cat "$folder.configured"; exit 1; }
cmake --build "$folder" --target orbweaver_precompiled orbweaver_test_precompiled
export failed="$folder/failed"
rm -f "$failed"
check() {
  local words
  eval "words=($1)"
  "${words[@]}" || echo "${words[-1]}" >>"$failed"
}
export -f check
cd "$folder"
[[ -e drivers/build_settings.cpp ]] || { echo "no drivers/build_settings.cpp in $folder"; exit 1; }
# Headers are checked by header_checks; what programs make is made by a build.
grep '"command": ' compile_commands.json | grep -v -e /structure/headers/ -e 'page_template\.cpp' -e 'src/loop/fourier_plans\.cpp' -e 'cmake_pch\.hxx\.cxx' |
  sed -e 's/^ *"command": "//' -e 's/",$//' -e 's/\\\(["\\]\)/\1/g' -e 's/ -o [^ ]* -c / -fsyntax-only /' >commands
xargs -d '\n' -P "$(nproc)" -I{} bash -c 'check "$0"' {} <commands
count=$(wc -l <commands)
((count > 500)) || { echo "only $count sources found in $folder/compile_commands.json"; exit 1; }
if [[ -e "$failed" ]]; then
  echo "$(wc -l <"$failed") of $count sources do not compile alone:"
  cat "$failed"
  exit 1
fi
echo "$count sources compile alone"
