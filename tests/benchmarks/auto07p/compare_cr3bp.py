#!/usr/bin/env python3
"""Orbweaver's survey against AUTO-07p: L1's Lyapunov, vertical and halo families of Earth and Moon.

Processor time (user + system) of whole processes, one rank, one thread, medians over the repetitions; a family of Orbweaver's with
multipliers, error bounds and crossings, and with its start. The halo family is that of a survey with it, without that of a survey
without it. Digits: the state and period of every orbit against the nearest true one, and the branch points against those of
cr3bp_truth.F90, which computes both in quadruple precision.
"""

import argparse
import csv
import io
import os
import shutil
import subprocess
import sys
from pathlib import Path
from statistics import median

import auto_side

HERE = Path(__file__).parent
SCENE = HERE.parents[2] / "drivers" / "scenes" / "cr3bp_earth_moon.yaml"
STATE = ["state_x", "state_y", "state_z", "state_vx", "state_vy", "state_vz", "period"]
COMMON = ["--set", "starts.fixed_points.grid=[[0.837],[0],[0]]", "--set", "starts.states=[]", "--set", "compute.stability=true"]
SURVEYS = {  # depth, periods of the small oscillations, longest period
    "Lyapunov": (0, "[2.5,2.72]", 30),
    "vertical": (0, "[2.72,3]", 30),
    "short Lyapunov": (0, "[2.5,2.72]", 3.9),
    "short Lyapunov and halo": (1, "[2.5,2.72]", 3.9),
}
NAMES = "parnames={1:'lambda',3:'H',6:'T1',7:'T2',11:'PERIOD'}\nunames={1:'x',2:'y',3:'z',4:'vx',5:'vy',6:'vz'}\n"
EQUILIBRIUM = NAMES + """NDIM=6, IPS=1, IRS=0, ILP=0, ICP=['lambda','T1','T2'], ISP=1, NMX=1, NPR=1, DS=1e-3, JAC=1, NPAR=16
U={1:0.836915125772357}
sv='eq'
"""
FAMILY = NAMES + """NTST=%(ntst)d, NCOL=4, IAD=3, IPLT=0, NINT=0, NMX=3000, NPR=0, MXBF=0, IID=0, ITMX=8, ITNW=5, NWTN=3, JAC=1
EPSL=%(eps)g, EPSU=%(eps)g, EPSS=%(special)g, DS=1e-2, DSMIN=1e-6, DSMAX=0.1, IADS=1, NPAR=16, THL={11:0.0}, THU={}, NDIM=6, ILP=0
ISP=%(isp)d, IPS=2, NBC=0, ICP=['lambda','PERIOD','H']
"""
RUNS = {  # where each begins, and ends: a fold lies at T = 1.8037 of the halo orbits, near the end that the survey's guard makes
    "Lyapunov": "ISW=1, s='eq', IRS=1, TY='HB6', sv='Lyapunov', UZSTOP={'PERIOD':7.29}\n",
    "vertical": "ISW=1, s='eq', IRS=1, TY='HB7', sv='vertical', UZSTOP={'PERIOD':6.29998}\n",
    "halo": "ISW=-1, s='Lyapunov', IRS='BP1', sv='halo', UZSTOP={'PERIOD':[1.81,7]}\n",
}
SETTINGS = [dict(ntst=50, eps=1e-7, special=1e-5, isp=3), dict(ntst=50, eps=1e-7, special=1e-5, isp=2),
            dict(ntst=100, eps=1e-10, special=1e-8, isp=2)]


def build(folder: Path, work: Path) -> tuple[Path, Path]:
    """AUTO's program and the one that knows the truth."""
    objects = sorted(str(p) for p in (folder / "lib").glob("*.o"))
    subprocess.run(["gfortran", "-O3", "-march=native", "-fopenmp", str(HERE / "cr3bp.F90"), *objects, "-o", "cr3bp"],
                   check=True, cwd=work)
    subprocess.run(["gfortran", "-O3", "-march=native", str(HERE / "cr3bp_truth.F90"), "-o", "cr3bp_truth"], check=True, cwd=work)
    return work / "cr3bp", work / "cr3bp_truth"


def truth(program: Path, what: str, lines: list[str]) -> list[list[float]]:
    """A row of numbers for each line; throws subprocess.CalledProcessError if Newton's method fails on one."""
    done = subprocess.run([str(program), what], input="".join(line + "\n" for line in lines), capture_output=True, text=True, check=True)
    return [[float(word) for word in line.split()] for line in done.stdout.splitlines()]


def table(program: str, atlas: Path, name: str) -> list[dict[str, str]]:
    text = subprocess.run([program, "show", str(atlas), name, "--csv"], capture_output=True, text=True, check=True).stdout
    return list(csv.DictReader(io.StringIO(text)))


def surveys(program: str, work: Path, repetitions: int) -> dict[str, float]:
    """Seconds of each survey; their archives stay in `work`."""
    times = {}
    for name, (depth, sweep, longest) in SURVEYS.items():
        folder = work / name.replace(" ", "_")
        command = [program, "survey", str(SCENE), "-o", str(folder), *COMMON, "--set", f"survey.depth={depth}", "--set",
                   f"starts.sweep.period={sweep}", "--set", f"limits.period={longest}"]
        runs = []
        for _ in range(repetitions):
            shutil.rmtree(folder, ignore_errors=True)
            runs.append(auto_side.timed(command, {"OPENBLAS_NUM_THREADS": "1"}, stderr=subprocess.DEVNULL))
        times[name] = median(run.user + run.system for run in runs)
    return times


def errors(program: Path, lines: list[str]) -> str:
    distances = sorted(max(row[1:]) for row in truth(program, "distance", lines))
    return f"{distances[len(distances) // 2]:>8.1e} {distances[-1]:>8.1e}"


def orbweaver_side(program: str, work: Path, repetitions: int, true: Path) -> dict[str, list[float]]:
    """Prints Orbweaver's rows; the true periods and energies of the branch points where the symmetry breaks, by family."""
    times = surveys(program, work, repetitions)
    times["halo"] = times["short Lyapunov and halo"] - times["short Lyapunov"]
    branches = {}
    print(f"\n{'':<26} {'family':<9} {'orbits':>6} {'time/s':>7} {'ms/orbit':>8} {'median':>8} {'largest':>8}   branch points at T, off by")
    for name in RUNS:
        atlas = work / ("short_Lyapunov_and_halo" if name == "halo" else name) / "atlas.h5"
        orbits = [row for row in table(program, atlas, "orbits") if (name != "halo") or row["family"] == "1"]
        points = [row for row in table(program, atlas, "crossings") if row["kind"] == "branch-point" and name != "halo"]
        seen = []
        for row in points:
            try:
                at = truth(true, "branch", [" ".join(row[key] for key in STATE)])[0]
            except subprocess.CalledProcessError:  # the symmetry does not break: not known to the truth
                seen.append(f"{float(row['period']):.9f} ?")
                continue
            branches.setdefault(name, []).append(at[0])
            seen.append(f"{float(row['period']):.9f} {abs(float(row['period']) - at[0]):.1e}")
        print_row("Orbweaver", name, len(orbits), times[name], errors(true, [" ".join(row[k] for k in STATE) for row in orbits]), seen)
    return branches


def print_row(who: str, family: str, orbits: int, seconds: float, distances: str, seen: list[str]) -> None:
    print(f"{who:<26} {family:<9} {orbits:>6} {seconds:>7.3f} {1e3 * seconds / orbits:>8.2f} {distances}   {', '.join(seen)}", flush=True)


def auto_run(program: Path, folder: Path, name: str, constants: str, environment: dict[str, str]) -> auto_side.Run:
    (folder / f"c.{name}").write_text(constants)
    with (folder / f"c.{name}").open() as stdin:
        return auto_side.timed([str(program)], environment, str(folder), stdin, stderr=subprocess.DEVNULL)


def auto_rows(program: Path, work: Path, repetitions: int, true: Path, settings: dict, branches: dict[str, list[float]]) -> None:
    """Prints AUTO's rows with one choice of settings: the times of runs that write no orbits, and the orbits of one that does."""
    who = "AUTO {ntst} x 4, {eps:g}, ISP={isp}".format(**settings)
    start = auto_run(program, work, "eq", EQUILIBRIUM, {})
    for name, ends in RUNS.items():
        constants = FAMILY % settings + ends
        runs = [auto_run(program, work, name, constants, {}) for _ in range(repetitions)]
        seconds = median(run.user + run.system for run in runs) + (0 if name == "halo" else start.user + start.system)
        orbits = work / f"{name}.orbits"
        orbits.unlink(missing_ok=True)
        auto_run(program, work, name, constants, {"ORBWEAVER_ORBITS": str(orbits)})
        lines = list(dict.fromkeys(orbits.read_text().splitlines()))
        rows = [line.split() for line in (work / f"b.{name}").read_text().splitlines()]
        points = [float(row[-2]) for row in rows if row[0] != "0" and row[2] in ("1", "6")]
        seen = []
        for period in points:
            nearest = min(branches.get(name, []), key=lambda at: abs(at - period), default=None)
            seen.append(f"{period:.9f} {abs(period - nearest):.1e}" if nearest and abs(period - nearest) < 1e-2 else f"{period:.9f} ?")
        count = sum(1 for row in rows if row[0] != "0" and abs(int(row[1])) > 1)
        print_row(who, name, count, seconds, errors(true, lines), seen)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program orbweaver")
    parser.add_argument("--work", type=Path, default=Path("auto07p_cr3bp"), help="folder for what is compiled, and for archives")
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    folder = auto_side.require()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    program, true = build(folder, work)
    orbweaver = os.path.abspath(arguments.program)
    branches = orbweaver_side(orbweaver, work, arguments.repetitions, true)
    print("true branch points:", branches)
    for settings in SETTINGS:
        auto_rows(program, work, arguments.repetitions, true, settings, branches)
    return 0


if __name__ == "__main__":
    sys.exit(main())
