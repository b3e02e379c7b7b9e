# SPDX-License-Identifier: LGPL-3.0-or-later
"""What does a converged elastoplastic step cost, and who else would pay what?

The piercing block in the plastic range, by the solver and by the program that a
DOLFINx user would write (baseline/), on one mesh with the same steps, tolerance
and MUMPS. With --draw the chart is drawn anew from results.csv; with words from KINDS
only the rows of these kinds are measured anew. Rows of kind "scaling" are seconds of
the wall.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

# A stiff metal, yield strain 7.7e-5, so that small and finite strain give one
# answer: the limit load is reached at a penetration of 4e-4.
STIFF = 2.6e8
STEP, STEPS = 2e-5, 16
common.TIME_LIMIT = 150  # [s]: some ten times a good run
MIDDLE = 2e-4  # where the load is still rising
NODES = {36080: [110, 164], 9408: [56, 84], 2296: [28, 41]}  # triangles, cells
BLOCK = common.with_keys(
    common.PIERCING,
    {
        "title": "A block in the plastic range, for a study",
        "mesh": {
            "shape": "rectangle",
            "width": 1.0,
            "height": 1.5,
            "cells": NODES[36080],
            "diagonal": "right",
        },
        "boundary.surface": None,
        "material.billet.E": STIFF,
        "stage.0.duration": STEPS * STEP,
        "stage.0.step": STEP,
        "stage.0.boundary.surface": None,
        "solver.lag_jacobian": 0,
        "remap": {"mode": "lagrangian"},
    },
)
PATIENT = {"solver.max_iterations": 60}
GMRES = (
    "-lagrangian_snes_lag_preconditioner {} -lagrangian_ksp_type fgmres "
    "-lagrangian_ksp_rtol 1e-3 -lagrangian_snes_max_linear_solve_fail 100"
)
FRESH = {"solver.lag_jacobian": 1}
CHOICES = {
    "default": {},
    "factorise always (lag 1)": FRESH,
    "lag 2": PATIENT | {"solver.lag_jacobian": 2},
    "lag 3": PATIENT | {"solver.lag_jacobian": 3},
    "lag 5": PATIENT | {"solver.lag_jacobian": 5},
    "lag inf": {"solver.lag_jacobian": 1000, "solver.max_iterations": 200},
    "GMRES, factor every 2nd": FRESH | {"solver.petsc": GMRES.format(2)},
    "GMRES, factor once a step": FRESH | {"solver.petsc": GMRES.format(1000)},
    "LDLT of the symmetric part": {"solver.factorisation": "ldlt"},
    "no plastic bubble, LDLT": {"solver.plastic_bubble": False},
    "no plastic bubble, LU": {
        "solver.plastic_bubble": False,
        "solver.factorisation": "lu",
    },
    "no geometric stiffness": {"solver.geometric_stiffness": False},
    "continuum tangent": {"solver.tangent": "continuum", "solver.max_iterations": 200},
    "MUMPS scales": {
        "solver.petsc": "-lagrangian_mat_mumps_icntl_6 7 "
        "-lagrangian_mat_mumps_icntl_8 77"
    },
}
LAYOUTS = {
    "3 points": {"solver.layout": "quadrature", "solver.points": 3},
    "6 points": {"solver.layout": "quadrature", "solver.points": 6},
}
MESHES = {
    f"{triangles} triangles": {"mesh.cells": cells}
    for triangles, cells in NODES.items()
    if triangles != 36080
}


def graded(size):
    """Cells that shrink to `size` [m] at the punch's corner."""
    grading = {"towards": [0.5, 1.5], "size": size, "growth": 1.15}
    return {"mesh.cells": None, "mesh.size": 8 * size, "mesh.grading": grading}


GRADED = {
    f"graded, edge 1/{round(1 / size)} at the corner": graded(size)
    for size in (0.0125, 0.00625, 0.003125)
}
BASELINE = {
    "DOLFINx user": ["rest"],
    "DOLFINx user, starts from the last motion": [],
    "DOLFINx user, last motion and LDLT": ["ldlt"],
}


def known(scene):
    """Whether the program can read the scene: some keys are newer than others."""
    with tempfile.TemporaryDirectory(prefix="mmale-study-") as folder:
        file = Path(folder) / "scene.toml"
        text = "".join(f"{k} = {common.toml(v)}\n" for k, v in scene.items())
        file.write_text(text)
        words = [os.environ["MMALE_PROGRAM"], "check", str(file)]
        return subprocess.run(words, capture_output=True).returncode == 0


def build_baseline():
    """The baseline program, built beside the solver."""
    build = Path(os.environ["MMALE_PROGRAM"]).resolve().parent.parent
    words = ["cmake", "--build", str(build), "--target", "lagrangian_baseline"]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return build / "studies" / "lagrangian_step" / "baseline" / "lagrangian_baseline"


def run_baseline(program, words, cells):
    """(seconds of the processor, steps) of one run."""
    words = [str(program), f"nx={cells[0]}", f"ny={cells[1]}"] + words
    words += [f"steps={STEPS}", f"step={STEP}", f"E={STIFF}"]
    begin = os.times()
    done = subprocess.run(
        words,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
    )
    end = os.times()
    if done.returncode:
        sys.exit(f"{' '.join(words)}: {done.returncode}")
    seconds = sum(end[2:4]) - sum(begin[2:4])
    return seconds, json.loads(done.stdout[done.stdout.index("{") :])["steps"]


def baseline_row(name, program, words, cells, repeats):
    best, steps = 1e9, []
    for _ in range(repeats):
        seconds, steps = run_baseline(program, words, cells)
        best = min(best, seconds)
    print(f"{name}: {best:.1f} s", flush=True)
    whole_run = steps[-1]["iterations"] > 0
    if not whole_run:
        steps = steps[:-1] or steps
    at = {round(s["depth"] / STEP): s["reaction"] / 1e4 for s in steps}
    law = sum(s["parts"]["strain and law"] for s in steps)
    solve = sum(s["parts"]["factorise and solve"] for s in steps)
    whole = sum(s["seconds"] for s in steps)
    assembly = sum(s["parts"]["residual"] + s["parts"]["tangent"] for s in steps)
    return row(
        name,
        "baseline",
        2 * cells[0] * cells[1],
        best,
        len(steps),
        sum(s["iterations"] for s in steps),
        (law + assembly) / whole,
        solve / whole,
        at.get(round(MIDDLE / STEP), float("nan")),
        at.get(STEPS, float("nan")),
        "completed" if whole_run else "no convergence",
    )


def row(name, kind, triangles, seconds, steps, its, law, solve, middle, end, how):
    return {
        "choice": name,
        "kind": kind,
        "triangles": triangles,
        "seconds a step": seconds / steps if steps else float("nan"),
        "iterations a step": its / steps if steps else float("nan"),
        "seconds an iteration": seconds / its if its else float("nan"),
        "share of law and assembly": law,
        "share of factorise and solve": solve,
        "steps": steps,
        "p_sy at 2e-4": middle,
        "p_sy at 3.2e-4": end,
        "outcome": how,
    }


def our_row(name, kind, run):
    """One of the solver's runs; rejected steps count in the seconds."""
    summary = run.summary
    timers = {t["name"]: t["seconds"] for t in summary["timers"]}
    whole = timers.get("1 lagrangian", float("nan"))
    # the baseline writes no fields
    output = sum(t["share"] for t in summary["timers"] if t["name"] == "5 output")
    run.seconds *= 1 - output
    return row(
        name,
        kind,
        summary["cells"],
        run.seconds,
        len(run.curves["iterations"]) - 1,
        int(sum(run.curves["iterations"])),
        timers.get("1a law and assembly", float("nan")) / whole,
        timers.get("1b factorise and solve", float("nan")) / whole,
        run.at(MIDDLE),
        run.at(STEPS * STEP),
        run.outcome.split(":")[0],
    )


def scaling():
    """Wall seconds a step of one and two ranks, on this machine as it is."""
    rows = []
    half = {"mesh.cells": [78, 116]}
    for name, ranks, keys in (
        ("strong, 1 rank", 1, {}),
        ("strong, 2 ranks", 2, {}),
        ("weak, 1 rank with half the triangles", 1, half),
        ("weak, 2 ranks", 2, {}),
    ):
        best = None
        for _ in range(2):
            run = common.run(common.with_keys(BLOCK, SHORT | keys), ranks=ranks)
            timers = {t["name"]: t["seconds"] for t in run.summary["timers"]}
            run.seconds = timers["1 lagrangian"]
            if best is None or run.seconds < best.seconds:
                best = run
        print(f"{name}: {best.seconds:.1f} s (wall)", flush=True)
        rows.append(our_row(name, "scaling", best))
    return rows


KINDS = ["choice", "layout", "baseline", "mesh", "graded", "reference", "scaling"]
SHORT = {"stage.0.duration": 6 * STEP}


def draw(rows):
    fig, (left, right) = common.figure(2, width=11, height=5.6, width_ratios=[1.25, 1])
    bars = [r for r in rows if r["kind"] in ("choice", "layout", "baseline")]
    bars = [r for r in bars if r["triangles"] == "36080"][::-1]
    colours = {"choice": 0, "layout": 2, "baseline": 1}
    # bars that stop early may be long: cut off
    edge = 1.7 * max(
        float(r["seconds a step"]) for r in bars if r["outcome"] == "completed"
    )
    for y, r in enumerate(bars):
        colour = common.COLOURS[colours[r["kind"]]]
        time = float(r["seconds a step"])
        solve = time * float(r["share of factorise and solve"] or 0)
        left.barh(y, time, height=0.7, color=colour, alpha=0.45)
        left.barh(y, solve, height=0.7, color=colour)
        left.text(
            min(time, 0.61 * edge),
            y,
            f" {time:.2f} s, {float(r['iterations a step']):.1f} it"
            + ("" if r["outcome"] == "completed" else ", " + r["outcome"]),
            va="center",
            fontsize=8,
        )
    left.set_yticks(range(len(bars)), [r["choice"] for r in bars], fontsize=8)
    left.set_xlim(0, edge)
    left.set_xlabel("processor seconds a converged step (dark: factorise and solve)")
    left.set_title("36 080 triangles", fontsize=10)

    reference = float(next(r for r in rows if r["kind"] == "reference")["p_sy at 2e-4"])
    groups = {
        "choice": ("the solver, uniform", 0),
        "mesh": ("the solver, uniform", 0),
        "graded": ("the solver, graded", 2),
        "layout": ("the solver, points", 3),
        "baseline": ("DOLFINx user", 1),
    }
    series = {}
    for r in rows:
        if r["kind"] not in groups or (
            r["kind"] == "choice" and r["choice"] != "default"
        ):
            continue
        if r["kind"] == "baseline" and "last motion" in r["choice"]:
            continue
        label, colour = groups[r["kind"]]
        error = 100 * abs(float(r["p_sy at 2e-4"]) / reference - 1)
        series.setdefault((label, colour), []).append(
            (float(r["seconds a step"]), error)
        )
    for (label, colour), points in series.items():
        x, y = zip(*sorted(points))
        right.loglog(
            x,
            y,
            common.MARKERS[colour] + "-",
            color=common.COLOURS[colour],
            label=label,
        )
    right.set_xlabel("processor seconds a step")
    right.set_ylabel("error of the load at $z/B = 2\\times10^{-4}$ [%]")
    right.legend(fontsize=8)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        draw(common.read_table(HERE))
        return
    kinds = sys.argv[1:] or KINDS
    rows = []
    if "baseline" in kinds:
        program = build_baseline()
        rows += [
            baseline_row(name, program, words, cells, 1)
            for cells in NODES.values()
            for name, words in BASELINE.items()
            if cells == NODES[36080] or words == ["rest"]
        ]
    cases = {("choice", name): keys for name, keys in CHOICES.items()}
    cases |= {
        ("layout", name): keys
        for name, keys in LAYOUTS.items()
        if known(common.with_keys(BLOCK, keys))
    }
    cases |= {("mesh", name): keys for name, keys in MESHES.items()}
    cases |= {("graded", name): keys for name, keys in GRADED.items()}
    cases[("reference", "graded, edge 1/640 at the corner")] = graded(0.0015625)
    runs = common.run_all(
        {
            case: common.with_keys(BLOCK, keys)
            for case, keys in cases.items()
            if case[0] in kinds
        },
        repeats=2,
    )
    rows += [our_row(name, kind, run) for (kind, name), run in runs.items()]
    if "scaling" in kinds:
        rows += scaling()
    if sys.argv[1:]:
        rows += [r for r in common.read_table(HERE) if r["kind"] not in kinds]
    rows.sort(key=lambda r: KINDS.index(r["kind"]))
    common.write_table(HERE, rows)
    draw(common.read_table(HERE))


if __name__ == "__main__":
    main()
