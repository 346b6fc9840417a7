# Sourced: reads a document's commands and files, in the order in which they stand.
#
# read_document DOCUMENT calls
#   on_command LINE COMMAND   for a command: a line of a block ```sh; a line of an indented block that begins with one of the words
#                             below; `python3 NAME` behind a block ```python NAME. What follows a backslash at its end belongs to it.
#   on_file LINE NAME TEXT    for a block ```LANGUAGE NAME: a file that the commands after it find
#   on_fault LINE WHAT        for a block ``` of no language, and for a line beside commands that is neither a command nor a comment
# Blocks ```text are no commands; nor is an indented block in which no line begins so (tables, scenes, formulas).
command_words='(\./quickstart|orbweaver|build/release/[^ ]+|BUILD/[^ ]+|tests/[^ ]+|mpirun|cmake|ctest|bash|sh|python3|valgrind|sbatch|srun|salloc'
command_words+='|squeue|scancel|sudo|apt-get|apt|dpkg|dpkg-deb|dpkg-query|docker|podman|spack|git|cd|cp|mkdir|rm|tar|make|ninja|g\+\+|gnuplot|h5dump|npm|node|man'
command_words+='|source|export|export_[a-z]+|doxygen|[A-Z_]+=[^ ]*)'
is_command() { [[ "$1" =~ ^$command_words(\ |$) ]]; }

read_document() {
  local number=0 kind='' name='' text='' first=0 line stripped before='' has_commands='' other=0 other_line=''
  local pending='' pending_line=0
  # A command, or the first part of one.
  take() {
    [[ -n "$pending" ]] || pending_line=$number
    pending+=$1
    if [[ "$pending" == *\\ ]]; then
      pending=${pending%\\}
    else
      on_command "$pending_line" "$pending"
      pending=''
    fi
  }
  while IFS= read -r line || [[ -n "$line" ]]; do
    number=$((number + 1))
    if [[ -n "$kind" ]]; then
      if [[ "$line" == '```' ]]; then
        if [[ "$kind" == file ]]; then
          on_file "$first" "$name" "$text"
          [[ "$name" != *.py ]] || on_command "$first" "python3 $name"
        fi
        kind=''
      elif [[ "$kind" == file ]]; then
        text+=$line$'\n'
      elif [[ "$kind" == sh && -n "$line" && "$line" != '#'* ]]; then
        take "$line"
      fi
      continue
    fi
    case "$line" in
      '```sh') kind=sh ;;
      '```text') kind=text ;;
      '```'[a-z]*' '*) kind=file name=${line##* } text='' first=$number ;;
      '```'*) kind=text && on_fault "$number" "a block without a language: write \`\`\`sh, \`\`\`text or \`\`\`LANGUAGE NAME" ;;
      '    '*)
        stripped=${line#"${line%%[![:space:]]*}"}
        if [[ -n "$pending" ]]; then
          take "$stripped"
        elif is_command "$stripped"; then
          has_commands=yes
          take "$stripped"
        elif [[ "$stripped" != '#'* ]]; then
          other=$number other_line=$stripped
        fi
        ;;
    esac
    if [[ "$line" != '    '* && -n "$line" ]]; then
      has_commands='' other=0
    fi
    if [[ -n "$has_commands" && $other != 0 ]]; then
      on_fault "$other" "beside commands: '$other_line' (is it a command? tests/documents/read.sh lists with what one begins)"
      other=0
    fi
    before=$line
  done <"$1"
}
