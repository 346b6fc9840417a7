"""Makes the task table that bench_queue replays from the log of a survey on one rank:

    orbweaver survey SCENE -o DIR -v 2> log;  python3 task_table.py log > table.csv

A row a task, parents before children: the parent's row (-1: none), priority, kind, seconds, longest time without a report
(s), bytes of payload in and out. Sweeps, which come before the tree, and the comparisons of the witness are left
out. --factor scales the seconds, where the
machine was shared (processor time / wall time of the run)."""
import argparse
import re

LINE = re.compile(
    r"queue: task (?P<key>.+) \((?P<kind>\w+), priority (?P<priority>-?\d+)\) took (?P<seconds>[\d.]+) s, silent"
    r" (?P<silence>[\d.]+) s, (?P<inward>\d+) bytes in, (?P<outward>\d+) out, children:(?P<children>.*)$")

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("log")
parser.add_argument("--factor", type=float, default=1.0)
arguments = parser.parse_args()

row_of, parent_of, rows = {}, {}, []
with open(arguments.log, encoding="utf-8") as log:
    for line in log:
        match = LINE.search(line)
        if not match or match["kind"] in ("sweep", "compare"):
            continue
        row_of[match["key"]] = len(rows)
        for child in filter(None, match["children"].strip().split(", ")):
            parent_of[child] = match["key"]
        times = (arguments.factor * float(match[name]) for name in ("seconds", "silence"))
        rows.append((match["key"], match["priority"], match["kind"], *(f"{t:.6f}" for t in times),
                     match["inward"], match["outward"]))
print("parent,priority,kind,seconds,silence,bytes_in,bytes_out")
for key, *fields in rows:
    print(row_of.get(parent_of.get(key), -1), *fields, sep=",")
