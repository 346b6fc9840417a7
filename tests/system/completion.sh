#!/bin/bash
# completion.sh PROGRAM: what `completion bash` prints completes commands, options and files; fish and zsh, where they are installed, read
# theirs; the manual names every command, and groff, where it is installed, has no warning.
set -eu
program=$1
fail() { echo "completion.sh: $*"; exit 1; }

source <("$program" completion bash)
# completed WORDS...: what the last of them can become, in a line.
completed() {
  COMP_WORDS=(orbweaver "$@") COMP_CWORD=$#
  COMPREPLY=()
  _orbweaver
  echo "${COMPREPLY[*]-}"
}
expect() { [[ $1 == "$2" ]] || fail "expected '$2', got '$1'"; }
touch scene_a.yaml scene_b.yaml
expect "$(completed co)" "compare completion consolidate cost"
expect "$(completed survey --res)" "--resume"
expect "$(completed show --res)" ""
expect "$(completed survey scene_)" "scene_a.yaml scene_b.yaml"

expect "$(completed --ranks 2 sur)" "survey"
expect "$(completed --ranks 2 survey --res)" "--resume"

for command in $(completed ""); do
  [[ $command == -* ]] || "$program" "$command" --help | grep -q '^Example' || fail "$command --help has no example"
done

# What zsh's own functions would be given.
if command -v zsh > /dev/null; then
  cat > completed.zsh << 'ZSH'
compdef() { : }
_describe() { local -a found=(${(P)${@[-1]}}); print -l -- ${(M)found:#$PREFIX*} }
_files() { print files }
source completion.zsh
words=(orbweaver "$@") CURRENT=$(( $# + 1 )) PREFIX=${@[-1]}
_orbweaver
ZSH
  "$program" completion zsh > completion.zsh
  expect "$(zsh -f completed.zsh co | cut -d: -f1 | paste -sd' ')" "compare completion consolidate cost"
  expect "$(zsh -f completed.zsh survey --res | cut -d: -f1)" "--resume"
  expect "$(zsh -f completed.zsh --ranks 2 sur | cut -d: -f1)" "survey"
  expect "$(zsh -f completed.zsh survey scene_)" "files"
fi
for shell in zsh fish; do
  "$program" completion $shell > completion.$shell
  ! command -v $shell > /dev/null || $shell -n completion.$shell || fail "$shell cannot read its completion"
done
status=0
"$program" completion tcsh > said 2>&1 || status=$?
[[ $status == 2 ]] && grep -q 'bash,zsh,fish' said || fail "tcsh: status $status: $(cat said)"

"$program" manual > orbweaver.1
for command in $(completed ""); do
  [[ $command == -* ]] || grep -q "^\.SS ${command//-/\\\\-}$" orbweaver.1 || fail "the manual lacks $command"
done
if command -v groff > /dev/null; then
  groff -ww -man -T utf8 orbweaver.1 2>&1 > /dev/null | tee warnings
  [[ ! -s warnings ]] || fail "the manual has warnings"
fi
