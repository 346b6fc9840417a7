#!/usr/bin/env bash
# check.sh ROOT BUILD RULES: reads every command of ROOT/README.md and ROOT/docs/*.md without running any. It fails on a block without a
# language, on a line beside commands that is none, on a rule of RULES that holds for no command, and on a rule `elsewhere` whose CTest
# there is not. With a document's test (tests/documents/CMakeLists.txt) for each, every command is run or has its reason in RULES.
set -euo pipefail
root=$1 build=$2 rules=$3
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
. "$here/read.sh"
. "$here/rules.sh"
faults=0 count=0
say() {
  echo "$*" >&2
  faults=$((faults + 1))
}
read_rules "$rules"
declare -A count_of
on_file() { :; }
on_fault() { say "$document:$1: $2"; }
on_command() {
  judge "$(name_of_document "$document")" "$(without_comment "$2")"
  count_of[$verdict]=$((${count_of[$verdict]:-0} + 1))
  count=$((count + 1))
}
for document in "$root"/README.md "$root"/docs/*.md; do read_document "$document"; done

tests=$(ctest --test-dir "$build" -N | sed -n 's/^ *Test *#[0-9]*: //p')
for n in "${!rule_documents[@]}"; do
  rule="${rule_documents[n]} :: ${rule_patterns[n]} :: ${rule_verbs[n]}"
  ((rule_uses[n] > 0)) || say "rules: no command of a document is meant by $rule"
  [[ "${rule_verbs[n]}" != elsewhere ]] || grep -qxF -- "${rule_texts[n]}" <<<"$tests" ||
    grep -rqF --include=CMakeLists.txt -- "${rule_texts[n]}" "$root/tests" || # one that this machine's packages do not allow
    say "rules: there is no CTest ${rule_texts[n]}, which $rule names"
done
((count > 0)) || say "no commands in $root"
((faults == 0)) || { echo "$faults faults" >&2 && exit 1; }
for verdict in "${!count_of[@]}"; do echo "$verdict: ${count_of[$verdict]}"; done
echo "$count commands"
