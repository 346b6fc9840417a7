#!/usr/bin/env bash
# metadata.sh SOURCE VERSION PROGRAM: whatever names a version names that of project() in CMakeLists.txt; the release notes are made of
# the changelog; Python reads the Spack recipe; each step of the container file is one that a shell reads, and copies what there is; the
# packages that orbweaver-dev depends on are those that `quickstart` installs.
set -euo pipefail
source=$1 version=$2 program=$3
fail() { echo "metadata.sh: $*" >&2; exit 1; }
expect() { [[ "$2" == "$3" ]] || fail "$1: expected '$3', got '$2'"; }

expect "orbweaver --version" "$("$program" --version)" "orbweaver $version"
expect "CITATION.cff" "$(sed -n 's/^version: *//p' "$source/CITATION.cff")" "$version"
grep -q '^cff-version: 1\.2\.0$' "$source/CITATION.cff" || fail "CITATION.cff is not of format 1.2.0"
recipe=$source/cmake/packaging/spack/packages/orbweaver/package.py
expect "the Spack recipe" "$(sed -n 's/^    version("\(.*\)")$/\1/p' "$recipe")" "$version"
if command -v python3 >/dev/null; then
  python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' "$recipe" || fail "Python cannot read the Spack recipe"
fi

notes() { cmake "-DCHANGELOG=$1" "-DVERSION=$2" -DOUT=notes.md -P "$source/cmake/packaging/release_notes.cmake"; }
notes "$source/CHANGELOG.md" "$version"
grep -q "^# Orbweaver $version" notes.md || fail "release notes without a title: $(head -1 notes.md)"
grep -q '^- ' notes.md || fail "release notes that say nothing"
printf '# Changelog\n\n## Unreleased\n- not yet\n\n## 2.0.0\n### Added\n- this; that\n\n## 1.0.0\n- long ago\n' >changelog.md
notes changelog.md 2.0.0
expect "the notes of one release" "$(cat notes.md)" "$(printf '# Orbweaver 2.0.0\n\n### Added\n- this; that')"
notes changelog.md 3.0.0
expect "the notes before a release" "$(cat notes.md)" "$(printf '# Orbweaver 3.0.0, not released yet\n\n- not yet')"

# A step is a word in capitals and its lines.
steps=$(sed -e '/^#/d' -e '/^$/d' -e ':a' -e '/\\$/{N;s/\\\n */ /;ba}' "$source/cmake/packaging/Containerfile")
stages=0
while IFS= read -r step; do
  read -r word rest <<<"$step"
  case "$word" in
    RUN) sh -nc "$rest" || fail "the shell cannot read: $rest" ;;
    COPY)
      [[ "$rest" == --from=build* || -e "$source/${rest%% *}" ]] || fail "there is nothing to copy: $rest" ;;
    FROM) stages=$((stages + 1)) ;;
    ARG | ENV | USER | WORKDIR | CMD) [[ -n "$rest" ]] || fail "$word of the container file says nothing" ;;
    *) fail "no step of a container file: $step" ;;
  esac
done <<<"$steps"
expect "stages of the container file" "$stages" 2

installed=$("$source/quickstart" packages)
wanted=$(sed -n '/^set(packages /,/)/p' "$source/cmake/packaging/Debian.cmake" | tr -d '()' | sed 's/^set//;s/^packages //')
count=0
for package in $wanted; do
  [[ "$package" == packages ]] && continue
  grep -qx "$package" <<<"$installed" || fail "orbweaver-dev depends on $package, which ./quickstart does not install"
  count=$((count + 1))
done
((count > 10)) || fail "only $count packages found in Debian.cmake"
echo "version $version everywhere; $count packages; a container of $stages stages"
