#!/usr/bin/env python3
"""slopes.py FILE...: from Google Benchmark's JSON (--benchmark_format=json or --benchmark_out), the log-log slopes of CPU
time and memory against K, and the paper's optimiser against the default corrector."""

import json
import math
import sys
from statistics import median

TO_SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def slope(points: list[tuple[float, float]]) -> float:
    """Least-squares slope of log y against log x."""
    x = [math.log(p[0]) for p in points]
    y = [math.log(p[1]) for p in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def rows_of(paths: list[str]) -> list[dict]:
    """Medians where there are aggregates, single runs otherwise; those that failed are left out."""
    rows = [row for path in paths for row in json.load(open(path))["benchmarks"] if not row.get("error_occurred")]
    medians = [row for row in rows if row.get("aggregate_name") == "median"]
    return medians or [row for row in rows if row.get("run_type") != "aggregate"]


def print_slopes(rows: list[dict]) -> None:
    curves: dict[str, list[dict]] = {}
    for row in rows:
        if "K" in row:
            curves.setdefault(row["run_name"].split("/")[0], []).append(row)
    print(f"{'':<32} {'K':>12} {'slope of time':>14} {'from K = 128':>13} {'of memory':>10} {'most inner/step':>16}")
    for name, curve in curves.items():
        if len(curve) < 3:
            continue
        times = [(row["K"], row["cpu_time"] * TO_SECONDS[row["time_unit"]]) for row in curve]
        large = [p for p in times if p[0] >= 128]
        # Under a few MiB the resident memory moves in jumps of the allocator.
        memory = [(row["K"], row["MiB"]) for row in curve if row.get("MiB", 0) > 4]
        print(f"{name:<32} {times[0][0]:>5.0f} - {times[-1][0]:<5.0f}{slope(times):>13.2f} "
              f"{slope(large) if len(large) > 2 else math.nan:>13.2f} "
              f"{slope(memory) if len(memory) > 2 else math.nan:>10.2f} "
              f"{max(row.get('inner_per_step', 0) for row in curve):>16.1f}")


def print_paper(rows: list[dict]) -> None:
    by = {side: {tuple(row["run_name"].split("/")[1:3]): row for row in rows
                 if row["run_name"].startswith(f"step_by_{side}/")} for side in ("paper", "default")}
    families = ["In-Phase", "Out-Phase", "Down-Up", "Up-Down"]
    ratios: dict[str, list[float]] = {}
    for key in sorted(by["paper"].keys() & by["default"].keys(), key=lambda k: (int(k[1]), k[0])):
        paper, default = by["paper"][key], by["default"][key]
        ratio = paper["cpu_time"] / default["cpu_time"]
        ratios.setdefault(key[1], []).append(ratio)
        print(f"{families[int(key[0])]:<10} K = {key[1]:<3} T = {paper['T']:.3f}: paper's optimiser "
              f"{paper['cpu_time']:.0f} {paper['time_unit']} ({paper['epochs']:.0f} epochs), default "
              f"{default['cpu_time']:.0f} {default['time_unit']}: {ratio:.0f} times")
    for cutoff, found in ratios.items():
        print(f"median at K = {cutoff}: {median(found):.0f} times")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    measured = rows_of(sys.argv[1:])
    print_slopes(measured)
    print_paper(measured)
