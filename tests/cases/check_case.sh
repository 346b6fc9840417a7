#!/usr/bin/env bash
# check_case.sh PROGRAM FOLDER TABLE [--all]: surveys a problem that users brought, and holds it against what is right of it.
# FOLDER has scenes and TABLE, whose lines are
#   refuses FILE TEXT     a scene that has to be refused with status 2, and what is said of it
#   scene FILE            the scene that the lines below are about
#   status N              with which its survey has to end (default 0)
#   set KEY=VALUE         a setting of all its runs
#   row TABLE NAME=VALUE ...       a row of `show TABLE --csv` has to be these; VALUE~D: a number within D of it;
#                                  NAME:VALUE: a text that holds VALUE (with _ for a space)
#   rows TABLE N [NAME=VALUE ...]  that many rows of it are these
#   says TEXT             what the survey has to print
#   vary KEY=VALUE ...    with --all: the same tree with these settings too
# Without --all a scene is surveyed on two ranks; with it also on one, with other kernels of BLAS, and as `vary` says. Not for the
# build with sanitizers. Works in the present folder.
set -uo pipefail
readonly program=$1 folder=$2 table=$3 all=${4:-}

failures=0
fault() {
  printf 'FAILED %s: %s\n' "$scene" "$*"
  failures=$((failures + 1))
}

# matching_rows CSV NAME=VALUE ...: how many rows of the CSV on stdin have these values.
matching_rows() {
  awk -v wanted="$(printf '%s\n' "$@")" '
    function cells_of(line, cells,   n, i, c, quoted, cell) {
      n = 0; cell = ""; quoted = 0
      for (i = 1; i <= length(line); i++) {
        c = substr(line, i, 1)
        if (c == "\"") quoted = !quoted
        else if (c == "," && !quoted) { cells[++n] = cell; cell = "" }
        else cell = cell c
      }
      cells[++n] = cell
      return n
    }
    NR == 1 {
      n = cells_of($0, head)
      for (i = 1; i <= n; i++) at[head[i]] = i
      count = wanted == "" ? 0 : split(wanted, conditions, "\n")
      for (i = 1; i <= count; i++) {
        part[i] = match(conditions[i], /[=:]/) && substr(conditions[i], RSTART, 1) == ":"
        sides[1] = substr(conditions[i], 1, RSTART - 1)
        sides[2] = substr(conditions[i], RSTART + 1)
        if (part[i]) gsub(/_/, " ", sides[2])
        if (!(sides[1] in at)) { print "no column " sides[1] > "/dev/stderr"; failed = 1; exit }
        column[i] = at[sides[1]]
        numeric[i] = split(sides[2], bounds, "~") == 2
        value[i] = bounds[1]
        width[i] = bounds[2]
      }
      next
    }
    {
      cells_of($0, cells)
      good = 1
      for (i = 1; i <= count; i++) {
        cell = cells[column[i]]
        if (part[i]) {
          if (!index(cell, value[i])) good = 0
        } else if (numeric[i]) {
          if (cell !~ /^[-+]?[0-9.]/) good = 0
          deviation = cell - value[i]
          if (deviation > width[i] + 0 || -deviation > width[i] + 0) good = 0
        } else if (cell != value[i]) good = 0
      }
      found += good
    }
    END { print failed ? -1 : found + 0 }'
}

declare -A tables
rows_of() {
  local name=$1
  shift
  [[ -n "${tables[$name]:-}" ]] || tables[$name]=$("$program" show out/atlas.h5 "$name" --csv 2>/dev/null)
  matching_rows "$@" <<<"${tables[$name]}"
}

# survey FOLDER RANKS [KEY=VALUE ...]
survey() {
  local out=$1 ranks=$2 setting settings=()
  shift 2
  for setting in "${always[@]}" "$@"; do settings+=(--set "$setting"); done
  rm -rf "$out"
  local begin=$EPOCHREALTIME
  if ((ranks > 1)); then
    "$program" --ranks "$ranks" survey "$scene" -o "$out" "${settings[@]}" >"$out.txt" 2>&1
  else
    "$program" survey "$scene" -o "$out" "${settings[@]}" >"$out.txt" 2>&1
  fi
  status=$?
  printf '%-16s %d ranks %-40s status %d, %.1f s\n' "$scene" "$ranks" "$*" "$status" \
    "$(awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { print b - a }')"
}

# same NAME RANKS [KEY=VALUE ...]: such a survey has the tree of the first.
same() {
  local name=$1 difference
  shift
  survey "$name" "$@"
  ((status == wanted_status)) || { fault "$*: status $status, not $wanted_status"; grep -v '^ ' "$name.txt" | tail -n 20; }
  [[ -e out/atlas.h5 && -e "$name/atlas.h5" ]] || return 0
  difference=$("$program" compare out/atlas.h5 "$name/atlas.h5" 2>&1) || fault "$*: another tree: $difference"
}

variations=()
end_scene() {
  [[ -n "$all" && -n "$scene" ]] || return 0
  same ranks1 1
  local kernels
  for kernels in Haswell Prescott; do
    OPENBLAS_CORETYPE=$kernels same "$kernels" 2
  done
  local variation number=0
  for variation in "${variations[@]}"; do
    number=$((number + 1))
    same "vary$number" 2 $variation
  done
}

# Before the first line about what came: the survey itself.
begin_checks() {
  [[ -z "$surveyed" ]] || return 0
  surveyed=yes
  tables=()
  survey out 2
  ((status == wanted_status)) || { fault "status $status, not $wanted_status"; tail -n 40 out.txt; }
}

cp "$folder"/* .
while read -r word source refusal; do
  [[ "$word" == refuses ]] || continue
  scene=$source
  "$program" check "$source" >check.txt 2>&1
  status=$?
  ((status == 2)) && grep -qF -- "$refusal" check.txt || { fault "not refused so: $refusal"; cat check.txt; }
done <"$table"

scene='' surveyed=''
while read -r word rest; do
  case "$word" in
    '' | \#* | refuses) ;;
    scene)
      end_scene
      scene=$rest surveyed='' wanted_status=0 always=() variations=()
      ;;
    status) wanted_status=$rest ;;
    set) always+=("$rest") ;;
    vary) variations+=("$rest") ;;
    says)
      begin_checks
      grep -qF -- "$rest" out.txt || { fault "does not say: $rest"; cat out.txt; }
      ;;
    row)
      begin_checks
      read -r -a words <<<"$rest"
      found=$(rows_of "${words[@]}")
      ((found > 0)) || fault "no row: $rest"
      ;;
    rows)
      begin_checks
      read -r -a words <<<"$rest"
      found=$(rows_of "${words[0]}" "${words[@]:2}")
      ((found == words[1])) || fault "$found rows, not: $rest"
      ;;
    *) fault "an unknown word in $table: $word" ;;
  esac
done <"$table"
end_scene
((failures == 0))
