#!/bin/bash
# odd_input.sh PROGRAM SCENE SANITIZED: words and files that are none. Each must be refused within 5 s, in 500 MB, with
# status 2, with what is expected and without a raw control character or a byte that is not UTF-8. AddressSanitizer
# reserves terabytes of addresses: where the program is built with it (SANITIZED is ON) memory has no limit, and its search for
# leaks at the end takes seconds of its own.
set -u
program=$1 scene=$2 sanitized=$3
seconds=60
if [ "$sanitized" != ON ]; then
  ulimit -v 1000000
  seconds=5
fi
rm -rf work && mkdir work && cd work || exit 1

fail() {
  echo "odd_input.sh: $*"
  cat -v said
  exit 1
}
# refused TEXT WORDS...
refused() {
  local text=$1 got=0
  shift
  timeout $seconds "$program" "$@" > said 2>&1 || got=$?
  ((got == 2)) || fail "expected status 2, got $got: $(printf '%q ' "$@")"
  grep -qF -- "$text" said || fail "expected to be told '$text': $(printf '%q ' "$@")"
  iconv -f UTF-8 -t UTF-8 < said > again 2> /dev/null || fail "not UTF-8: $(printf '%q ' "$@")"
  if LC_ALL=C grep -q $'[\x01-\x08\x0b-\x1f\x7f]' said || LC_ALL=C grep -q $'\xc2[\x80-\x9f]' said; then
    fail "a control character: $(printf '%q ' "$@")"
  fi
}

printf , > comma.yaml
refused "comma.yaml:1: expected one YAML document" check comma.yaml
refused "--set limits.period=,: expected one YAML document" check "$scene" --set limits.period=,
refused "--set events.periods=[1,2],: expected one" check "$scene" --set 'events.periods=[1,2],'

mkfifo pipe
refused "pipe: expected a scene file that can be read, got a pipe" check pipe
refused "/dev/zero: expected a scene file that can be read, got a device" check /dev/zero
mkfifo archive.h5
refused "archive.h5' is a pipe; an Orbweaver atlas was expected. Give" show archive.h5
refused "/dev/zero' is a device" show /dev/zero
printf 'system: {model_file: pipe}\nstarts: {}\n' > model.yaml
refused "model.yaml:1: system.model_file: expected the file of a model, told from the scene's folder, got a pipe" check model.yaml
ln -s circle circle
ln -s nowhere broken
mkdir survey && ln -s atlas.h5 survey/atlas.h5
refused "circle: expected a scene file that can be read, got a link in a circle; check" check circle
refused "broken: expected a scene file that can be read, got a link to nothing" check broken
refused "survey/atlas.h5' is a link in a circle; an Orbweaver atlas was expected. Give" show survey
touch locked && chmod 0 locked
[ -r locked ] || refused "locked: expected a scene file that can be read, got one that may not be read" check locked

# 8 million unknowns take more than the limit above leaves.
for command in check "survey -o out"; do
  [ "$sanitized" = ON ] && break
  refused "continuation.cutoff: expected orbits that fit into the memory at hand, 0.545 GiB beside the program" $command "$scene" \
    --set 'continuation.cutoff=[1000000, 1000000]'
done
yes '[1, 2],' | head -c 3000000 > long.yaml
refused "a scene of 3000000 bytes" check long.yaml
refused "at most 32 keys joined by dots" check "$scene" --set "$(printf 'a.%.0s' {1..20000})a=1"
many=()
for n in {1..1000}; do many+=(--set "limits.period=$n"); done
refused "at most 200 overrides" check "$scene" "${many[@]}"

refused 'na\xe2\x80\xaeme' check "$scene" --set $'na\xe2\x80\xaeme=3'
refused 'got the byte 0xff' check "$scene" --set $'name=a\xff'
refused 'na\x1b[31m' check "$scene" --set $'na\x1b[31m=3'
refused 'nowhere\x1b[31m\xff' check $'nowhere\x1b[31m\xff'
refused 'nowhere\x1b[31m\xff' show $'nowhere\x1b[31m\xff'
refused 'got `\x1b[31m\xc2\x9b`' $'\x1b[31m\xc2\x9b'
refused '--\x1b[31m' check "$scene" $'--\x1b[31m'
refused 'expected no PETSc options, got `\x1b`' check "$scene" -- $'\x1b'
printf '"na\\e[31m\\x85": 1\n' > key.yaml
refused 'na\x1b[31m\xc2\x85' check key.yaml
printf '"a\\nb": 1\n' > key.yaml
refused 'key.yaml:1: a\nb: unknown key' check key.yaml

refused 'got ``' ''
refused '--output: expected a path, got nothing' survey "$scene" -o ''
refused '--walltime: expected seconds' survey "$scene" -o out --walltime ''
refused 'directory: expected a path, got nothing' consolidate ''
[ ! -e segments ] && [ ! -e out ] || fail "something was written"
