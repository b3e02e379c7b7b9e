# SPDX-License-Identifier: LGPL-3.0-or-later
"""How wrong is a regularised Bingham fluid, and what does less of it cost?

Channel and pipe with exact solutions; `regularisation` is the shear rate below
which the law `herschel_bulkley` is merely very viscous. Beside it, without a
mesh: the two smooth substitutes that are common, at the same largest viscosity.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

WIDTH, VISCOSITY, FORCE = 0.1, 0.5, 100.0  # [m], [Pa s], [Pa/m]
YIELD = {"channel": 4.0, "pipe": 2.0}  # [Pa]
PLUG = 0.04  # half width of both [m]
ACROSS = [10, 20, 40, 80]  # cells from the middle to the wall
RATES = [10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5, 1e-6]  # [1/s]

SCENE = {
    "title": "Grout between plates or in a pipe, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": WIDTH,
        "height": 0.02,
        "cells": [20, 4],
        "diagonal": "alternating",
    },
    "material": {
        "grout": {
            "law": "herschel_bulkley",
            "yield_stress": 4.0,
            "consistency": VISCOSITY,
            "exponent": 1.0,
            "regularisation": 0.01,
            "bulk_modulus": 1e6,
            "density": 1000.0,
        }
    },
    "stage": [
        {
            "name": "flow",
            "duration": 1e-6,
            "step": 1e-6,
            "gravity": [0.0, FORCE / 1000],
            "boundary": {
                "right": {"fixed": True},
                "left": {"roller": True},
                "bottom": {"displacement_x": 0.0},
                "top": {"displacement_x": 0.0},
            },
        }
    ],
    "solver": {"max_iterations": 50, "lag_jacobian": 1},
}


def stress(flow, x):
    """Shear stress at distance x from the middle, by balance alone [Pa]."""
    return FORCE * x / (1 if flow == "channel" else 2)


def discharge(flow, x, v):
    """Over the whole section; v is linear between the x."""
    if flow == "channel":
        return 2 * np.trapezoid(v, x)
    # r v, with both linear: Simpson's rule is exact
    middle = (x[1:] + x[:-1]) * (v[1:] + v[:-1])
    parts = (x[:-1] * v[:-1] + middle + x[1:] * v[1:]) / 6
    return 2 * np.pi * np.sum(np.diff(x) * parts)


def exact(flow):
    """Velocity of the plug and discharge (Bingham; Buckingham and Reiner)."""
    wall, t = stress(flow, WIDTH), PLUG / WIDTH
    slope = wall / WIDTH / VISCOSITY
    plug = slope * (WIDTH - PLUG) ** 2 / 2
    if flow == "channel":
        shape = 1 - 1.5 * t + 0.5 * t**3
        return plug, 2 * FORCE * WIDTH**3 / (3 * VISCOSITY) * shape
    shape = 1 - 4 / 3 * t + t**4 / 3
    return plug, np.pi * FORCE * WIDTH**4 / (8 * VISCOSITY) * shape


# Shear stress of a substitute by the rate; all have the largest viscosity
# yield stress / rate_0, and the third a little more.
SUBSTITUTES = {
    "two lines": lambda g, y, e: np.where(
        g > e, y + VISCOSITY * g, (y / e + VISCOSITY) * g
    ),
    "Papanastasiou": lambda g, y, e: -y * np.expm1(-g / e) + VISCOSITY * g,
    "Bercovier and Engelman": lambda g, y, e: (
        y * g / np.sqrt(g * g + e * e) + VISCOSITY * g
    ),
}


def without_mesh(flow, substitute, rate_0):
    """Plug velocity and discharge of a substitute, by quadrature."""
    x = np.linspace(0, WIDTH, 20001)
    tau = stress(flow, x)
    low, high = np.zeros_like(x), np.full_like(x, 100.0)
    for _ in range(100):  # the rate that goes with the stress
        middle = 0.5 * (low + high)
        above = SUBSTITUTES[substitute](middle, YIELD[flow], rate_0) > tau
        high, low = np.where(above, middle, high), np.where(above, low, middle)
    steps = np.diff(x) * 0.5 * (low[1:] + low[:-1])
    v = np.concatenate([[0], np.cumsum(steps[::-1])])[::-1]
    return v[0], discharge(flow, x, v)


def scene(flow, n, rate):
    changes = {
        "mesh.cells": [n, max(n // 5, 2)],
        "symmetry": "plane_strain" if flow == "channel" else "axisymmetric",
        "material.grout.yield_stress": YIELD[flow],
        "material.grout.regularisation": rate,
    }
    return common.with_keys(SCENE, changes)


def measure(flow, run):
    """Relative errors of discharge, plug velocity and plug width."""
    if run.outcome != "completed":
        return np.nan, np.nan, np.nan
    grid = run.last
    on = np.isclose(grid.points[:, 1], np.min(grid.points[:, 1]), atol=1e-5)
    order = np.argsort(grid.points[on, 0])
    x = grid.points[on, 0][order]
    v = grid.nodal["velocity"][on, 1][order]
    plug, Q = exact(flow)
    # in the flowing part the rate rises in a line from the plug's rim
    middle = grid.points[grid.cells, 0].mean(axis=1)
    rate = grid.cell["shear_rate"]
    flows = rate > 0.2 * rate.max()
    slope, start = np.polyfit(middle[flows], rate[flows], 1)
    return (
        discharge(flow, x, v) / Q - 1,
        v[0] / plug - 1,
        -start / slope / PLUG - 1,
    )


def draw(rows):
    fig, axes = common.figure(3, width=13, height=4.4)
    rates = np.geomspace(1e-4, 10, 41)
    for i, name in enumerate(SUBSTITUTES):
        errors = [
            abs(without_mesh("channel", name, r)[1] / exact("channel")[1] - 1)
            for r in rates
        ]
        axes[0].loglog(
            YIELD["channel"] / rates / VISCOSITY,
            errors,
            color=common.COLOURS[i],
            label=name,
        )
    axes[0].set_xlabel("largest over plastic viscosity")
    axes[0].set_ylabel("error of the channel's discharge, no mesh")
    axes[0].legend(fontsize=8.5)
    for i, n in enumerate(ACROSS):
        for flow, dash in (("channel", "-"), ("pipe", "--")):
            chosen = [r for r in rows if r["flow"] == flow and r["across"] == n]
            look = {
                "color": common.COLOURS[i],
                "marker": common.MARKERS[i],
                "linestyle": dash,
                "label": f"{flow}, {n} cells" if flow == "channel" else None,
            }
            x = [r["regularisation [1/s]"] for r in chosen]
            axes[1].loglog(x, [abs(r["discharge"]) for r in chosen], **look)
            steps = [
                r["newton_iterations"] if r["outcome"] == "completed" else np.nan
                for r in chosen
            ]
            axes[2].semilogx(x, steps, **look)
    axes[1].set_xlabel("regularisation [1/s]; at the wall 12 and 6")
    axes[1].set_ylabel("error of the discharge (dashed: pipe)")
    axes[1].legend(fontsize=8.5)
    axes[2].set_xlabel("regularisation [1/s]")
    axes[2].set_ylabel("Newton iterations from rest")
    axes[2].set_ylim(0)
    common.save(fig, HERE)


def main():
    cases = {(f, n, r): scene(f, n, r) for f in YIELD for n in ACROSS for r in RATES}
    runs = common.run_all(cases, fields=True)
    rows = []
    for (flow, n, rate), run in runs.items():
        Q, plug, width = measure(flow, run)
        rows.append(
            {
                "flow": flow,
                "across": n,
                "regularisation [1/s]": rate,
                "discharge": float(Q),
                "plug velocity": float(plug),
                "plug width": float(width),
                "without mesh": float(
                    without_mesh(flow, "two lines", rate)[1] / exact(flow)[1] - 1
                ),
                "newton_iterations": run.summary["newton_iterations"],
                "seconds": run.seconds,
                "outcome": run.outcome.split(":")[0],
            }
        )
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
