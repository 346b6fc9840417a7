#!/usr/bin/env bash
# follow.sh DOCUMENT BUILD ATLAS [--prefix PREFIX] [--long] [--dry]: writes the files that a document shows and runs its commands in a
# folder of their own, `work`, which looks like the root of the source tree: build/release is BUILD, out/double_pendulum/atlas.h5 is ATLAS (that
# of `./quickstart run`). Every command must end with status 0, unless rules.txt says otherwise. With --prefix the program is that
# of the package installed there. With --long it runs the commands that rules.txt calls long, too. Then excerpts, blocks ```text of the
# document, must be what was said (`said.txt`), line by line, but for zeros and numbers like 1.7e-15, which are rounding; and
# checks/DOCUMENT.sh, if there is one, holds what was written and said against what the document promises.
# Placeholders: SCENE is the double pendulum's scene, ATLAS its archive, FAMILY In-Phase, DIR a folder, which is emptied before a survey
# into it without --resume; of more than 3 ranks 2 are started.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
root=$(readlink -f "$here/../..")
document=$1 build=$2 atlas=$3
shift 3
prefix='' long=''
dry=''
while (($#)); do
  case "$1" in
    --prefix) prefix=$2 && shift ;;
    --long) long=yes ;;
    --dry) dry=yes ;; # says what it would run
    *) echo "follow.sh: unexpected $1" >&2 && exit 2 ;;
  esac
  shift
done
. "$here/read.sh"
. "$here/rules.sh"
name=$(name_of_document "$document")
read_rules "$here/rules.txt"
((${#rule_verbs[@]} > 0)) || { echo "follow.sh: no rules" >&2 && exit 2; }

fail() {
  echo "follow.sh: $document: $*" >&2
  exit 1
}

rm -rf work && mkdir -p work/bin work/out/double_pendulum work/build && cd work
for item in "$root"/*; do
  case "${item##*/}" in
    build | out | quickstart) ;; # nothing that is run here builds or surveys in the tree itself
    *) ln -s "$item" . ;;
  esac
done
ln -s "$build" build/release
ln -s "$atlas" out/double_pendulum/atlas.h5
if [[ -n "$prefix" ]]; then
  export PATH="$prefix/bin:$PATH" PREFIX=$prefix
else
  ln -s "$build/drivers/orbweaver" bin/orbweaver
fi
if grep -q '^```python ' "$document"; then # the first Python that has what docs/reading_archives.md asks for
  for candidate in python3 /usr/bin/python3; do
    "$candidate" -c 'import h5py, scipy, matplotlib' 2>/dev/null && ln -s "$(command -v "$candidate")" bin/python3 && break
  done
fi
export PATH="$PWD/bin:$PATH" LC_ALL=C.UTF-8

ran=0 left_out=0 ran_commands=''
on_file() {
  rm -f "$2" # never through a link into the source tree
  printf '%s' "$3" >"$2"
}
on_fault() { fail "line $1: $2"; }
excerpts=() excerpt_lines=()
on_excerpt() { excerpt_lines+=("$1") excerpts+=("$2"); }
without_rounding() { awk '{ for (i = 1; i <= NF; ++i) if ($i ~ /^(-?[0-9.]+e-[0-9]+|0)$/) $i = "~"; $1 = $1; print }'; }
on_command() {
  local line=$1 command text
  command=$(without_comment "$2")
  judge "$name" "$command"
  if [[ "$verdict" == never || "$verdict" == elsewhere || ("$verdict" == long && -z "$long") ]]; then
    echo "-- $line: $command"
    echo "   not run here ($verdict): $reason"
    left_out=$((left_out + 1))
    return
  fi
  if [[ -n "$needs" ]] && ! bash -c "$needs" >/dev/null 2>&1; then
    echo "-- $line: $command"
    echo "   not run, for this fails here: $needs"
    left_out=$((left_out + 1))
    return
  fi
  text=$(filled "$command")
  echo "== $line: $command"
  [[ "$text" == "$command" ]] || echo "   run as: $text"
  [[ "$text" != *" survey "*"-o dir"* || "$text" == *--resume* ]] || rm -rf dir
  printf '$ %s\n' "$command" >>said.txt
  [[ -z "$dry" ]] || return 0
  local status=0
  bash -c "set -o pipefail; $text" </dev/null >said_now.txt 2>&1 || status=$?
  cat said_now.txt >>said.txt
  ((status == expected)) || fail "line $line: '$text' ended with status $status instead of $expected: $(tail -5 said_now.txt)"
  ran=$((ran + 1)) ran_commands+=$command$'\n'
}
read_document "$document"

[[ -z "$dry" ]] || exit 0
for n in "${!excerpts[@]}"; do
  [[ "$(without_rounding <said.txt)" == *"$(without_rounding <<<"${excerpts[n]}")"* ]] ||
    fail "line ${excerpt_lines[n]}: the excerpt is not what was said, which is in $PWD/said.txt"
done
expect() { grep -qE -- "$1" said.txt || fail "nothing says '$1'"; }
if [[ -e "$here/checks/$name.sh" ]]; then
  . "$here/checks/$name.sh"
fi
times >times.txt
read -r seconds _ <<<"$(tail -1 times.txt)"
echo "$ran commands of $name.md were run, $left_out were not; $seconds of user time"
