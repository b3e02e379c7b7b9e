# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which element locks, and which has a checkerboard? Cook's membrane."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

ELEMENTS = ["mini", "equal_order", "constant_strain"]
NUMBERS = [4, 8, 16, 32]  # squares along a side
# Poisson ratio -> v E / F at (48, 52) of reference.py
EXACT = {0.3: 21.945, 0.49: 18.737, 0.4999: 18.512, 0.499999: 18.509}

COOK = {
    "title": "Cook's membrane, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "quadrilateral",
        "corners": [[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]],
        "cells": [16, 16],
        "diagonal": "left",
    },
    "material": {"membrane": {"law": "elastic", "E": 1e9, "nu": 0.4999}},
    "stage": [
        {
            "name": "load",
            "duration": 1.0,
            "step": 1.0,
            "boundary": {
                "left": {"fixed": True},
                "right": {"traction_y": 0.0625},  # 1 N/m over 16 m
            },
        }
    ],
    "solver": {"element": "mini", "tangent": "consistent"},
    "output": {
        "curve": {
            "v": {
                "quantity": "displacement_y",
                "point": [48.0, 52.0],
                "divide_by": 1e-9,
            }
        }
    },
}
COOK["material"]["membrane"]["density"] = 1000.0


def scene(element, nu, n):
    changes = {
        "mesh.cells": [n, n],
        "material.membrane.nu": nu,
        "solver.element": element,
    }
    return common.with_keys(COOK, changes)


def size(run):
    """RMS of the pressure at the nodes [Pa]."""
    return float(np.sqrt(np.mean(run.last.nodal["pressure"] ** 2)))


def checkerboard(run):
    """RMS of (I - S)^2 p at inner nodes [Pa].

    S is the mean over the neighbours of a node: what changes its sign from node
    to node stays, what is smooth goes with h^2 and faster.
    """
    cells, p = run.last.cells, run.last.nodal["pressure"]
    edges = np.sort(np.concatenate([cells[:, [i, (i + 1) % 3]] for i in range(3)]))
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    inner = np.ones(len(p), dtype=bool)
    inner[edges[uses == 1]] = False
    degree = np.bincount(edges.ravel(), minlength=len(p))

    def rough(x):
        near = np.zeros(len(p))
        np.add.at(near, edges[:, 0], x[edges[:, 1]])
        np.add.at(near, edges[:, 1], x[edges[:, 0]])
        return x - near / degree

    return float(np.sqrt(np.mean(rough(rough(p))[inner] ** 2)))


def draw(runs):
    fig, axes = common.figure(
        len(EXACT), rows=2, width=12, height=6.2, sharex=True, sharey="row"
    )
    for column, (nu, exact) in enumerate(EXACT.items()):
        unit = size(runs["mini", nu, NUMBERS[-1]])
        for i, element in enumerate(ELEMENTS):
            chosen = [runs[element, nu, n] for n in NUMBERS]
            look = {
                "color": common.COLOURS[i],
                "marker": common.MARKERS[i],
                "label": element.replace("_", " "),
            }
            ratio = [r.curves["v"][-1] / exact for r in chosen]
            axes[0, column].plot(NUMBERS, ratio, **look)
            axes[1, column].plot(
                NUMBERS, [checkerboard(r) / unit for r in chosen], **look
            )
        axes[0, column].axhline(1, color="black", linewidth=1, dashes=(6, 3))
        axes[0, column].set_title(rf"$\nu = {nu:g}$", fontsize=10)
        axes[1, column].set_xlabel("squares along a side, $n$")
        axes[1, column].set_xscale("log")
        axes[1, column].set_xticks(NUMBERS, [str(n) for n in NUMBERS])
        axes[1, column].minorticks_off()
        axes[1, column].set_yscale("log")
    axes[0, 0].set_ylim(0, 1.08)
    axes[0, 0].set_ylabel("$v$ at (48, 52) over exact")
    axes[1, 0].set_ylabel("checkerboard over RMS pressure")
    axes[0, 0].legend(fontsize=8.5, loc="lower right")
    common.save(fig, HERE)


def main():
    cases = {
        (e, nu, n): scene(e, nu, n) for nu in EXACT for n in NUMBERS for e in ELEMENTS
    }
    runs = common.run_all(cases, fields=True)
    common.write_table(
        HERE,
        [
            {
                "element": element,
                "nu": nu,
                "n": n,
                "v E / F": float(run.curves["v"][-1]),
                "over exact": float(run.curves["v"][-1] / EXACT[nu]),
                "RMS of p [Pa]": size(run),
                "checkerboard [Pa]": checkerboard(run),
                "newton_iterations": run.summary["newton_iterations"],
                "seconds": run.seconds,
                "outcome": run.outcome.split(":")[0],
            }
            for (element, nu, n), run in runs.items()
        ],
    )
    draw(runs)


if __name__ == "__main__":
    main()
