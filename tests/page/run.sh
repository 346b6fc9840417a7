#!/usr/bin/env bash
# run.sh without_node|install|types|pages|browser|browser_all|bench PROGRAM MAKE_ATLAS SOURCES BUILD FOLDER: one part of the tests of the page; exit status 77
# where what it needs is not installed.
set -euo pipefail
part=$1 program=$2 make_atlas=$3 sources=$4 build=$5 folder=$6
export ORBWEAVER_PAGE_REFERENCES="$sources/tests/page/references"

need() {
  local name
  for name in "$@"; do
    command -v "$name" >/dev/null || { echo "skipped: $name is not installed (./quickstart test installs it)"; exit 77; }
  done
}

# What drivers/page/embed.cmake writes where something is missing, and that it fails where the page's own sources are wrong.
without_node() {
  local web="$sources/drivers/page/web" out="$folder/without_node/page_template.cpp"
  rm -rf "$folder/without_node"
  mkdir -p "$folder/without_node"
  embed() { cmake "-DWEB=$1" "-DBUILD=$folder/without_node/web" "-DOUT=$out" "-DNODE=$2" "-DNPM=$3" -P "$sources/drivers/page/embed.cmake"; }
  embed "$web" "" ""
  grep -q '^// missing' "$out" && grep -q 'Node was not found.*quickstart page' "$out" || { echo "no word of Node in $out"; exit 1; }
  embed "$web" "$(type -P true)" "$(type -P false)"
  grep -q 'is the npm registry reachable' "$out" || { echo "no word of npm in $out"; exit 1; }
  printf '#!/bin/sh\necho "npm ERR! code SELF_SIGNED_CERT_IN_CHAIN" >&2\nexit 1\n' >"$folder/without_node/npm"
  chmod +x "$folder/without_node/npm"
  embed "$web" "$(type -P true)" "$folder/without_node/npm"
  grep -q '(SELF_SIGNED_CERT_IN_CHAIN; is the npm registry reachable' "$out" || { echo "not why npm failed in $out"; exit 1; }
  printf '#!/bin/sh\nmkdir -p node_modules\n' >"$folder/without_node/npm"
  chmod +x "$folder/without_node/npm"
  local said
  ! said=$(embed "$web" "$(type -P false)" "$folder/without_node/npm" 2>&1) || { echo "a bundle that failed was taken"; exit 1; }
  grep -q 'could not be bundled' <<<"$said" || { echo "$said"; exit 1; }
}
if [[ "$part" == without_node ]]; then
  without_node
  exit 0
fi

need node npm
modules="$folder/packages"
case "$part" in
  install)
    mkdir -p "$modules"
    if ! cmp -s "$sources/tests/page/package-lock.json" "$modules/installed-lock.json"; then
      cp "$sources/tests/page/package.json" "$sources/tests/page/package-lock.json" "$modules/"
      (cd "$modules" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error) ||
        { echo "skipped: the npm registry is not reachable"; exit 77; }
      cp "$modules/package-lock.json" "$modules/installed-lock.json"
    fi
    ;;
  types)
    web="$build/drivers/page/web"
    [[ -d "$web/node_modules/typescript" ]] || { echo "skipped: the page was not built"; exit 77; }
    cd "$web"
    node node_modules/typescript/bin/tsc -p .
    ;;
  pages)
    grep -q '^// missing' "$build/drivers/page/page_template.cpp" && { echo "skipped: the page was not built"; exit 77; }
    mkdir -p "$folder"
    page() { "$program" page "$folder/$1.h5" -o "$folder/$1.html"; }
    survey() {
      local name=$1
      shift
      rm -rf "$folder/$name"
      "$program" survey "$@" -o "$folder/$name" --quiet
      cp "$folder/$name/atlas.h5" "$folder/$name.h5"
      page "$name"
    }
    scenes="$sources/drivers/scenes"
    survey pendulum "$scenes/double_pendulum.yaml" --set limits.period=17.5
    survey galaxy "$scenes/henon_heiles.yaml" --set survey.depth=0
    survey spring "$scenes/swinging_spring.yaml" --set survey.depth=0
    survey bodies "$scenes/pcr3bp_earth_moon.yaml" --set survey.depth=0 --set limits.period=7
    survey chain "$scenes/chain.yaml" --set system.parameters.links=4 --set 'starts.sweep.period=[3,18]' --set 'limits.energy=[-.inf,-9.5]'
    survey eight "$scenes/three_bodies_figure_eight.yaml" --set survey.depth=0 --set 'limits.parameter=[0.99,1.01]'
    survey space "$scenes/cr3bp_earth_moon.yaml" --set 'starts.fixed_points.grid=[[0.837],[0],[0]]' --set 'starts.states=[]' \
      --set survey.depth=0 --set limits.period=4
    survey shaken "$scenes/damped_driven_double_pendulum.yaml" --set 'system.effects=[damping, pivot_drive]' \
      --set 'system.parameters={c1: 0.2, c2: 0.2, pivot_amplitude: 0, pivot_direction: 30, drive_frequency: 0.9}' \
      --set 'starts={fixed_points: {grid: [[0],[0]]}}' --set 'continuation={free: pivot_amplitude}' \
      --set 'limits.parameter=[0,0.5]' --set survey.depth=0
    "$make_atlas" hostile "$folder/hostile.h5"
    page hostile
    "$make_atlas" empty "$folder/empty.h5"
    page empty
    "$make_atlas" unknown "$folder/unknown.h5"
    page unknown
    "$make_atlas" told "$folder/told.h5"
    page told
    "$make_atlas" reduced "$folder/reduced.h5" "$folder/reduced.html"
    "$program" show "$folder/pendulum.h5" orbits --csv >"$folder/pendulum.csv"
    ;;
  browser | browser_all)
    chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
    [[ -n "$chromium" ]] || { echo "skipped: chromium is not installed (./quickstart test installs it)"; exit 77; }
    [[ -d "$modules/node_modules/puppeteer-core" ]] || { echo "skipped: puppeteer-core could not be fetched"; exit 77; }
    cp "$sources"/tests/page/*.mjs "$modules/"
    node "$modules/browser_test.mjs" "$chromium" "$folder" "${part#browser_}"
    ;;
  bench)
    need chromium
    "$make_atlas" many "$folder/many.h5" 100000
    time "$program" page "$folder/many.h5" -o "$folder/many.html"
    cp "$sources"/tests/page/*.mjs "$modules/"
    node "$modules/bench.mjs" "$(command -v chromium)" "$folder/many.html"
    ;;
esac
