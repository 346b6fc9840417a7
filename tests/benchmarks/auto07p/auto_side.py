"""AUTO-07p's side of the comparison: builds its two programs and traces one family from small amplitude to T = 30."""

import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

# Number in the Fortran file, equilibrium, parameter that holds the small oscillation's period, energy at T = 30.
FAMILIES = {
    "in": (1, "U={1:0,2:0}", "HB7", 2.999066436174782),
    "out": (2, "U={1:0,2:0}", "HB6", 2.999995011170102),
    "du": (3, "U={1:0,2:3.14159265358979324}", "HB6", 2.999963952154835),
    "ud": (4, "U={1:3.14159265358979324,2:0}", "HB6", 2.999977702299427),
}
NAMES = "parnames={1:'mu',3:'H',6:'T1',7:'T2',11:'PERIOD'}\nunames={1:'th1',2:'th2',3:'w1',4:'w2'}"
COMMON = """NTST={ntst}, NCOL={ncol}, IAD=3, IPLT=0, NINT=0, NMX={nmx}, NPR=0, MXBF=0, IID=0, ITMX=8, ITNW=5, NWTN=3, JAC=1
EPSL=1e-7, EPSU=1e-7, EPSS=1e-5, DS=1e-2, DSMIN=1e-6, DSMAX=0.05, IADS=1, NPAR=16, THL={{11:0.0}}, THU={{}}, NDIM=4, ILP=0
ISW=1"""
EQUILIBRIUM = "NDIM=4, IPS=1, IRS=0, ILP=0, ICP=['mu','T1','T2'], ISP=1, NMX=1, NPR=1, DS=1e-3, JAC=1, NPAR=16"


@dataclass
class Run:
    """Seconds of a process (or of several in a row), and for AUTO the orbits it made."""

    user: float
    system: float
    orbits: int = 0


def require() -> Path:
    """The folder of AUTO-07p; ends the program with a clear message if it or gfortran is missing."""
    folder = Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))
    missing = [name for name, there in (("gfortran", shutil.which("gfortran")),
                                        ("auto-07p", (folder / "lib").is_dir())) if not there]
    if missing:
        print(f"bench_auto: {' and '.join(missing)} not found: install with `apt-get install auto-07p gfortran` "
              "(or set AUTO_DIR to an installed AUTO-07p)", file=sys.stderr)
        sys.exit(3)
    return folder


def build(folder: Path, work: Path) -> dict[str, Path]:
    """The programs of the two modes, compiled as AUTO itself compiles them."""
    source = Path(__file__).with_name("double_pendulum.F90")
    objects = sorted(str(p) for p in (folder / "lib").glob("*.o"))
    programs = {}
    for mode, flags in (("full", []), ("quarter", ["-DQUARTER"])):
        programs[mode] = work / f"auto_{mode}"
        subprocess.run(["gfortran", "-O3", "-march=native", "-fopenmp", *flags, str(source), *objects, "-o",
                        str(programs[mode])], check=True, cwd=work)
    return programs


def timed(command: list[str], environment: dict[str, str], folder: str | None = None, stdin=subprocess.DEVNULL,
          stdout=subprocess.DEVNULL, stderr=None) -> Run:
    """Runs a process to its end; throws RuntimeError if it fails."""
    process = subprocess.Popen(command, env={**os.environ, "OMP_NUM_THREADS": "1", **environment}, cwd=folder, stdin=stdin,
                               stdout=stdout, stderr=stderr)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} ended with status {process.returncode}")
    return Run(usage.ru_utime, usage.ru_stime)


def trace(programs: dict[str, Path], mode: str, family: str, ntst: int, ncol: int, most: int = 3000) -> Run:
    """One family to T = 30, or, with most = 1, AUTO's own start alone. Throws RuntimeError if it ends elsewhere."""
    number, equilibrium, start, energy = FAMILIES[family]
    common = COMMON.format(ntst=ntst, ncol=ncol, nmx=most)
    runs = {}
    if mode == "full":
        runs["eq"] = f"{NAMES}\n{EQUILIBRIUM}\n{equilibrium}\nsv='eq'\n"
        runs["po"] = (f"{NAMES}\n{common}\nIPS=2, IRS=1, ISP=2, NBC=0\nICP=['mu','PERIOD','H']\n"
                      f"s='eq', TY='{start}', sv='po', UZSTOP={{'PERIOD':30.}}\n")
    else:
        names = NAMES.replace(",6:'T1',7:'T2'", "")
        runs["po"] = (f"{names}\n{common}\nIPS=4, IRS=0, ISP=2, NBC=4\nICP=['PERIOD','H']\n"
                      "sv='po', UZSTOP={'PERIOD':[0.5,7.5]}\n")
    total = Run(0.0, 0.0)
    with tempfile.TemporaryDirectory() as folder:
        for name, constants in runs.items():
            path = Path(folder) / f"c.{name}"
            path.write_text(constants)
            with path.open() as stdin:
                run = timed([str(programs[mode])], {"ORBWEAVER_FAMILY": str(number)}, folder, stdin,
                            stderr=subprocess.DEVNULL)  # underflows, noted by gfortran at every end
            total.user += run.user
            total.system += run.system
        rows = [line.split() for line in (Path(folder) / "b.po").read_text().splitlines()]
    orbits = [row for row in rows if row[0] != "0" and abs(int(row[1])) > 1]
    total.orbits = len(orbits)
    if most > 1:
        period_at, factor = (-2, 1) if mode == "full" else (4, 4)
        period, end = float(orbits[-1][period_at]) * factor, float(orbits[-1][-1])
        if abs(period - 30.0) > 0.1 or abs(end - energy) > 3e-5:
            raise RuntimeError(f"AUTO, {mode}, {family}: ended at T = {period}, E = {end}, not at T = 30 on the family")
    return total
