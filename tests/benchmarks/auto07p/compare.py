#!/usr/bin/env python3
"""Orbweaver against AUTO-07p: the four families of the double pendulum from small amplitude to T = 30, both in turn.

Medians over the repetitions, each run in a fresh process. Three notions of time, since each side has a start of its own:
  trace    Orbweaver: CPU time (user + system) of the first trace of its process, transforms planned in it, as it prints it
           itself; AUTO: user time of its process(es). What the ratio in the first column is made of.
  - start  the same, with AUTO's start (a run with NMX = 1) taken off AUTO's time.
  process  Orbweaver's whole process as well: user time with the start of MPI, PETSc and the search for the normal mode.
"""

import argparse
import sys
from functools import cache
from pathlib import Path
from statistics import median

import auto_side

CASES = [  # Orbweaver's options; AUTO's mode, NTST, NCOL
    ("symmetric subspace, no multipliers", [], "quarter", 50, 4),
    ("symmetric subspace, no multipliers", [], "quarter", 10, 7),
    ("full loop with multipliers", ["--full", "--multipliers"], "full", 200, 4),
]


def orbweaver(program: str, options: list[str], work: Path) -> tuple[dict[str, float], auto_side.Run]:
    """What `bench_families` printed (name=value) and what its process used."""
    output = work / "bench_families.txt"
    with output.open("w") as stdout:
        run = auto_side.timed([program, *options], {"OPENBLAS_NUM_THREADS": "1"}, stdout=stdout)
    return {k: float(v) for k, v in (word.split("=") for word in output.read_text().split())}, run


@cache
def longest_step(program: str, family: str, full: bool, orbits: int, work: Path) -> str:
    """The bound on the steps with which a family has about `orbits` orbits."""
    options = ["--family", family, "--aim", str(orbits), *(["--full"] if full else [])]
    return str(orbweaver(program, options, work)[0]["longest"])


def options_of(program: str, family: str, options: list[str], orbits: int, work: Path) -> list[str]:
    return ["--family", family, *options, "--longest", longest_step(program, family, "--full" in options, orbits, work)]


def measure(program, programs, work, repetitions, orbits, case):
    """Medians for each family: (AUTO's run, its start, Orbweaver's trace, its process, orbits), in seconds."""
    _, options, mode, ntst, ncol = case
    results = {}
    for family in auto_side.FAMILIES:
        given = options_of(program, family, options, orbits, work)
        theirs, starts, ours, processes = [], [], [], []
        for _ in range(repetitions):
            auto = auto_side.trace(programs, mode, family, ntst, ncol)
            starts.append(auto_side.trace(programs, mode, family, ntst, ncol, most=1).user)
            theirs.append(auto.user)
            printed, process = orbweaver(program, given, work)
            ours.append(1e-6 * printed["cold"])
            processes.append(process.user)
        warm, _ = orbweaver(program, [*given, "--repetitions", str(repetitions + 1)], work)
        results[family] = (median(theirs), median(starts), median(ours), median(processes), auto.orbits,
                           int(printed["orbits"]), 1e-6 * warm["warm"])
    return results


def print_case(case, results) -> None:
    title, _, mode, ntst, ncol = case
    print(f"\n{title}, against AUTO's {mode}-period mode {ntst} x {ncol} (times in ms)")
    print(f"{'family':<7} {'orbits':>6} {'AUTO':>7} {'start':>6} | {'orbits':>6} {'cold':>8} {'warm':>8} {'process':>8} "
          f"{'us/orbit':>8} | {'trace':>6} {'-start':>6} {'process':>7}")
    totals = [sum(column) for column in zip(*results.values())]
    for name, (auto, start, cold, process, auto_orbits, orbits, warm) in [*results.items(), ("all", totals)]:
        print(f"{name:<7} {auto_orbits:>6} {1e3 * auto:>7.1f} {1e3 * start:>6.1f} | {orbits:>6} {1e3 * cold:>8.2f} "
              f"{1e3 * warm:>8.2f} {1e3 * process:>8.1f} {1e6 * cold / orbits:>8.1f} | {auto / cold:>6.2f} "
              f"{(auto - start) / cold:>6.2f} {auto / process:>7.2f}", flush=True)


def print_errors(program, work, orbits) -> None:
    print("\nlargest distance of Orbweaver's orbits to the true ones (nearest orbit of the family, whole loop)")
    print(f"{'':<10} {'family':<7} {'T < 10':>8} {'10-15':>8} {'15-20':>8} {'20-30':>8}")
    for name, options in (("symmetric", []), ("full", ["--full"])):
        for family in auto_side.FAMILIES:
            e, _ = orbweaver(program, [*options_of(program, family, options, orbits, work), "--check"], work)
            print(f"{name:<10} {family:<7} {e['error_T10']:>8.1e} {e['error_T15']:>8.1e} {e['error_T20']:>8.1e} "
                  f"{e['error_T30']:>8.1e}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program bench_families")
    parser.add_argument("--work", type=Path, default=Path("auto07p"), help="folder for what is compiled")
    parser.add_argument("--repetitions", type=int, default=7)
    parser.add_argument("--orbits", type=int, default=100, help="about so many orbits a family")
    parser.add_argument("--no-errors", action="store_true", help="leave out the distances to the true orbits")
    arguments = parser.parse_args()
    folder = auto_side.require()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    programs = auto_side.build(folder, work)
    print("ratios > 1: Orbweaver is faster. " + __doc__.split("\n\n")[1])
    failed = 0
    for case in CASES:
        try:
            print_case(case, measure(arguments.program, programs, work, arguments.repetitions, arguments.orbits, case))
        except RuntimeError as error:
            print(f"\n{case[0]}, against {case[2:]}: not measured: {error}", flush=True)
            failed = 1
    if not arguments.no_errors:
        print_errors(arguments.program, work, arguments.orbits)
    return failed


if __name__ == "__main__":
    sys.exit(main())
