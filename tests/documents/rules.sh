# Sourced: the rules of rules.txt for commands of documents.
rule_documents=() rule_patterns=() rule_verbs=() rule_texts=() rule_uses=()

name_of_document() {
  local name=${1##*/}
  printf '%s' "${name%.md}"
}

# The command without what stands behind a # that begins a word, as a shell leaves it out; quotes are not looked into.
without_comment() {
  local text=$1
  [[ "$text" =~ ^([^#]*[^#[:space:]])[[:space:]]+#.*$ ]] && text=${BASH_REMATCH[1]}
  text=${text%"${text##*[![:space:]]}"}
  printf '%s' "$text"
}

# read_rules FILE: lines DOCUMENT :: PATTERN :: VERB :: TEXT, of which the first two are patterns of bash.
read_rules() {
  local line number=0 rest
  while IFS= read -r line; do
    number=$((number + 1))
    [[ -n "$line" && "$line" != '#'* ]] || continue
    rest=$line
    local columns=()
    while [[ "$rest" == *' :: '* && ${#columns[@]} -lt 3 ]]; do
      columns+=("${rest%%' :: '*}")
      rest=${rest#*' :: '}
    done
    columns+=("$rest")
    case "${#columns[@]} ${columns[2]-}" in
      '4 never' | '4 elsewhere' | '4 long' | '4 needs' | '4 add' | '4 instead' | '4 status') ;;
      *) echo "$1:$number: expected DOCUMENT :: PATTERN :: VERB :: TEXT, got $line" >&2 && exit 2 ;;
    esac
    rule_documents+=("${columns[0]}") rule_patterns+=("${columns[1]}") rule_verbs+=("${columns[2]}")
    rule_texts+=("${columns[3]}") rule_uses+=(0)
  done <"$1"
}

# judge DOCUMENT COMMAND: sets verdict (run, never, elsewhere, long) with its reason, needs, expected (status), added and instead.
judge() {
  local n
  verdict=run reason='' needs='' expected=0 added='' instead=''
  for n in "${!rule_documents[@]}"; do
    # shellcheck disable=SC2053
    [[ "$1" == ${rule_documents[n]} && "$2" == ${rule_patterns[n]} ]] || continue
    rule_uses[n]=$((rule_uses[n] + 1))
    case "${rule_verbs[n]}" in
      never | elsewhere | long)
        verdict=${rule_verbs[n]} reason=${rule_texts[n]}
        [[ "$verdict" == long ]] || return 0
        ;;
      needs) needs=${rule_texts[n]} ;;
      add) added+=" ${rule_texts[n]}" ;;
      instead) instead=${rule_texts[n]} ;;
      status) expected=${rule_texts[n]} ;;
    esac
  done
}

# filled COMMAND: as it is run, after judge.
filled() {
  local text=${instead:-$1} word filled='' ranks=''
  local IFS=' '
  set -f
  for word in $text; do
    case "$word" in
      SCENE) word=drivers/scenes/double_pendulum.yaml ;;
      ATLAS) word=out/double_pendulum/atlas.h5 ;;
      FAMILY) word=In-Phase ;;
      DIR | DIR/*) word=dir${word#DIR} ;;
      BUILD/*) word=build/release${word#BUILD} ;;
      BUILD) word=build/release ;;
    esac
    [[ "$ranks" != yes || "$word" -le 3 ]] || word=2
    ranks=''
    [[ "$word" == -n && "$filled" == *mpirun ]] && ranks=yes
    filled+="${filled:+ }$word"
  done
  set +f
  printf '%s' "$filled$added"
}
