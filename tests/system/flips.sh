#!/bin/bash
# Flips bits, zeroes bytes and cuts files of a survey's folder, segments, journals, checkpoints and archive alike, and resumes it.
# It must come to the archive of an undisturbed run, or be refused with status 2 and the name of the file. Before that `consolidate` makes
# the archive of what there is, which must be that of the last checkpoint, or of the one before if it says so, or refuses likewise.
# Arguments: those of survey_runs.sh, the first of the options being how many times (places are drawn with a fixed seed).
. "$(dirname "$0")/survey_runs.sh"
times=${options[0]}
options=("${options[@]:1}")
begin_anew
survey whole 1 || fail "the undisturbed run failed"
held 2 "write segment-000003.h5" survey stopped 1 &
job=$!
wait_until_held $job
kill -TERM "$(ranks_of stopped | head -1)"
wait $job
[ $? = 4 ] || fail "the survey that was to be stopped came to its end"
cp -r "$folder/whole" "$folder/finished"
cp -r "$folder/stopped" "$folder/last"
cp -r "$folder/stopped" "$folder/previous"
: > "$folder/previous/segments/checkpoint"
for part in last previous; do
  "$program" consolidate "$folder/$part" >> "$folder/log" 2>&1
  [ $? = 4 ] || fail "there is no archive of the $part checkpoint"
done
"$compare" "$folder/last/atlas.h5" "$folder/previous/atlas.h5" >> "$folder/log" 2>&1 && fail "both checkpoints give the same archive"

# consolidated NAME: that of FOLDER/NAME, as far as it had come, in a copy
consolidated() {
  rm -rf "$folder/part"
  cp -r "$folder/$1" "$folder/part"
  : > "$folder/log"
  (ulimit -v 4000000 && timeout 60 "$program" consolidate "$folder/part") >> "$folder/log" 2>&1
  case $? in
    4)
      "$compare" "$folder/last/atlas.h5" "$folder/part/atlas.h5" >> "$folder/log" 2>&1 && return
      "$compare" "$folder/previous/atlas.h5" "$folder/part/atlas.h5" >> "$folder/log" 2>&1 || fail "$what: consolidate gives another archive"
      ;;
    2) ;;
    *) fail "$what: consolidate ends with another exit status" ;;
  esac
  grep -qF "$(basename "$file")" "$folder/log" || fail "$what: consolidate does not name the file"
}

RANDOM=20
same=0 refused=0
for ((n = 0; n < times; n++)); do
  from=stopped
  ((n % 4)) || from=finished
  rm -rf "$folder/changed"
  cp -r "$folder/$from" "$folder/changed"
  mapfile -t files < <(find "$folder/changed" -type f -size +0 | sort)
  file=${files[RANDOM % ${#files[@]}]}
  bytes=$(stat -c %s "$file")
  at=$(((RANDOM * 32768 + RANDOM) % bytes))
  old=$(od -An -tu1 -j $at -N 1 "$file" | tr -d ' ')
  case $((RANDOM % 3)) in
    0) new=$((old ^ (1 << (RANDOM % 8)))) ;;
    1) new=$((old == 0 ? 255 : 0)) ;;
    2) new=cut ;;
  esac
  if [ "$new" = cut ]; then
    truncate -s $at "$file"
  else
    printf "%b" "\\0$(printf '%o' "$new")" | dd of="$file" bs=1 seek=$at conv=notrunc status=none
  fi
  what="${file#"$folder"/} at $at: $old -> $new"
  [ $from = finished ] || consolidated changed
  : > "$folder/log"
  (ulimit -v 4000000 && timeout 60 "$program" survey "$scene" -o "$folder/changed" --quiet "${options[@]}" --resume) >> "$folder/log" 2>&1
  case $? in
    0) expect_same changed && same=$((same + 1)) ;;
    2)
      grep -qF "$(basename "$file")" "$folder/log" || fail "$what: the refusal does not name the file"
      refused=$((refused + 1))
      ;;
    *) fail "$what: another exit status" ;;
  esac
done
echo "$times changes: $same archives of the undisturbed run, $refused refusals by name"
