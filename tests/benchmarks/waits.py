#!/usr/bin/env python3
"""What a user waits for, from the command to the closed archive: a row a scene of drivers/scenes.

Milliseconds of processor time (user and system, children included) of one survey on one rank; on a shared machine
wall-clock time says little. What it was spent on: PETSc's -log_view has the stages' wall-clock times, which are scaled
by processor time / wall-clock time of the same run.
  start         the process before its first task and after its last: the same command on the finished folder, which
                ends at once
  by stage      orbits (predicted, corrected, accepted), multipliers, kernels (singular triplets, eigenpairs), sweep
                (the picture of the Hessian's smallest eigenvalue), certificates, archive (segments, atlas, witness),
                and the rest (starts of families, events, sections, distances of loops, the tree, checkpoints)
  by task       the same time once more: sweeps (with the small oscillations), branches, first orbits of branches,
                locations of crossings
  validation    of steps, in percent of the branches: what holds them on their family beside the corrector
With --switches also each thing that the scene can switch off: what the survey takes without it.
"""

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

FOUR = ["survey.depth=0"]
SCENES = {  # name: (scene, what makes it short)
    "double_pendulum, four families": ("double_pendulum", FOUR),
    "double_pendulum": ("double_pendulum", []),
    "double_pendulum_deep": ("double_pendulum_deep", ["limits.period=25", "survey.depth=1", "survey.subharmonics=2"]),
    "double_pendulum_half_degree": ("double_pendulum_half_degree", ["limits.period=15"]),
    "rotations": ("rotations", ["limits.period=10"]),
    "recurrences": ("recurrences", ["starts.recurrences.time=300"]),
    "damped_driven_double_pendulum": ("damped_driven_double_pendulum", ["survey.depth=0"]),
    "chain": ("chain", ["starts.sweep.period=[15,18]", "limits.energy=[-.inf,-54.5]"]),
    "henon_heiles": ("henon_heiles", []),
    "swinging_spring": ("swinging_spring", ["survey.depth=0"]),
    "duffing": ("duffing", []),
    "van_der_pol": ("van_der_pol", ["limits.parameter=[0.01,20]"]),
    "lorenz": ("lorenz", ["limits.period=10"]),
    "pcr3bp_earth_moon": ("pcr3bp_earth_moon", ["survey.depth=0", "limits.steps=40"]),
    "pcr3bp_mu_0.001": ("pcr3bp_mu_0.001", ["survey.depth=0", "limits.steps=40"]),
    "cr3bp_earth_moon": ("cr3bp_earth_moon", ["survey.depth=0", "limits.steps=20"]),
    "three_bodies_figure_eight": ("three_bodies_figure_eight", ["survey.depth=0", "limits.steps=20"]),
}
SWITCHES = {  # what is left out: how
    "certificate": ["compute.certificate=none"],
    "stability": ["compute.stability=false", "survey.depth=0"],
    "section": [],  # there is no key for that: the scene without its section
}
SECTION = re.compile(r"^section:.*\n(?:[ \t]+.*\n|\n)*", re.MULTILINE)
STAGES = {"Sweep": "sweep", "Continuation": "orbits", "Corrector": "orbits", "Certificate": "certificates",
          "Archive": "archive", "Queue wait": "waiting"}
KINDS = {"sweep": "sweeps", "branch": "branches", "start": "first", "locate": "locations"}
TASK = re.compile(r"queue: task .+ \((\w+), priority -?\d+\) took ([\d.]+) s")
ORBITS = re.compile(r"([\d,]+) orbits?, ")


@dataclass
class Waits:
    total: float = 0.0
    start: float = 0.0
    orbits: int = 0
    validation: float = 0.0
    stages: dict[str, float] = field(default_factory=lambda: defaultdict(float))
    tasks: dict[str, float] = field(default_factory=lambda: defaultdict(float))


def run(command: list[str], folder: Path) -> tuple[float, float, str, str]:
    """Seconds of processor time and of the clock, output, messages. A missed goal (status 1) is an end like 0."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with (folder / "out").open("w+") as out, (folder / "err").open("w+") as err:
        began = time.monotonic()
        process = subprocess.Popen(command, env=environment, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        passed = time.monotonic() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        printed, messages = out.read(), err.read()
    if process.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(command)} ended with status {process.returncode}:\n{messages[-2000:]}")
    return usage.ru_utime + usage.ru_stime, passed, printed, messages


def set_to(settings: list[str]) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


def survey(program: str, scene: Path, settings: list[str], folder: Path) -> Waits:
    shutil.rmtree(folder / "survey", ignore_errors=True)
    command = [program, "survey", str(scene), "-o", str(folder / "survey"), *set_to(settings)]
    log = folder / "stages.csv"
    total, passed, printed, messages = run([*command, "-v", "--", "-log_view", f":{log}:ascii_csv"], folder)
    waits = Waits(total=total)
    waits.start = min(run([*command, "--resume"], folder)[0] for _ in range(3))
    found = ORBITS.findall(printed)
    waits.orbits = int(found[-1].replace(",", "")) if found else 0
    share = total / passed
    with log.open(newline="") as rows:
        for row in csv.DictReader(rows):
            stage, event, seconds = row["Stage Name"], row["Event Name"], share * float(row["Time"])
            if event == "StepValidation":
                waits.validation += seconds
            if stage == "Spectrum" and event == "Multipliers":
                waits.stages["multipliers"] += seconds
                waits.stages["kernels"] -= seconds
            elif stage == "Spectrum" and event == "summary":
                waits.stages["kernels"] += seconds
            elif event == "summary" and stage in STAGES:
                waits.stages[STAGES[stage]] += seconds
    waits.stages["rest"] = total - waits.start - sum(waits.stages.values())
    for kind, seconds in TASK.findall(messages):
        waits.tasks[KINDS.get(kind, kind)] += share * float(seconds)
    return waits


def without_it(program: str, scene: Path, settings: list[str], switch: str, folder: Path) -> float | None:
    """Seconds of a survey without what the switch is for; none where the scene has nothing of it."""
    if switch == "section":
        text = scene.read_text()
        if not SECTION.search(text):
            return None
        scene = folder / scene.name
        scene.write_text(SECTION.sub("", text))
    if "survey.depth=0" in SWITCHES[switch]:
        settings = [s for s in settings if not s.startswith("survey.depth")]
    shutil.rmtree(folder / "survey", ignore_errors=True)
    words = set_to([*settings, *SWITCHES[switch]])
    return run([program, "survey", str(scene), "-o", str(folder / "survey"), "-q", *words], folder)[0]


def row(*cells: str) -> None:
    print("| " + " | ".join(cells) + " |", flush=True)


def milliseconds(seconds: float) -> str:
    return f"{1e3 * max(0.0, seconds):.0f}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program orbweaver")
    parser.add_argument("--scenes", nargs="*", default=list(SCENES), choices=list(SCENES), metavar="SCENE",
                        help="some of the rows")
    parser.add_argument("--whole", action="store_true", help="the scenes as they are: half an hour")
    parser.add_argument("--switches", action="store_true", help="also without certificates, multipliers, sections")
    arguments = parser.parse_args()
    program = str(Path(arguments.program).resolve())
    scenes = Path(__file__).resolve().parents[2] / "drivers" / "scenes"
    by_stage = ["orbits", "multipliers", "kernels", "sweep", "certificates", "archive", "rest"]
    by_task = ["sweeps", "branches", "first", "locations"]
    without = list(SWITCHES) if arguments.switches else []
    head = ["scene", "with", "orbits", "all", "start", *by_stage, *(f"*{kind}*" for kind in by_task), "validation",
            *(f"no {name}" for name in without)]
    row(*head)
    row(*("---" for _ in head))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for label in arguments.scenes:
            scene, reduced = SCENES[label]
            settings = [] if arguments.whole and reduced != FOUR else reduced
            path = scenes / f"{scene}.yaml"
            waits = survey(program, path, settings, folder)
            cells = [label, ", ".join(f"`{s}`" for s in settings), str(waits.orbits), milliseconds(waits.total),
                     milliseconds(waits.start), *(milliseconds(waits.stages[k]) for k in by_stage),
                     *(milliseconds(waits.tasks[k]) for k in by_task),
                     f"{100.0 * waits.validation / waits.tasks['branches']:.1f}" if waits.tasks["branches"] else ""]
            for switch in without:
                seconds = without_it(program, path, settings, switch, folder)
                cells.append("" if seconds is None else milliseconds(seconds))
            row(*cells)
    return 0


if __name__ == "__main__":
    sys.exit(main())
