#!/usr/bin/env bash
# damaged.sh CASE PROGRAM COMPARE BROKEN WHOLE SCENE [--set ...]: damages a copy of BROKEN/out, a survey that was ended by a full disk
# and has two checkpoints, and resumes it on 1, 2 and 3 ranks. It must either come to the archive WHOLE, or be refused with status 2
# and nothing changed, and say why.
set -eu
case=$1 program=$2 compare=$3 broken=$4 whole=$5
shift 5

fail() {
  echo "damaged.sh: $*" >&2
  exit 1
}
first() { find out/segments -name "$1" | sort | head -n 1; }
last() { find out/segments -name "$1" | sort | tail -n 1; }
cut_short() { truncate -s "$(($(stat -c %s "$1") - 1))" "$1"; }
# put BYTES_IN_OCTAL OFFSET FILE; a negative offset counts from the end
put() {
  local at=$2
  ((at >= 0)) || at=$(($(stat -c %s "$3") + at))
  printf "%b" "$1" | dd of="$3" bs=1 seek="$at" conv=notrunc status=none
}
sums() { find out -type f ! -name lock | sort | xargs sha256sum; }

status=0 says=() options=()
damage() {
  case $case in
    as_it_is) ;;
    torn_last_segment) cut_short "$(last 'segment-*')" ;;
    deleted_last_segment) rm "$(last 'segment-*')" ;;
    torn_journal) cut_short out/segments/journal-000001 ;;
    torn_checkpoint) cut_short out/segments/checkpoint ;;
    wrong_checksum) put '\0377\0376\0375\0374' -40 out/segments/checkpoint ;;
    part_files) cp "$(last 'segment-*')" "$(last 'segment-*').part" && echo torn >out/segments/checkpoint.part && echo torn >out/atlas.h5.part ;;
    torn_first_segment) cut_short "$(first 'segment-*')" ;;
    deleted_first_segment) rm "$(first 'segment-*')" ;;
    exchanged_segments)
      mv "$(first 'segment-*')" out/between
      cp "$(last 'segment-*')" out/segments/segment-000001.h5
      rm out/between
      ;;
    deleted_payloads) rm out/segments/payloads-* ;;
    changed_payloads)
      for file in out/segments/payloads-*; do
        for ((at = 0; at < $(stat -c %s "$file"); at += 4000)); do put '\0252' $at "$file"; done
      done
      ;;
    no_checksum_holds)
      put '\0377\0376\0375\0374' -40 out/segments/checkpoint
      put '\0377\0376\0375\0374' -40 out/segments/checkpoint.previous
      ;;
    newer_version)
      put '\0143' 8 out/segments/checkpoint
      ;;
    link_to_itself) ln -sf checkpoint out/segments/checkpoint ;;
    folder) rm out/segments/checkpoint && mkdir out/segments/checkpoint ;;
    newer_previous) cut_short out/segments/checkpoint && put '\0143' 8 out/segments/checkpoint.previous ;;
    other_scene | narrower) ;;
    *) fail "unknown case $case" ;;
  esac
}
fallback="going on from the checkpoint before the last one"
case $case in
  as_it_is | part_files) says=("going on: ") ;;
  torn_last_segment) says=("$fallback" "segments/segment-" "were written: it is torn") ;;
  deleted_last_segment) says=("$fallback" "segments/segment-" "does not exist") ;;
  torn_journal) status=2 says=("segments/journal-000001: it should hold" "it is torn" "nothing was changed" "from a copy") ;;
  torn_checkpoint) says=("$fallback" "segments/checkpoint: " "it is torn") ;;
  wrong_checksum) says=("$fallback" "segments/checkpoint: its checksum is wrong") ;;
  torn_first_segment) status=2 says=("segment-000001.h5" "were written: it is torn" "nothing was changed" "from a copy") ;;
  deleted_first_segment) status=2 says=("segment-000001.h5" "does not exist" "has to come from a copy" "nothing was changed" "from a copy") ;;
  exchanged_segments) status=2 says=("segment-000001.h5" "nothing was changed" "from a copy") ;;
  deleted_payloads) says=("$fallback" "segments/payloads-" "bytes from" "the file is not there") ;;
  changed_payloads) says=("$fallback" "segments/payloads-" "bytes from" "checksum is wrong: they were damaged") ;;
  no_checksum_holds) status=2 says=("checkpoint: its checksum is wrong" "checkpoint.previous: its checksum is wrong" "nothing was changed") ;;
  newer_version) status=2 says=("its version is 99" "use the newer") ;;
  link_to_itself) says=("$fallback" "segments/checkpoint: it cannot be looked at") ;;
  folder) says=("$fallback" "segments/checkpoint: it is not a regular file" "is now out/segments/checkpoint.folder") ;;
  newer_previous) status=2 says=("checkpoint.previous: its version is 99" "use the newer") ;;
  other_scene)
    status=2 options=(--set system.parameters.g=1.5)
    says=("holds a survey of another scene: system.parameters.g was 1 and is 1.5" "give another folder with -o")
    ;;
  narrower)
    status=2 options=(--set limits.period=11)
    says=("limits.period was 12 and is 11" "can only be made wider")
    ;;
esac

# A flush without rows may have come between the last segment and the full disk: then both checkpoints list it.
if [[ $case == *_last_segment ]] && grep -aqF "$(basename "$(cd "$broken" && last 'segment-*')")" "$broken/out/segments/checkpoint.previous"; then
  status=2 says[0]="nothing was changed"
fi
# So may tasks whose payloads are on disk.
if [[ $case == *_payloads ]]; then
  grep -aqF "stored work" "$broken/out/segments/checkpoint" || fail "the newest checkpoint counts on no payload on disk"
  if grep -aqF "stored work" "$broken/out/segments/checkpoint.previous"; then
    status=2 says[0]="nothing was changed"
  fi
fi

for ranks in 1 2 3; do
  rm -rf out
  cp -r "$broken/out" out
  damage
  sums >before
  run=()
  ((ranks == 1)) || run=(mpirun -n "$ranks")
  got=0
  "${run[@]}" "$program" survey "$@" "${options[@]}" -o out --resume --progress lines >said 2>&1 || got=$?
  cat said
  ((got == status)) || fail "$case on $ranks ranks: expected status $status, got $got"
  for text in "${says[@]}"; do
    grep -qF -- "$text" said || fail "$case on $ranks ranks: expected to be told: $text"
  done
  if ((status == 0)); then
    "$compare" "$whole" out/atlas.h5 || fail "$case on $ranks ranks: the archive is another"
  else
    sums >after
    diff before after || fail "$case on $ranks ranks: something was changed"
    (($(grep -ci "nothing was changed" said) == 1)) || fail "$case on $ranks ranks: the refusal does not stand there once"
  fi
done
