# SPDX-License-Identifier: LGPL-3.0-or-later
"""How far does a column of sand run out, on which meshes, and where does the
single-material ALE give up?"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

common.TIME_LIMIT = 420
GRAVITY, DENSITY = 9.81, 1600.0
AT_REST = 1e-3  # of the largest kinetic energy
BASE = {"left": {"roller": True}, "bottom": {"fixed": True}}
WALL = {"wall": {"y": 0.0, "grip": "rough"}}
SCENE = {
    "title": "Collapse of a sand column, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": 1.0,
        "height": 0.5,
        "size": 0.1,
        "diagonal": "alternating",
    },
    "material": {
        "sand": {
            "law": "drucker_prager",
            "E": 1e6,
            "nu": 0.3,
            "friction_deg": 30.0,
            "dilation_deg": 0.0,
            "cohesion": 50.0,
            "cone": "plane_strain",
            "density": DENSITY,
        }
    },
    "initial": {"K0": 0.5},
    "stage": [
        {
            "name": "gate",
            "duration": 0.1,
            "step": 0.05,
            "gravity": [0.0, -GRAVITY],
            "boundary": BASE | {"right": {"roller": True}},
        },
        {
            "name": "collapse",
            "duration": 2.0,
            "step": 0.002,
            "step_min": 1e-6,
            "gravity": [0.0, -GRAVITY],
            "dynamics": {"alpha": -0.1, "damping_stiffness": 3e-4},
            "boundary": BASE | {"right": WALL, "top": WALL},
        },
    ],
    "solver": {"max_iterations": 40, "plastic_bubble": False},
    "remap": {
        "mode": "ale",
        "every": 1,
        "quality_below": 0.1,
        "surface": ["right", "top"],
    },
    "output": {
        "fields_every": 0.5,
        "curve": {
            "kinetic": {"quantity": "kinetic_energy"},
            "front": {"quantity": "x_max", "boundary": "right"},
            "height": {"quantity": "y_max", "boundary": "left"},
        },
    },
}
# Aspect ratio, edge over d0. Even numbers of cells both ways: no corner of the free
# surface is then cut off by a diagonal, and no cell flattens with it.
CASES = [(0.5, 0.25), (0.5, 0.125), (0.25, 0.125), (0.75, 0.125), (1.0, 0.125)]
CASES += [(1.0, 0.25), (1.5, 0.125), (0.5, 0.0625), (1.0, 0.0625)]


def scene(a, h):
    return common.with_keys(SCENE, {"mesh.height": a, "mesh.size": h})


def at_rest(run):
    """Kinetic energy at the end over its largest, if the run got there."""
    k = run.curves["kinetic"]
    return k[-1] / k.max()


def row(a, h, run):
    c = run.curves
    return {
        "a": a,
        "h/d0": h,
        "runout": c["front"][-1] - 1,
        "height": c["height"][-1],
        "kinetic end/max": at_rest(run),
        "time": c["time"][-1] - 0.1,
        "steps": len(c["time"]) - 1,
        "seconds": run.seconds,
        "outcome": run.outcome.split(":")[0],
    }


def outline(grid):
    """Boundary edges of a triangle mesh, as pairs of points."""
    edges = np.sort(np.vstack([grid.cells[:, [i, (i + 1) % 3]] for i in range(3)]))
    edges, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    return grid.points[edges[count == 1]]


def came_to_rest(run):
    return run.outcome.startswith("completed") and at_rest(run) < AT_REST


def fit(rows):
    """Power of the runout over a."""
    a = np.log([r["a"] for r in rows])
    return np.polyfit(a, np.log([r["runout"] for r in rows]), 1)


def draw(runs, rows):
    fig, (left, right) = common.figure(2, width=11.4, height=4.6)
    colours = common.COLOURS
    finest = {}
    for (a, h), run in runs.items():
        if came_to_rest(run) and h <= finest.get(a, (9,))[0]:
            finest[a] = (h, run)
    for (a, (h, run)), colour in zip(sorted(finest.items()), colours):
        for pair in outline(run.last):
            left.plot(*pair.T, color=colour, linewidth=1.2)
        left.plot([], [], color=colour, label=f"a = {a}, edge {h}")
    for (a, h), run in runs.items():
        if not came_to_rest(run):
            for cell in run.last.cells:
                x = run.last.points[np.append(cell, cell[0])]
                left.plot(*x.T, color="#999999", linewidth=0.5)
            left.plot([], [], color="#999999", label=f"a = {a}, edge {h}: not at rest")
            break
    left.set_aspect("equal")
    left.set_xlabel("$x/d_0$")
    left.set_ylabel("$y/d_0$")
    left.set_title("Deposits", fontsize=10)
    left.legend(fontsize=8)
    for mark, h in zip(common.MARKERS, sorted({r["h/d0"] for r in rows})):
        some = [r for r in rows if r["h/d0"] == h and came_to_rest(runs[r["a"], h])]
        if some:
            x = [r["a"] for r in some]
            right.loglog(x, [r["runout"] for r in some], mark, label=f"edge {h}")
    a = np.array([0.25, 2.2])
    right.loglog(a, 1.2 * a, color="black", linewidth=1, label="1.2 a, experiments")
    right.set_xlabel("aspect ratio $a = h_0/d_0$")
    right.set_ylabel(r"runout $(d_\infty - d_0)/d_0$")
    right.set_title("Runout of what came to rest", fontsize=10)
    right.legend(fontsize=8)
    common.save(fig, HERE)


def main():
    runs = common.run_all({case: scene(*case) for case in CASES}, fields=True)
    rows = [row(*case, run) for case, run in runs.items()]
    common.write_table(HERE, rows)
    draw(runs, rows)
    for h in sorted({h for _, h in runs}):
        some = [r for r in rows if r["h/d0"] == h and came_to_rest(runs[r["a"], h])]
        if len(some) > 1:
            power, factor = fit(some)
            print(f"edge {h}: runout = {np.exp(factor):.3f} a^{power:.3f}")


if __name__ == "__main__":
    main()
