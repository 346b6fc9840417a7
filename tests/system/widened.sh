#!/bin/bash
# Resumes finished surveys with wider limits; the archive must be the one that the wide limits give at once.
# Arguments: those of survey_runs.sh, with the wide limits.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

# Files of payloads with their sizes.
payloads_of() {
  (cd "$folder/$1/segments" && stat -c '%n %s' payloads-*)
}

n=0
for narrow in "limits.period=17" "survey.depth=0" "survey.depth=1 limits.period=15" "limits.energy=[-3,0.5]" \
  "limits.steps=12" "limits.families=5"; do
  n=$((n + 1))
  words=()
  for limit in $narrow; do words+=(--set "$limit"); done
  survey widened$n 2 "${words[@]}" || fail "$narrow: the narrow run failed"
  # What no wider limit can ask for is gone; where that is nothing (depth 0) both ranks' files stay.
  [ "$n" = 2 ] || [ "$(payloads_of widened$n | wc -l)" = 1 ] || fail "$narrow: payloads were kept: $(payloads_of widened$n)"
  "$compare" "$folder/whole/atlas.h5" "$folder/widened$n/atlas.h5" > /dev/null 2>&1 && fail "$narrow: cuts nothing off"
  survey widened$n 2 && fail "$narrow: begun without --resume"
  [ "$n" != 1 ] || grep -q "holds a finished survey with narrower limits" "$folder/log" || fail "$narrow: told otherwise"
  survey widened$n 3 --resume || fail "$narrow: the resume with wider limits failed"
  expect_same widened$n
  before=$(payloads_of widened$n)
  survey widened$n 2 --resume || fail "$narrow: a finished survey was not accepted"
  [ "$(payloads_of widened$n)" = "$before" ] || fail "$narrow: payloads were moved again: $(payloads_of widened$n)"
  echo "$narrow: widened"
done
survey widened1 2 --resume --set limits.period=14
[ $? = 2 ] || fail "narrower limits must be refused with status 2"
grep -q "limits.period was .* and is 14 (a limit can only be made wider)" "$folder/log" || fail "the key must be named"
survey widened1 2 --resume --set system.parameters.m2=2
[ $? = 2 ] || fail "another scene must be refused with status 2"
grep -q "system.parameters.m2 was 1 and is 2" "$folder/log" || fail "the key must be named"
expect_same widened1
