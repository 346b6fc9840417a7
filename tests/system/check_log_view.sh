#!/usr/bin/env bash
# check_log_view.sh FOLDER STAGE[,STAGE...] COMMAND...
# Runs COMMAND, which logs to stdout (-log_view), in an empty FOLDER; fails unless every STAGE is in PETSc's table with some
# time, and the times of all stages add up to the whole run's.
set -euo pipefail
export LC_ALL=C
readonly folder=$1 stages=$2
shift 2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
"$@" >log.txt

awk -v wanted="$stages" '
/^Time \(sec\):/ { total = $NF }
/^Summary of Stages:/ { table = 1 }
/^Phase summary info/ { table = 0 }
table && match($0, /^ *[0-9]+: */) {
  rest = substr($0, RLENGTH + 1)
  name = substr(rest, 1, index(rest, ":") - 1)
  split(substr(rest, index(rest, ":") + 1), column, " ")
  seconds[name] = column[1]
  sum += column[1]
  print name ": " column[1] " s"
}
END {
  n = split(wanted, names, ",")
  for (i = 1; i <= n; ++i)
    if (!(seconds[names[i]] > 1e-5)) { print "stage `" names[i] "`: expected some time, got none"; bad = 1 }
  if (!(total > 0) || sum < 0.99 * total || sum > 1.01 * total) {
    print "expected stages that add up to the run of " total " s, got " sum " s"; bad = 1
  }
  exit bad
}' log.txt
