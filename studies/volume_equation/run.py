# SPDX-License-Identifier: LGPL-3.0-or-later
"""Form P in sand: a footing pushed, lifted until grains part, pushed again;
undrained sand against its limit load; a load that is held."""

import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402
import numpy as np  # noqa: E402

E, NU = 20e6, 0.25
G = E / (2 + 2 * NU)
PHI = math.radians(30)
K0 = 0.5
POROSITY = 0.4
LIMIT = 2 + math.pi  # of a strip footing over c_u, smooth or rough (Prandtl)
SURCHARGE = 1e3  # [Pa]
UNDRAINED_SURCHARGE = 20e3
STIFF = [1e2, 1e3, 1e4]  # K_w / G
HALF = 0.5  # breadth of the footing's half [m]; B = 1 m

FRICTION = {
    "E": E,
    "nu": NU,
    "cohesion": 0.0,
    "friction_deg": math.degrees(PHI),
    "dilation_deg": 0.0,
    "density": 1600.0,
}
LAWS = {
    "drucker_prager": {"law": "drucker_prager", "cone": "plane_strain"} | FRICTION,
    "mohr_coulomb": {"law": "mohr_coulomb"} | FRICTION,
    "hypoplastic": {
        "law": "hypoplastic",
        "sand": "hochstetten",
        "intergranular_strain": "off",
        "void_ratio": 0.75,
        "grain_density": 2650.0,
    },
}
SIDES = {"left": {"roller": True}, "right": {"roller": True}, "bottom": {"fixed": True}}
GRIPS = {"rough": {"displacement_x": 0.0}, "smooth": {}}

FOOTING = {
    "title": "A strip footing on sand, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": 2.0,
        "height": 1.0,
        "cells": [20, 10],
        "diagonal": "alternating",
    },
    "boundary": {
        "punch": {"side": "top", "to": HALF},
        "surface": {"side": "top", "from": HALF},
    },
    "solver": {"element": "mini", "tolerance": 1e-8, "max_iterations": 40},
    "remap": {"mode": "lagrangian"},
    "output": {
        "curve": {
            "z": {
                "quantity": "displacement_y",
                "boundary": "punch",
                "divide_by": -1.0,
            },
            "q": {
                "quantity": "reaction_y",
                "boundary": "punch",
                "divide_by": -HALF,
            },
        }
    },
}


def stage(name, duration, step, surcharge, gravity, punch):
    return {
        "name": name,
        "duration": duration,
        "step": step,
        "gravity": [0.0, -gravity],
        "boundary": SIDES | {"surface": {"pressure": surcharge}, "punch": punch},
    }


def scene(law, stages, surcharge, changes=()):
    out = common.with_keys(FOOTING, dict(changes))
    out["material"] = {"sand": LAWS[law]}
    out["initial"] = {"K0": K0, "surcharge": surcharge}
    out["stage"] = stages
    return out


def moved(grip, times, values):
    return GRIPS[grip] | {"displacement_y": {"time": times, "value": values}}


def pushed(law, grip, flow):
    """0.1 B down, 0.02 B up, to 0.14 B, in steps of 1e-3 B."""
    punch = moved(grip, [0.0, 0.1, 0.12, 0.18], [0.0, -0.1, -0.08, -0.14])
    changes = {"solver.plastic_bubble": flow}
    stages = [stage("push", 0.18, 1e-3, SURCHARGE, 10.0, punch)]
    return scene(law, stages, SURCHARGE, changes)


def undrained(law, grip, stiff, cells=20, **changes):
    """Next to no weight, so that c_u is the same everywhere; to 0.05 B."""
    punch = moved(grip, [0.0, 0.05], [0.0, -0.05])
    changes = {
        "mesh.cells": [cells, cells // 2],
        "water": {
            "drainage": "undrained",
            "porosity": POROSITY if law != "hypoplastic" else 0.0,
            "bulk_modulus": POROSITY * stiff * G,
            "grain_bulk_modulus": 1e15,
            "density": 0.0,
        },
    } | {f"solver.{key}": value for key, value in changes.items()}
    # K0 asks for gravity: 0.05 % of the surcharge at a depth of B/2
    stages = [stage("push", 0.05, 5e-4, UNDRAINED_SURCHARGE, 1e-2, punch)]
    return scene(law, stages, UNDRAINED_SURCHARGE, changes)


def strength(law):
    """c_u of elastic sand that does not dilate (README.md)."""
    if law == "drucker_prager":
        return (1 + 2 * K0) / 3 * UNDRAINED_SURCHARGE * math.sin(PHI)
    if law == "mohr_coulomb":
        return (1 + K0) / 2 * UNDRAINED_SURCHARGE * math.sin(PHI)
    return math.nan


def held(law):
    """A load within a second, then fifty steps in which nothing changes."""
    load = {"pressure": {"time": [0.0, 1.0], "value": [10e3, 60e3]}}
    stages = [stage("load", 6.0, 0.1, 10e3, 10.0, load)]
    return scene(law, stages, 10e3, {"solver.tolerance": 1e-10})


def neighbours_mean(grid, values):
    """Mean over the nodes that share an edge, and which nodes lie inside."""
    edges = {}
    for cell in grid.cells:
        for a, b in ((0, 1), (1, 2), (2, 0)):
            key = tuple(sorted((cell[a], cell[b])))
            edges[key] = edges.get(key, 0) + 1
    total, count = np.zeros(len(values)), np.zeros(len(values))
    inside = np.ones(len(values), dtype=bool)
    for (a, b), cells in edges.items():
        for i, j in ((a, b), (b, a)):
            total[i] += values[j]
            count[i] += 1
        if cells == 1:
            inside[[a, b]] = False
    return total / count, inside


def noise(grid):
    """Median of |(I - S)^2 p| over the mean of |p|."""
    p = np.ravel(grid.nodal["pressure"])
    smooth, inside = neighbours_mean(grid, p)
    rough = p - smooth
    rough -= neighbours_mean(grid, rough)[0]
    return float(np.median(np.abs(rough[inside])) / np.mean(np.abs(p)))


def creep(run):
    """What is settled in the fifty held steps, of all."""
    t, z = run.curves["time"], run.curves["z"]
    if run.outcome != "completed":
        return math.nan
    return float(abs(z[-1] - np.interp(1.0, t, z)) / abs(z[-1]))


def row_of(kind, name, run):
    law, grip, other, cells = name
    steps = max(run.summary["steps"], 1)
    apex = run.last.cell.get("apex") if run.last is not None else None
    q = run.curves["q"]
    limit = LIMIT * strength(law) if kind == "undrained" else math.nan
    done = run.outcome == "completed"
    # beyond the surcharge, before heave adds to it
    bears = math.nan
    if kind == "undrained":
        bears = float(np.interp(0.02, run.curves["z"], q)) - UNDRAINED_SURCHARGE
    return {
        "case": kind,
        "law": law,
        "grip": grip,
        "variant": other,
        "cells": cells,
        "done": int(done),
        "reached": float(run.curves["time"][-1]),
        "steps": steps,
        "rejected": run.summary["rejected_steps"],
        "iterations": run.summary["newton_iterations"] / steps,
        "apex": float(np.sum(apex)) if apex is not None else 0.0,
        "noise": noise(run.last),
        "q": float(q[-1]),
        "bears": bears,
        "over": bears / limit - 1 if kind == "undrained" else math.nan,
        "creep": creep(run) if kind == "held" else math.nan,
        "grain_gap": float(run.curves.get("grain_gap", [math.nan])[-1]),
        "patch_gap": float(run.curves.get("grain_gap_patch", [math.nan])[-1]),
        "seconds": run.seconds,
    }


def cases():
    out = {}
    for grip in GRIPS:
        for law in LAWS:
            for flow in (True, False) if law != "hypoplastic" else (True,):
                name = (law, grip, "flow" if flow else "no flow", 20)
                out[("pushed",) + name] = pushed(law, grip, flow)
    for law in LAWS:
        for stiff in STIFF:
            name = (law, "rough", f"{stiff:.0e}", 20)
            out[("undrained",) + name] = undrained(law, "rough", stiff)
    for law in ("drucker_prager", "mohr_coulomb"):
        name = (law, "smooth", "1e+03", 20)
        out[("undrained",) + name] = undrained(law, "smooth", 1e3)
        name = (law, "rough", "1e+03", 40)
        out[("undrained",) + name] = undrained(law, "rough", 1e3, 40)
        name = (law, "rough", "1e+03, no flow", 20)
        out[("undrained",) + name] = undrained(law, "rough", 1e3, plastic_bubble=False)
        name = (law, "rough", "1e+03, no bubble", 20)
        out[("undrained",) + name] = undrained(law, "rough", 1e3, element="equal_order")
    for law in LAWS:
        out[("held", law, "free", "", 20)] = held(law)
    return out


def draw(runs, rows):
    fig, axes = common.figure(2, rows=2, width=10.2, height=7.6)
    for ax, grip in zip(axes[0], GRIPS):
        for i, law in enumerate(LAWS):
            for flow, line in (("flow", "-"), ("no flow", "--")):
                run = runs.get(("pushed", law, grip, flow, 20))
                if run is None:
                    continue
                ax.plot(
                    run.curves["z"],
                    np.array(run.curves["q"]) / 1e3,
                    line,
                    color=common.COLOURS[i],
                    label=law + (", λ = 0" if flow == "no flow" else ""),
                )
                if run.outcome != "completed":
                    ax.plot(
                        run.curves["z"][-1],
                        run.curves["q"][-1] / 1e3,
                        "x",
                        color=common.COLOURS[i],
                    )
        ax.set(xlabel="z/B", ylabel="load on the footing [kPa]", title=f"dry, {grip}")
        ax.legend(fontsize=8)
    ax = axes[1][0]
    for (kind, law, grip, variant, cells), run in runs.items():
        if kind != "undrained" or law == "hypoplastic" or grip == "smooth":
            continue
        line = "-" if cells == 20 else "-."
        if "," in variant:
            line = ":" if "no bubble" in variant else "--"
        elif cells == 20 and variant != "1e+03":
            continue  # on top of one another: see the table
        bears = np.array(run.curves["q"]) - UNDRAINED_SURCHARGE
        ax.plot(
            run.curves["z"],
            np.where(np.array(run.curves["z"]) > 0, bears / strength(law), 0),
            line,
            color=common.COLOURS[list(LAWS).index(law)],
            label=f"{law} {variant}, {cells} cells",
        )
    ax.axhline(LIMIT, color="grey", linewidth=1)
    ax.text(0.045, LIMIT - 0.4, "2 + π", color="grey")
    ax.set(xlabel="z/B", ylabel="(q − surcharge)/c_u", title="undrained, K_w/G")
    ax.legend(fontsize=7)
    ax = axes[1][1]
    chosen = [r for r in rows if r["cells"] == 20 and r["case"] != "held"]
    labels = [f"{r['case']} {r['law']} {r['grip']} {r['variant']}" for r in chosen]
    ax.barh(
        range(len(chosen)),
        [r["noise"] for r in chosen],
        color=["#cc6677" if "no " in r["variant"] else "#4477aa" for r in chosen],
    )
    ax.set_yticks(range(len(chosen)), labels, fontsize=5)
    ax.invert_yaxis()
    ax.set(xscale="log", xlabel="noise of p over mean p, end of the run")
    common.save(fig, HERE)


def main():
    runs = common.run_all(cases(), fields=True)
    rows = [row_of(kind, tuple(name), run) for (kind, *name), run in runs.items()]
    common.write_table(HERE, rows)
    draw(runs, rows)


if __name__ == "__main__":
    main()
