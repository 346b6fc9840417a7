#!/usr/bin/env python3
"""What other ways to cut a survey's tasks would gain, from a recorded run (task_table.py): list scheduling.

Tasks that wait go to free workers in the order of their priority and their key (copy and row), as in bench_queue;
messages cost nothing, which at 21 us a task is true up to thousands of workers (docs/scaling.md). Ways:
  as recorded      a task's children come when it ends
  while it goes    children of a branch come while it goes on, evenly spread: locations do not wait for its end
  pieces of S s    branches of more than S seconds are done by several workers at once, in pieces of at most S. A bound:
                   it takes an orbit of the family ahead of the branch for each piece, known when the branch begins
"""

import argparse
import csv
import heapq
import math
from pathlib import Path


def read(path: Path) -> list[dict]:
    with path.open() as lines:
        rows = list(csv.DictReader(lines))
    for row in rows:
        row["children"] = []
    for number, row in enumerate(rows):
        if int(row["parent"]) >= 0:
            rows[int(row["parent"])]["children"].append(number)
    return rows


def pieces_of(row: dict, longest: float) -> int:
    return max(1, math.ceil(float(row["seconds"]) / longest)) if row["kind"] == "branch" else 1


def released(row: dict, early: bool, pieces: int) -> list[list[tuple[float, int]]]:
    """For each piece of a task: its children with the share of its time after which they come."""
    out: list[list[tuple[float, int]]] = [[] for _ in range(pieces)]
    for n, child in enumerate(row["children"]):
        place = (n + 1) / (len(row["children"]) + 1) * pieces
        piece = min(pieces - 1, int(place))
        out[piece].append((place - piece if early and row["kind"] == "branch" else 1.0, child))
    return out


def wall(rows: list[dict], workers: int, copies: int, early: bool, longest: float) -> float:
    """Seconds until the last task has ended."""
    waiting: list[tuple[int, int, int, int]] = []  # priority, copy, row, piece

    def come(copy: int, row: int) -> None:
        for piece in range(pieces_of(rows[row], longest)):
            heapq.heappush(waiting, (int(rows[row]["priority"]), copy, row, piece))

    for copy in range(copies):
        for number, row in enumerate(rows):
            if int(row["parent"]) < 0:
                come(copy, number)
    events: list[tuple[float, int, int]] = []  # time, copy, row that comes; -1: a worker is free
    free, now = workers, 0.0
    while True:
        while free and waiting:
            _, copy, row, piece = heapq.heappop(waiting)
            pieces = pieces_of(rows[row], longest)
            length = float(rows[row]["seconds"]) / pieces
            for share, child in released(rows[row], early, pieces)[piece]:
                heapq.heappush(events, (now + share * length, copy, child))
            heapq.heappush(events, (now + length, copy, -1))
            free -= 1
        if not events:
            return now
        now, copy, row = heapq.heappop(events)
        if row < 0:
            free += 1
        else:
            come(copy, row)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=Path, help="written by task_table.py")
    parser.add_argument("--workers", type=int, nargs="+", default=[16, 64, 512])
    parser.add_argument("--copies", type=int, default=1, help="as if there were so many such surveys")
    parser.add_argument("--pieces", type=float, default=1.0, help="seconds of a piece")
    arguments = parser.parse_args()
    rows = read(arguments.table)
    work = arguments.copies * sum(float(row["seconds"]) for row in rows)
    print(f"{arguments.copies * len(rows)} tasks, {work:.1f} s of work, longest branch "
          f"{max(float(row['seconds']) for row in rows if row['kind'] == 'branch'):.1f} s")
    ways = {"as recorded": (False, math.inf), "while it goes": (True, math.inf),
            f"pieces of {arguments.pieces:g} s": (False, arguments.pieces),
            "both": (True, arguments.pieces)}
    print(f"{'workers':>8} {'at will':>8}" + "".join(f"{name:>18}" for name in ways))
    for workers in arguments.workers:
        walls = [wall(rows, workers, arguments.copies, *way) for way in ways.values()]
        print(f"{workers:>8} {work / workers:>8.2f}" + "".join(f"{seconds:>18.2f}" for seconds in walls))


if __name__ == "__main__":
    main()
