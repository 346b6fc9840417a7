# Sourced: reads a document's commands and files, in the order in which they stand.
#
# read_document DOCUMENT calls
#   on_command LINE COMMAND   for a command: a line of a block ```sh; what stands behind `$ ` in a block ```console, which has what it
#                             prints too; a line of an indented block that begins with one of the words below; `python3 NAME` behind a
#                             block ```python NAME. What follows a backslash at its end belongs to it.
#   on_file LINE NAME TEXT    for a block ```LANGUAGE NAME: a file that the commands after it find
#   on_excerpt LINE TEXT  for a block ```text: an excerpt of what is printed
#   on_fault LINE WHAT        for a block ``` of no language, and for a line beside commands that is neither a command, a comment, nor a title ending in a colon
# Other blocks (```text, ```cpp) are no commands; nor is an indented block in which no line begins so (tables, scenes, formulas).
command_words='(\./quickstart|orbweaver|build/release/[^ ]+|BUILD/[^ ]+|tests/[^ ]+|mpirun|cmake|ctest|bash|sh|python3|valgrind|sbatch|srun|salloc'
command_words+='|squeue|scancel|sudo|apt-get|apt|dpkg|dpkg-deb|dpkg-query|docker|podman|spack|git|cd|cp|mkdir|rm|tar|make|ninja|g\+\+|gnuplot|h5dump|npm|node|man'
command_words+='|source|export|export_[a-z]+|doxygen|[A-Z_]+=[^ ]*)'
on_excerpt() { :; } # for whom excerpts do not matter
is_command() { [[ "$1" =~ ^$command_words(\ |$) ]]; }

read_document() {
  # Names of their own: the functions that are called see them.
  local rd_number=0 rd_kind='' rd_file='' rd_text='' rd_first=0 rd_line rd_stripped rd_has_commands='' rd_other=0 rd_other_line=''
  local rd_pending='' rd_pending_line=0
  # A command, or the first part of one.
  take() {
    [[ -n "$rd_pending" ]] || rd_pending_line=$rd_number
    rd_pending+=$1
    if [[ "$rd_pending" == *\\ ]]; then
      rd_pending=${rd_pending%\\}
    else
      on_command "$rd_pending_line" "$rd_pending"
      rd_pending=''
    fi
  }
  while IFS= read -r rd_line || [[ -n "$rd_line" ]]; do
    rd_number=$((rd_number + 1))
    if [[ -n "$rd_kind" ]]; then
      if [[ "$rd_line" == '```' ]]; then
        if [[ "$rd_kind" == file ]]; then
          on_file "$rd_first" "$rd_file" "$rd_text"
          [[ "$rd_file" != *.py ]] || on_command "$rd_first" "python3 $rd_file"
        elif [[ "$rd_kind" == excerpt ]]; then
          on_excerpt "$rd_first" "$rd_text"
        fi
        rd_kind=''
      elif [[ "$rd_kind" == file || "$rd_kind" == excerpt ]]; then
        rd_text+=$rd_line$'\n'
      elif [[ "$rd_kind" == sh && -n "$rd_line" && "$rd_line" != '#'* ]]; then
        take "$rd_line"
      elif [[ "$rd_kind" == console && ( -n "$rd_pending" || "$rd_line" == '$ '* ) ]]; then
        take "${rd_line#'$ '}"
      fi
      continue
    fi
    case "$rd_line" in
      '```sh') rd_kind=sh ;;
      '```console') rd_kind=console ;;
      '```'[a-z]*' '*) rd_kind=file rd_file=${rd_line##* } rd_text='' rd_first=$rd_number ;;
      '```text') rd_kind=excerpt rd_text='' rd_first=$rd_number ;;
      '```'[a-z]*) rd_kind=text ;;
      '```'*) rd_kind=text && on_fault "$rd_number" "a block without a language: write \`\`\`sh, \`\`\`text or \`\`\`LANGUAGE NAME" ;;
      '    '*)
        rd_stripped=${rd_line#"${rd_line%%[![:space:]]*}"}
        if [[ -n "$rd_pending" ]]; then
          take "$rd_stripped"
        elif is_command "$rd_stripped"; then
          rd_has_commands=yes
          take "$rd_stripped"
        elif [[ "$rd_stripped" != '#'* && "$rd_stripped" != *: ]]; then # no comment, no title
          rd_other=$rd_number rd_other_line=$rd_stripped
        fi
        ;;
    esac
    if [[ "$rd_line" != '    '* ]]; then
      rd_has_commands='' rd_other=0
    fi
    if [[ -n "$rd_has_commands" && $rd_other != 0 ]]; then
      on_fault "$rd_other" "beside commands: '$rd_other_line' (is it a command? tests/documents/read.sh lists with what one begins)"
      rd_other=0
    fi
  done <"$1"
}
