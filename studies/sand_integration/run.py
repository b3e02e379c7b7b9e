# SPDX-License-Identifier: LGPL-3.0-or-later
"""What does an error in hypoplastic sand cost? Integrators and tolerances along
paths at a point; tangents and tolerances under a strip load."""

import csv
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent)]
import common  # noqa: E402

ROLLERS = {side: {"roller": True} for side in ("left", "right", "bottom")}
SCENE = {
    "title": "Strip load on sand, for a study",
    "symmetry": "plane_strain",
    "mesh": {"shape": "rectangle", "width": 1.0, "height": 1.0, "size": 0.1},
    "boundary": {
        "strip": {"side": "top", "to": 0.5},
        "rest": {"side": "top", "from": 0.5},
    },
    "material": {
        "sand": {
            "law": "hypoplastic",
            "sand": "hochstetten",
            "intergranular_strain": "on",
            "void_ratio": 0.7,
            "grain_density": 2650.0,
            "p_t": 10e3,  # so that it may begin without stress
            "tolerance": 1e-4,
        }
    },
    "stage": [
        {
            "name": "oedometer",
            "duration": 1.0,
            "step": 0.05,
            "boundary": {
                "strip": {"pressure": {"time": [0.0, 1.0], "value": [0.0, 1e5]}},
                "rest": {"pressure": {"time": [0.0, 1.0], "value": [0.0, 1e5]}},
            }
            | ROLLERS,
        },
        {
            "name": "strip",
            "duration": 1.0,
            "step": 0.05,
            "boundary": {
                "strip": {"pressure": {"time": [0.0, 1.0], "value": [1e5, 4e5]}},
                "rest": {"pressure": 1e5},
            }
            | ROLLERS,
        },
    ],
    "solver": {
        "element": "mini",
        "tangent": "consistent",
        "tolerance": 1e-8,
        "max_iterations": 20,
        "line_search": True,
    },
    "remap": {"mode": "lagrangian"},
    "output": {
        "curve": {"uy": {"quantity": "displacement_y", "boundary": "strip"}},
    },
}
TANGENTS = ["consistent", "continuum"]
TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5]
TIGHT = 1e-7


def at_points():
    program = common.built("sand_points", "sand_integration/program/sand_points")
    text = common.output([program])
    print(text)
    return list(csv.DictReader(text.splitlines()))


def under_load():
    cases = {("tight",): common.with_keys(SCENE, {"material.sand.tolerance": TIGHT})}
    for tangent in TANGENTS:
        for tolerance in TOLERANCES:
            cases[(tangent, tolerance)] = common.with_keys(
                SCENE,
                {"solver.tangent": tangent, "material.sand.tolerance": tolerance},
            )
    runs = common.run_all(cases)
    exact = runs[("tight",)].curves["uy"][-1]
    rows = []
    for (tangent, *tolerance), run in runs.items():
        if not tolerance:
            continue
        done = run.outcome == "completed"
        rows.append(
            {
                "path": "strip load",
                "integrator": tangent,
                "tolerance": tolerance[0],
                "error": (
                    abs(run.curves["uy"][-1] / exact - 1) if done else float("nan")
                ),
                "us": float("nan"),
                "us_tangent": float("nan"),
                "substeps": float("nan"),
                "rejected": float("nan"),
                "calls": float("nan"),
                "steps": len(run.curves["time"]) - 1,
                "iterations": float(sum(run.curves["iterations"])),
                "seconds": run.seconds,
                "reached": float(run.curves["time"][-1]) / 2,
            }
        )
    return rows


def draw(points, loads):
    fig, axes = common.figure(columns=2, rows=2, width=9.6, height=7.2)
    paths = list(dict.fromkeys(row["path"] for row in points))
    for ax, path in zip(axes.flat, paths):
        names = dict.fromkeys(row["integrator"] for row in points)
        for i, name in enumerate(names):
            chosen = [
                r for r in points if r["path"] == path and r["integrator"] == name
            ]
            chosen = [r for r in chosen if float(r["error"]) == float(r["error"])]
            ax.plot(
                [float(r["us"]) for r in chosen],
                [float(r["error"]) for r in chosen],
                color=common.COLOURS[i],
                marker=common.MARKERS[i],
                markersize=4,
                label=name,
            )
        ax.axhline(1e-3, color="#888888", linewidth=0.8, linestyle="--")
        ax.set(xscale="log", yscale="log", title=path)
        ax.set_xlabel("processor time of the path [µs]")
        ax.set_ylabel("largest error of the stress")
    axes.flat[0].legend()
    ax = axes.flat[3]
    for i, tangent in enumerate(TANGENTS):
        chosen = [r for r in loads if r["integrator"] == tangent]
        ax.plot(
            [r["seconds"] for r in chosen],
            [r["error"] for r in chosen],
            color=common.COLOURS[i],
            marker=common.MARKERS[i],
            label=tangent + " tangent",
        )
        for r in chosen:
            ax.annotate(
                f"{r['iterations']:.0f}",
                (r["seconds"], r["error"]),
                textcoords="offset points",
                xytext=(5, 4),
                fontsize=8,
            )
    ax.set(xscale="log", yscale="log", title="strip load, 200 cells, 2 × 20 steps")
    ax.set_xlabel("processor time of the run [s]; labels: Newton iterations")
    ax.set_ylabel("error of the settlement")
    ax.legend()
    common.save(fig, HERE)


def main():
    points, loads = at_points(), under_load()
    table = []
    for row in points:
        new = {}
        for key, value in row.items():
            new[key] = value if key in ("path", "integrator") else float(value)
        none = float("nan")
        table.append(new | dict(steps=none, iterations=none, seconds=none, reached=1.0))
    common.write_table(HERE, table + loads)
    draw(points, loads)


if __name__ == "__main__":
    main()
