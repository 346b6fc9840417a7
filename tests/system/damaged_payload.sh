#!/bin/bash
# Payloads on disk that are damaged while the survey runs: it ends with status 3 and the name of the file at the flush after one was
# read, and no checkpoint counts on what was made of it. A resume comes to the archive of an undisturbed run from the checkpoint before,
# or, where that counts on the damaged ones too, is refused with their name. Arguments: those of survey_runs.sh.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 1 || fail "the undisturbed run failed"
for ranks in 1 2; do
  : > "$folder/log"
  held 3 "write segment-000001.h5" survey damaged$ranks $ranks &
  job=$!
  wait_until_held $job
  files=("$folder/damaged$ranks"/segments/payloads-*)
  [ -e "${files[0]}" ] || fail "no payload was on disk at the first flush"
  for file in "${files[@]}"; do dd if=/dev/zero of="$file" bs=1000 count=$(($(stat -c %s "$file") / 1000)) conv=notrunc status=none; done
  wait $job
  status=$?
  [ $status = 3 ] || fail "status $status instead of 3"
  grep -q 'segments/payloads-.*checksum is wrong' "$folder/log" || fail "the file is not named"
  grep -q "The last checkpoint stands" "$folder/log" || fail "it is not said what stands"
  : > "$folder/log"
  survey damaged$ranks $((3 - ranks)) --resume
  status=$?
  case $status in
    0) expect_same damaged$ranks ;;
    2)
      grep -q 'segments/payloads-.*checksum is wrong' "$folder/log" || fail "the refusal does not name the file"
      grep -q "nothing was changed" "$folder/log" || fail "it is not said that nothing was changed"
      ;;
    *) fail "the resume ended with status $status" ;;
  esac
  echo "$ranks ranks: resumed with status $status"
done
echo "damaged payloads end a run by name, and no checkpoint counts on what was made of them"
