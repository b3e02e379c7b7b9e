# SPDX-License-Identifier: LGPL-3.0-or-later
"""What all studies share: scenes written whole, runs timed, tables, charts.

A study states every key that matters to it, so that a demo may change without
changing the study. Seconds are the processor's, user and system, of one process
without threads: on a core of its own that is the wall time, and on a machine
shared with others it is still that, nearly. Cases run in turn and the whole
round is repeated; the least of a case counts.
"""

import copy
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "cpp" / "output"))
from picture import COLOURS, STYLE  # noqa: E402
from read_run import nearest_output, read_curves, read_grid  # noqa: E402

EXACT = (2 + np.pi) / np.sqrt(3)  # p / sigma_y of the piercing, Prandtl
MARKERS = "osD^vPX<>"
TIME_LIMIT = 240  # of one run [s]
SHORT = 5  # [s]

PIERCING = {
    "title": "Piercing of a J2 billet, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": 1.0,
        "height": 1.5,
        "size": 0.05,
        "diagonal": "right",
        "grading": {"towards": [0.5, 1.5], "size": 0.0125, "growth": 1.15},
    },
    "boundary": {
        "punch": {"side": "top", "to": 0.5},
        "surface": {"side": "top", "from": 0.5},
    },
    "material": {
        "billet": {
            "law": "j2",
            "E": 2.6e6,
            "nu": 0.3,
            "yield_stress": 20e3,
            "hardening": 0.0,
            "density": 1000.0,
        }
    },
    "stage": [
        {
            "name": "push",
            "duration": 0.06,
            "step": 0.001,
            "boundary": {
                "punch": {"displacement_x": 0.0, "velocity_y": -1.0},
                "surface": {"wall": {"x": 0.5, "grip": "smooth"}},
                "left": {"roller": True},
                "right": {"roller": True},
                "bottom": {"roller": True},
            },
        }
    ],
    "solver": {
        "element": "mini",
        "tangent": "consistent",
        "geometric_stiffness": True,
        "tolerance": 1e-8,
        "max_iterations": 15,
        "lag_jacobian": 1,
        "line_search": True,
        "plastic_bubble": True,
    },
    "remap": {
        "mode": "ale",
        "every": 1,
        "quality_below": 0.0,
        "smoother": "optimise",
        "target": "initial",
        "sweeps": 5,
        "transport": "limited_linear",
        "surface": ["surface"],
    },
    "output": {
        "curve": {
            "z_B": {
                "quantity": "displacement_y",
                "boundary": "punch",
                "divide_by": -1.0,
            },
            "p_sy": {
                "quantity": "reaction_y",
                "boundary": "punch",
                "divide_by": -20e3,
                "breadth": "nominal",
            },
        }
    },
}


def built(target, where, hint=""):
    """What a study's own target makes, built beside the solver, as a path."""
    solver = os.environ.get("MMALE_PROGRAM")
    if not solver:
        sys.exit("MMALE_PROGRAM is not set: start studies with ./mmale study NAME")
    build = Path(solver).resolve().parent.parent
    words = ["cmake", "--build", str(build), "--target", target]
    if subprocess.run(words, stdout=subprocess.DEVNULL).returncode:
        sys.exit(f"{target} does not build{hint}")
    return str(build / "studies" / where)


def output(words):
    """What a program prints; what it says of a failure ends the study."""
    words = [str(word) for word in words]
    run = subprocess.run(words, capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"{' '.join(words)}: {run.returncode}\n{run.stderr}")
    return run.stdout


def with_keys(scene, changes):
    """A copy of a scene; changes by dotted key, None takes a key away."""
    out = copy.deepcopy(scene)
    for key, value in changes.items():
        *path, last = key.split(".")
        table = out
        for word in path:
            table = table[int(word)] if isinstance(table, list) else table[word]
        if value is None:
            table.pop(last, None)
        else:
            table[last] = value
    return out


def toml(value):
    """A value as TOML writes it; tables inline."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return json.dumps(value)


@dataclass
class Run:
    """What a run came to."""

    outcome: str  # as in summary.json; "time limit"
    seconds: float  # of the processor, whole process
    summary: dict
    curves: dict  # column -> values
    first: object = None  # fields at the start, if asked for
    last: object = None  # and at the end

    def at(self, z, column="p_sy", along="z_B"):
        """A column's value at a penetration; NaN beyond the run's end."""
        x, y = self.curves[along], self.curves[column]
        return float(np.interp(z, x, y)) if x[-1] > z - 1e-9 else np.nan

    def excess(self, z):
        """How far the pressure is above the limit load [%]."""
        return 100 * (self.at(z) / EXACT - 1)

    @property
    def reached(self):
        return float(self.curves["z_B"][-1])


def run(scene, fields=False, ranks=1):
    """One run of a scene in a folder that is gone afterwards."""
    program = os.environ.get("MMALE_PROGRAM")
    if not program:
        sys.exit("MMALE_PROGRAM is not set: start studies with ./mmale study NAME")
    with tempfile.TemporaryDirectory(prefix="mmale-study-") as folder:
        folder = Path(folder)
        text = "".join(f"{k} = {toml(v)}\n" for k, v in scene.items())
        (folder / "scene.toml").write_text(text)
        words = [program, "run", str(folder / "scene.toml"), "--quiet"]
        words += ["--results", str(folder / "out")]
        if ranks > 1:
            words = ["mpirun", "-n", str(ranks)] + words
        # nothing is drawn: an empty program in the place of the draughtsman
        environment = os.environ | {"OMP_NUM_THREADS": "1", "MMALE_DRAW": os.devnull}
        with open(folder / "log", "w") as log:
            process = subprocess.Popen(
                words, stdout=log, stderr=subprocess.STDOUT, env=environment
            )
            begin = time.monotonic()
            pid = 0
            while not pid:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if not pid:
                    if time.monotonic() - begin > TIME_LIMIT:
                        process.kill()
                    time.sleep(0.02)
            code = process.returncode = os.waitstatus_to_exitcode(status)
        if code not in (0, 3, 4, -9):
            sys.exit(f"{' '.join(words)}: {code}\n{(folder / 'log').read_text()}")
        summary = json.loads((folder / "out" / "summary.json").read_text())
        outcome = "time limit" if code == -9 else summary["outcome"]
        out = Run(
            outcome,
            usage.ru_utime + usage.ru_stime,
            summary,
            read_curves(folder / "out"),
        )
        if fields:
            pvd = folder / "out" / "fields.pvd"
            out.first = read_grid(nearest_output(pvd, 0.0)[1], 0.0)
            out.last = read_grid(*reversed(nearest_output(pvd, None)))
        return out


def run_all(cases, repeats=1, fields=False):
    """Runs by case, in turn; `seconds` is the least over the repeats.

    Only short runs are repeated: long ones average the noise themselves.

    cases  name -> scene
    """
    runs = {}
    for repeat in range(repeats):
        for name, scene in cases.items():
            if name in runs and runs[name].seconds > SHORT:
                continue
            one = run(scene, fields)
            label = name if isinstance(name, str) else " ".join(map(str, name))
            print(
                f"{repeat + 1}/{repeats} {label}: {one.seconds:.1f} s, {one.outcome}",
                flush=True,
            )
            if name in runs:
                one.seconds = min(one.seconds, runs[name].seconds)
            runs[name] = one
    return runs


def short(value):
    """A number as a table wants it."""
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.6g}"
    return value


def write_table(folder, rows):
    """results.csv from a list of dicts with the same keys."""
    with open(Path(folder) / "results.csv", "w", newline="") as stream:
        out = csv.writer(stream, lineterminator="\n")
        out.writerow(rows[0])
        for row in rows:
            out.writerow([short(v) for v in row.values()])
    for row in rows:
        print("  ".join(f"{short(v)}" for v in row.values()))


def read_table(folder):
    """The rows of results.csv, as text."""
    with open(Path(folder) / "results.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def figure(columns=1, width=7.2, height=4.6, rows=1, **options):
    """Axes in the look of the pictures of runs."""
    plt.rcParams.update(STYLE)
    # the same drawing gives the same file
    plt.rcParams["svg.hashsalt"] = "mmale"
    fig, axes = plt.subplots(
        rows, columns, figsize=(width, height), layout="constrained", **options
    )
    for ax in np.ravel(axes):
        ax.grid(True, which="major", color="#dddddd", linewidth=0.5)
        ax.set_axisbelow(True)
    return fig, axes


def save(fig, folder):
    """chart.svg; where MMALE_STUDY_PNG names a folder, a PNG there too."""
    folder = Path(folder)
    fig.savefig(folder / "chart.svg", metadata={"Date": None})
    if other := os.environ.get("MMALE_STUDY_PNG"):
        fig.savefig(Path(other) / f"{folder.name}.png", dpi=110)
    plt.close(fig)
    text = (folder / "chart.svg").read_text().splitlines()
    (folder / "chart.svg").write_text("\n".join(s.rstrip() for s in text) + "\n")


__all__ = [
    "COLOURS",
    "EXACT",
    "MARKERS",
    "PIERCING",
    "Run",
    "figure",
    "read_table",
    "run",
    "run_all",
    "save",
    "with_keys",
    "write_table",
]
