#!/bin/bash
# odd_output.sh PROGRAM SCENE: files to write that are those that are read, folders, devices, or nowhere. Each is refused before any
# work is done, what was there stays as it was, and nothing is left.
set -u
program=$1 scene=$2
export OMPI_MCA_rmaps_base_oversubscribe=1
rm -rf work && mkdir work && cd work || exit 1

fail() {
  echo "odd_output.sh: $*"
  cat -v said
  exit 1
}
# ended STATUS TEXT WORDS...
ended() {
  local status=$1 text=$2 got=0
  shift 2
  timeout 30 "$program" "$@" > said 2>&1 || got=$?
  ((got == status)) || fail "expected status $status, got $got: $(printf '%q ' "$@")"
  [ -z "$text" ] || grep -qF -- "$text" said || fail "expected to be told '$text': $(printf '%q ' "$@")"
}

cp "$scene" scene.yaml
"$program" survey scene.yaml -o out --quiet --set limits.period=5 --set survey.depth=0 > said 2>&1 || fail "no survey"
cp out/atlas.h5 atlas.h5
mkdir folder
ln -s atlas.h5 link.svg
sums=$(sha1sum atlas.h5 scene.yaml)

itself="it is the file that is read"
ended 2 "$itself" export atlas.h5 --format csv -o atlas.h5
ended 2 "$itself" export atlas.h5 --format csv -o link.svg
ended 2 "$itself" export atlas.h5 --format auto --family Out-Phase -o s.out --equations ./atlas.h5
ended 2 "$itself" plot atlas.h5 tree -o link.svg
ended 2 "$itself" page . -o atlas.h5
ended 0 "Out-Phase" export . --format csv -o /dev/stdout
ended 2 "$itself" page atlas.h5 -o atlas.h5
ended 2 "$itself" refine atlas.h5 Out-Phase 3 -o atlas.h5
ended 2 "$itself" verify atlas.h5 --prove Out-Phase 3 -o atlas.h5
ended 2 "$itself" sweep scene.yaml --csv scene.yaml
ended 2 "--equations in another file" export atlas.h5 --format auto --family Out-Phase -o s.out --equations s.out
[ "$sums" = "$(sha1sum atlas.h5 scene.yaml)" ] || fail "what was read is another now"

for where in "it is a folder:2:folder" "is there such a folder?:3:nowhere/file"; do
  IFS=: read -r text status path <<< "$where"
  ended "$status" "$text" export atlas.h5 --format csv -o "$path"
  ended "$status" "$text" page atlas.h5 -o "$path"
  ended "$status" "$text" refine atlas.h5 Out-Phase 3 -o "$path"
  ended "$status" "$text" verify atlas.h5 --prove Out-Phase 3 -o "$path" --quiet
  ended "$status" "$text" sweep scene.yaml --csv "$path"
done
mkdir folder/picture.svg
ended 2 "it is a folder" plot atlas.h5 tree -o folder/picture.svg
TMPDIR=/nowhere ended 3 "TMPDIR names no folder" plot atlas.h5 tree -o picture.svg

# Devices stay where they are.
ended 3 "is the disk full?" export atlas.h5 --format csv -o /dev/full
link=$(ls -l /dev/stdout)
ended 0 "Out-Phase" export atlas.h5 --format csv -o /dev/stdout
ended 0 "" export atlas.h5 --format csv -o /dev/null
[ -c /dev/full ] && [ -c /dev/null ] && [ "$link" = "$(ls -l /dev/stdout)" ] || fail "a device is gone"
ended 2 "proofs need a file" verify atlas.h5 --prove Out-Phase 3 -o /dev/null

# Whatever has the name of a file on its way stays as it is, and is not waited for: links to other files, to the archive that is
# read, second names of files, pipes and folders.
echo victim > victim
victims=$(sha1sum victim atlas.h5)
for way in way way.svg; do
  ln -s victim $way.part
  ln -s atlas.h5 $way.1.part
  ln victim $way.2.part
  mkfifo $way.3.part
  mkdir $way.4.part
  ln -s nowhere/file $way.5.part
done
links=$(ls -l --time-style=+ way.*part way.svg.*part)
for words in "export atlas.h5 --format csv" "page atlas.h5" "refine atlas.h5 Out-Phase 3" \
  "verify atlas.h5 --prove Out-Phase 3 --quiet"; do
  rm -f way
  ended 0 "" $words -o way
  [ -s way ] && [ ! -L way ] || fail "nothing was written: $words"
done
ended 0 "" sweep scene.yaml --csv way
ended 0 "" plot atlas.h5 tree -o way.svg
ended 2 "no family" plot atlas.h5 tree --family Nobody -o way.svg
[ "$victims" = "$(sha1sum victim atlas.h5)" ] || fail "another file was written through a link"
[ "$links" = "$(ls -l --time-style=+ way.*part way.svg.*part)" ] || fail "what had a name is gone"
rm -r way way.svg way.*part
# Two at once: both end well, and the file is one of theirs.
for n in 1 2 3; do
  "$program" export atlas.h5 --format csv -o both > said1 2>&1 &
  first=$!
  ended 0 "" page atlas.h5 -o both
  wait $first || fail "the other of two at once failed: $(cat said1)"
done
"$program" export atlas.h5 --format csv > one && "$program" page atlas.h5 -o other > said 2>&1 || fail "alone"
cmp -s both one || cmp -s both other || fail "two at once have left what is neither's"
rm both one other
# A survey's own names: links there go, what they lead to stays.
mkdir -p stopped
ln -s ../victim stopped/atlas.h5.part
ended 0 "" survey scene.yaml -o stopped -q --set limits.period=5 --set survey.depth=0
rm stopped/atlas.h5
ln -s ../../victim stopped/segments/checkpoint.part
ln victim stopped/segments/segment-000002.h5.part
ln -s ../victim stopped/atlas.h5.part
ended 0 "" survey scene.yaml -o stopped --resume -q --set limits.period=6 --set survey.depth=0
[ "$victims" = "$(sha1sum victim atlas.h5)" ] || fail "another file was written through a link in a survey's folder"
rm -r stopped
mkdir stopped
mkfifo stopped/atlas.h5.part
ended 3 "stopped/atlas.h5.part" survey scene.yaml -o stopped -q --set limits.period=5 --set survey.depth=0
rm -f stopped/atlas.h5.part
mkfifo stopped/segments/checkpoint.part
ended 3 "stopped/segments/checkpoint.part" survey scene.yaml -o stopped --resume -q --set limits.period=5 --set survey.depth=0
rm -f stopped/segments/checkpoint.part
ended 0 "" survey scene.yaml -o stopped --resume -q --set limits.period=5 --set survey.depth=0

# What PETSc would read by itself.
mkfifo .petscrc
ended 0 "" survey scene.yaml -o without_petscrc -q --set limits.period=5 --set survey.depth=0
rm .petscrc

# Results for which nobody is there.
got=0
"$program" export atlas.h5 --format csv >&- 2> said || got=$?
((got == 3)) && grep -qF "or the output closed?" said || fail "a closed output: status $got"

for words in --version --help "survey --help"; do
  got=0
  "$program" $words > /dev/full 2> said || got=$?
  ((got == 3)) && grep -qF "is the disk full" said || fail "$words to a full disk: status $got"
done

long=$(printf 'x%.0s' {1..300})
ended 3 ": File name too long" survey scene.yaml -o "$long"
left=$(find . -name '*.part')
[ -z "$left" ] || fail "left over: $left"

# Numbers that are none, or that no double is.
for number in 1e400 1e-400; do
  ended 2 "has no orbit with T = $number" refine atlas.h5 Out-Phase T=$number
done
for tolerance in nan inf 1e400 0 -1; do
  ended 2 "--tolerance: expected a number above 0" compare atlas.h5 atlas.h5 --tolerance=$tolerance
done
ended 2 "--loops: expected a number from 0 on" compare atlas.h5 atlas.h5 --loops=-1
echo "all refused"
