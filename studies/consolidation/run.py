# SPDX-License-Identifier: LGPL-3.0-or-later
"""Consolidation: error against time over steps and meshes, and the limit of no flow."""

import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402
import numpy as np  # noqa: E402

# c_v = k M / gamma_w = 0.01 m2/s but for the water's compressibility
M, K_W = 12e6, 1 / (0.4 / 2.2e9 + 0.6 / 36e9)
K, LOAD = 8.175e-6, 1e3
P_0 = LOAD / M / (1 / M + 1 / K_W)
SIDES = {name: {"roller": True} for name in ("left", "right", "bottom")}

LAYER = {
    "title": "A layer drained at its loaded top, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": 0.25,
        "height": 1.0,
        "cells": [4, 16],
        "diagonal": "alternating",
    },
    "material": {"soil": {"law": "elastic", "E": 1e7, "nu": 0.25, "density": 0}},
    "water": {
        "drainage": "seepage",
        "porosity": 0.4,
        "permeability": K,
        "time_weight": 1.0,
    },
    "stage": [
        {
            "name": "drain",
            "duration": 100.0,
            "step": 1e-3,
            "boundary": SIDES | {"top": {"pressure": LOAD, "drained": True}},
        }
    ],
    "output": {"curve": {"base": {"quantity": "pore_pressure", "boundary": "bottom"}}},
}

CELLS = [8, 16, 32, 64]
STEPS = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25]  # longest; the first ones grow by half
WEIGHTS = [1.0, 0.5]
STORAGES = ["lumped", "consistent"]
NUMBERS = [10.0**i for i in range(-8, 3)]  # c_v dt / h^2 of one step


def c_v(k=K):
    return k / 9810 / (1 / M + 1 / K_W)


def exact(T):
    """Pore pressure at the base over the first one, Terzaghi."""
    return sum(
        4
        / math.pi
        * (-1) ** m
        / (2 * m + 1)
        * math.exp(-(((m + 0.5) * math.pi) ** 2) * T)
        for m in range(60)
    )


def consolidation(cells, step, weight):
    changes = {
        "mesh.cells": [cells // 4, cells],
        "water.time_weight": weight,
    }
    scene = common.with_keys(LAYER, changes)
    scene["stage"][0]["step_max"] = step
    return scene


def short_step(number, storage):
    """One step of c_v dt / h^2 = number on 16 cells; the first nodes watched."""
    scene = common.with_keys(LAYER, {"water.storage": storage})
    dt = 1e-3
    k = number / 16**2 / dt / c_v(1)
    scene["water"]["permeability"] = k
    scene["stage"][0] |= {"duration": dt, "step": dt}
    for i in range(1, 7):
        scene["output"]["curve"][f"node_{i}"] = {
            "quantity": "pore_pressure",
            "point": [0.125, 1 - i / 16],
        }
    return scene


def error(run):
    """RMS over log time from T = 0.01 on."""
    t, p = (np.array(run.curves[name]) for name in ("time", "base"))
    T = c_v() * t[1:]
    keep = T >= 0.01
    e = np.array([q / P_0 - exact(x) for q, x in zip(p[1:][keep], T[keep])])
    weight = np.gradient(np.log(T[keep]))
    return math.sqrt(np.sum(e**2 * weight) / np.sum(weight))


def seconds(run):
    """Of the Lagrangian steps; the start of the program is another matter."""
    timers = {t["name"].strip(): t["seconds"] for t in run.summary["timers"]}
    return timers["1 lagrangian"]


def swing(run):
    """Overshoot, and largest distance from 1, of the first nodes."""
    nodes = [run.curves[f"node_{i}"][-1] / P_0 for i in range(1, 7)]
    return max(max(nodes) - 1, 0), max(abs(p - 1) for p in nodes)


def draw(rows, limits):
    fig, axes = common.figure(2, width=10.2, height=4.2)
    for i, weight in enumerate(WEIGHTS):
        for j, cells in enumerate(CELLS):
            of = [r for r in rows if r["weight"] == weight and r["cells"] == cells]
            axes[0].plot(
                [r["seconds"] for r in of],
                [100 * r["error"] for r in of],
                color=common.COLOURS[j],
                marker=common.MARKERS[i],
                linestyle="-" if weight == 1 else "--",
                label=f"{cells} cells, weight {weight:g}",
            )
    axes[0].set_xscale("log")
    axes[0].set_yscale("log")
    axes[0].set_xlabel("time of the steps [s]")
    axes[0].set_ylabel("error of the pressure at the base [%]")
    axes[0].legend(fontsize=7, ncols=2)
    for i, storage in enumerate(STORAGES):
        of = [r for r in limits if r["storage"] == storage]
        axes[1].plot(
            [r["number"] for r in of],
            [100 * r["off"] for r in of],
            color=common.COLOURS[i],
            marker=common.MARKERS[i],
            label=f"{storage} storage",
        )
    T = np.array([n for n in NUMBERS])
    # one implicit step, exactly: p / p_0 = 1 - exp(-y / sqrt(c_v dt)), first node
    axes[1].plot(
        T, 100 * np.exp(-1 / np.sqrt(T)), color="grey", label="exact, one step"
    )
    axes[1].axvline(1 / 6, color="grey", linewidth=1)
    axes[1].text(0.2, 30, "1/6", color="grey")
    axes[1].set_ylim(0, 100)
    axes[1].set_xscale("log")
    axes[1].set_xlabel("$c_v \\Delta t / h^2$ of the first step")
    axes[1].set_ylabel("pore pressure off $p_0$ at the first nodes [%]")
    axes[1].legend()
    common.save(fig, HERE)


def main():
    cases = {
        (cells, step, weight): consolidation(cells, step, weight)
        for weight in WEIGHTS
        for cells in CELLS
        for step in STEPS
    }
    cases |= {
        (n, storage): short_step(n, storage) for storage in STORAGES for n in NUMBERS
    }
    runs = common.run_all(cases)
    rows, limits = [], []
    for name, run in runs.items():
        if len(name) == 3:
            cells, step, weight = name
            rows.append(
                {
                    "cells": cells,
                    "longest step [s]": step,
                    "weight": weight,
                    "steps": run.summary["steps"],
                    "error": error(run),
                    "seconds": seconds(run),
                }
            )
        else:
            over, off = swing(run)
            limits.append(
                {"number": name[0], "storage": name[1], "overshoot": over, "off": off}
            )
    empty = dict.fromkeys(limits[0], "")
    blank = dict.fromkeys(rows[0], "")
    table = [r | empty for r in rows] + [blank | r for r in limits]
    common.write_table(HERE, table)
    draw(rows, limits)


if __name__ == "__main__":
    main()
