#!/usr/bin/env bash
# inline.sh ROOT PROGRAM: commands within sentences, `orbweaver COMMAND ... --option`, in README.md and docs/*.md: each names a command that
# there is, and options that it has.
set -euo pipefail
root=$1 program=$2
declare -A section_of
command=''
while IFS= read -r line; do
  if [[ "$line" == '## orbweaver '* ]]; then
    command=${line#'## orbweaver '}
  elif [[ "$line" == '## orbweaver' ]]; then
    command=before
  elif [[ -n "$command" && "$line" == '| `'* ]]; then
    section_of[$command]+=" ${line%%'` '*} "
  fi
done < <("$program" manual programs)
((${#section_of[@]} >= 10)) || { echo "the manual has ${#section_of[@]} commands" >&2 && exit 1; }

faults=0 count=0
say() {
  echo "$*" >&2
  faults=$((faults + 1))
}
while IFS= read -r found; do
  where=${found%%:\`*} text=${found#*:\`}
  text=${text%\`}
  count=$((count + 1))
  read -ra words <<<"${text//[^A-Za-z0-9=_. -]/ }"
  command=${words[1]-}
  if [[ "$command" == -* && "$command" != --help ]]; then
    [[ "${section_of[before]-}" =~ \`$command[\ \`] ]] || say "$where: orbweaver has no $command"
    words=("${words[0]}" "${words[@]:3}") # the option and its value
    command=${words[1]-}
    [[ -n "$command" ]] || continue
  elif [[ "$command" == --help ]]; then
    continue
  fi
  [[ -n "${section_of[$command]-}" || "$command" == COMMAND ]] || { say "$where: there is no command $command" && continue; }
  for word in "${words[@]:2}"; do
    [[ "$word" == --?* && "$word" != --help ]] || continue
    [[ "${section_of[$command]}" =~ [\ \`]${word%%=*}[\ \`,] ]] || say "$where: orbweaver $command has no ${word%%=*}"
  done
done < <(cd "$root" && grep -noE '`orbweaver [^`]+`' README.md docs/*.md | sed -E 's/^([^:]+:[0-9]+):/\1:/')
((faults == 0)) || { echo "$faults of $count commands" >&2 && exit 1; }
((count > 0)) || { echo "no commands in $root" >&2 && exit 1; }
echo "$count commands within sentences have the options that they are given"
