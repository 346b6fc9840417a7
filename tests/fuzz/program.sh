#!/bin/bash
# program.sh PROGRAM FUZZ SCENE COUNT SANITIZED: gives the program itself COUNT inputs each of scenes, --set and archives. Each must be taken or
# refused, status 0 or 2, within 5 s of a processor (a minute by the clock) and 1 GB of addresses, and all that is printed must be
# text without control characters. AddressSanitizer reserves terabytes of addresses: SANITIZED is ON where there can be no such limit,
# and ten times as many seconds.
set -u
program=$1 fuzz=$2 scene=$3 count=$4 sanitized=$5
seconds=50
if [ "$sanitized" != ON ]; then
  ulimit -v 1000000
  seconds=5
fi

fail() {
  echo "program.sh: $*"
  cat -v said
  exit 1
}
taken=0 refused=0
# expect_answer WHAT WORDS...
expect_answer() {
  local what=$1 got=0
  shift
  (ulimit -t $seconds && exec timeout $((12 * seconds)) "$program" "$@") > said 2>&1 || got=$?
  case $got in
    0) taken=$((taken + 1)) ;;
    2) refused=$((refused + 1)) ;;
    *) fail "$what: status $got" ;;
  esac
  iconv -f UTF-8 -t UTF-8 < said > again 2> /dev/null || fail "$what: not UTF-8"
  if LC_ALL=C grep -q $'[\x01-\x08\x0b-\x1f\x7f]' said || LC_ALL=C grep -q $'\xc2[\x80-\x9f]' said; then
    fail "$what: a control character"
  fi
}

for kind in scenes grown_scenes overrides archives; do
  rm -rf $kind && mkdir $kind && cd $kind || exit 1
  "$fuzz" $kind --write "$count" || exit 1
  for ((n = 0; n < count; n++)); do
    case $kind in
      archives) expect_answer "$kind $n" show input-$n ;;
      overrides)
        words=()
        while IFS= read -r line; do words+=(--set "$line"); done < input-$n
        expect_answer "$kind $n" check "$scene" "${words[@]}"
        ;;
      *) expect_answer "$kind $n" check input-$n ;;
    esac
  done
  cd ..
done
echo "$((taken + refused)) inputs: $taken taken, $refused refused"
