# SPDX-License-Identifier: LGPL-3.0-or-later
"""Mean or quadrature: error against time, and at the axis."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402
from locking.run import COOK  # noqa: E402

LAYOUTS = {
    "mean": {"solver.layout": "mean"},
    "quadrature 3": {"solver.layout": "quadrature", "solver.points": 3},
    "quadrature 6": {"solver.layout": "quadrature", "solver.points": 6},
}
COOK_EXACT = 18.512  # v E / F at nu = 0.4999, locking/reference.py
COOK_NUMBERS = [4, 8, 16, 32]
RING_NUMBERS = [4, 8, 16, 32, 64]  # cells along the radius
RATIOS = [0.3, 0.4999]  # Poisson
BILLET_NUMBERS = [8, 16]
FINE = 64
REPEATS = 5

E, DENSITY, FORCE = 1e9, 1000.0, 1e-3  # [Pa], [kg/m^3], [m/s^2]

# A solid cylinder of radius 1 in a rigid tube, plane strain along the axis,
# pulled outwards by a constant body force.
PULLED = {
    "title": "Solid cylinder pulled outwards, for a study",
    "symmetry": "axisymmetric",
    "mesh": {
        "shape": "rectangle",
        "width": 1.0,
        "height": 1.0,
        "cells": [4, 4],
        "diagonal": "right",
    },
    "material": {"body": {"law": "elastic", "E": E, "nu": 0.3, "density": DENSITY}},
    "stage": [
        {
            "name": "load",
            "duration": 1.0,
            "step": 1.0,
            "gravity": [FORCE, 0.0],
            "boundary": {
                "left": {"roller": True},
                "right": {"displacement_x": 0.0},
                "top": {"roller": True},
                "bottom": {"roller": True},
            },
        }
    ],
    "solver": {"element": "mini", "tolerance": 1e-10},
}

# A quarter of a billet between rough plates, 2 % shorter, no remap.
BILLET = common.with_keys(
    PULLED,
    {
        "title": "Billet between rough plates, for a study",
        "material.body": {
            "law": "j2",
            "E": E,
            "nu": 0.3,
            "yield_stress": 2e6,
            "hardening": 2e7,
            "density": DENSITY,
        },
        "stage.0.gravity": None,
        "stage.0.step": 0.1,
        "stage.0.boundary": {
            "left": {"roller": True},
            "bottom": {"roller": True},
            "top": {"displacement_x": 0.0, "velocity_y": -0.02},
        },
        "output": {"curve": {"F": {"quantity": "reaction_y", "boundary": "top"}}},
    },
)


def lagrangian_seconds(run):
    return next(
        t["seconds"] for t in run.summary["timers"] if t["name"] == "1 lagrangian"
    )


def volume_means(r):
    """Mean radius of cells by volume, from radii of corners, shape (cells, 3)."""
    squares = (r**2).sum(axis=1) + r.sum(axis=1) ** 2
    return squares / 12 / (r.sum(axis=1) / 3)


def exact_stress(r, nu):
    """Radial, axial, hoop stress of PULLED at radius r, shape (cells, 3) [Pa].

    M (u'' + u'/r - u/r^2) + rho g = 0, u(0) = u(1) = 0, so that
    u = rho g (r - r^2) / (3 M).
    """
    shear = E / 2 / (1 + nu)
    lame = E * nu / (1 + nu) / (1 - 2 * nu)
    unit = DENSITY * FORCE / 3 / (lame + 2 * shear)
    radial, hoop = unit * (1 - 2 * r), unit * (1 - r)
    trace = lame * (radial + hoop)
    return np.stack(
        [trace + 2 * shear * radial, trace, trace + 2 * shear * hoop], axis=1
    )


def rms(values, weights):
    return float(np.sqrt((values**2 * weights[:, None]).sum() / weights.sum()))


def parts(grid):
    """Radii of cells' corners, volumes and which cells touch the axis."""
    r = grid.points[grid.cells, 0]
    z = grid.points[grid.cells, 1]
    area = 0.5 * np.abs(
        (r[:, 1] - r[:, 0]) * (z[:, 2] - z[:, 0])
        - (r[:, 2] - r[:, 0]) * (z[:, 1] - z[:, 0])
    )
    return r, area * r.mean(axis=1), r.min(axis=1) < 1e-12


def normal_stress(grid):
    """Radial, axial, hoop of the cells, shape (cells, 3) [Pa]."""
    return grid.cell["stress"][:, [0, 4, 8]]


def deviator(stress):
    """Of radial, axial, hoop."""
    return stress - stress.mean(axis=1, keepdims=True)


def pulled_errors(run, nu):
    """RMS error of the deviator at the axis and everywhere [% of rho g R].

    Cells' stresses beside the exact one's mean over the cell's volume; a third
    number, at the axis beside the exact one at the centroids.
    """
    r, volume, axis = parts(run.first)
    mean = deviator(exact_stress(volume_means(r), nu))
    centroid = deviator(exact_stress(r.mean(axis=1), nu))
    unit = DENSITY * FORCE / 100
    found = deviator(normal_stress(run.last))
    return (
        rms((found - mean)[axis], volume[axis]) / unit,
        rms(found - mean, volume) / unit,
        rms((found - centroid)[axis], volume[axis]) / unit,
    )


def gathered(fine, grid, n):
    """A fine run's stress, its mean by volume over each cell of a coarse grid."""

    def number(g):
        """Of the coarse cell that a cell's centroid lies in."""
        x = g.points[g.cells].mean(axis=1) * n
        column, row = np.floor(x).astype(int).T
        upper = (x[:, 1] - row > x[:, 0] - column).astype(int)
        return 2 * (row * n + column) + upper

    into, volume = number(fine.first), parts(fine.first)[1]
    sums = np.zeros((2 * n * n, 3))
    np.add.at(sums, into, normal_stress(fine.last) * volume[:, None])
    weights = np.bincount(into, volume, 2 * n * n)
    return (sums / weights[:, None])[number(grid)]


def billet_errors(run, fine, n):
    """Of the stress, at the axis and everywhere, over its RMS; of the force [%].

    Beside a fine mesh, its stress as the mean over each coarse cell.
    """
    _, volume, axis = parts(run.first)
    exact = gathered(fine, run.first, n)
    unit = rms(exact, volume)
    error = normal_stress(run.last) - exact
    force = 100 * (run.curves["F"][-1] / fine.curves["F"][-1] - 1)
    return (
        100 * rms(error[axis], volume[axis]) / unit,
        100 * rms(error, volume) / unit,
        float(force),
    )


def cases():
    out = {}
    for layout, keys in LAYOUTS.items():
        for n in COOK_NUMBERS:
            changes = {"mesh.cells": [n, n], **keys}
            out["cook", 0.4999, layout, n] = common.with_keys(COOK, changes)
        for nu in RATIOS:
            for n in RING_NUMBERS:
                changes = {
                    "mesh.cells": [n, 4],
                    "mesh.height": 4 / n,
                    "material.body.nu": nu,
                    **keys,
                }
                out["pulled", nu, layout, n] = common.with_keys(PULLED, changes)
        for n in BILLET_NUMBERS + [FINE]:
            changes = {"mesh.cells": [n, n], **keys}
            out["billet", 0.3, layout, n] = common.with_keys(BILLET, changes)
    return out


def table(runs):
    rows = []
    for (problem, nu, layout, n), run in runs.items():
        axis = everywhere = end = centroid = np.nan
        if problem == "cook":
            end = 100 * (float(run.curves["v"][-1]) / COOK_EXACT - 1)
        elif problem == "pulled":
            axis, everywhere, centroid = pulled_errors(run, nu)
        else:
            fine = runs["billet", 0.3, "quadrature 6", FINE]
            axis, everywhere, end = billet_errors(run, fine, n)
        rows.append(
            {
                "problem": problem,
                "nu": nu,
                "layout": layout,
                "n": n,
                "error of deflection or force [%]": end,
                "stress error at the axis [%]": axis,
                "beside the centroid's [%]": centroid,
                "stress error everywhere [%]": everywhere,
                "newton_iterations": run.summary["newton_iterations"],
                "lagrangian seconds": lagrangian_seconds(run),
                "outcome": run.outcome.split(":")[0],
            }
        )
    return rows


def draw(rows):
    fig, axes = common.figure(3, width=12, height=4)
    for i, layout in enumerate(LAYOUTS):
        look = {"color": common.COLOURS[i], "marker": common.MARKERS[i]}

        def chosen(problem, nu):
            wanted = (problem, nu, layout)
            return [r for r in rows if (r["problem"], r["nu"], r["layout"]) == wanted]

        cook = chosen("cook", 0.4999)
        axes[0].plot(
            [1e3 * r["lagrangian seconds"] for r in cook],
            [abs(r["error of deflection or force [%]"]) for r in cook],
            label=layout,
            **look,
        )
        for ax, nu in zip(axes[1:], RATIOS):
            pulled = chosen("pulled", nu)
            x = [r["n"] for r in pulled]
            for where, dashes in (("at the axis", ()), ("everywhere", (4, 2))):
                y = [r[f"stress error {where} [%]"] for r in pulled]
                ax.plot(x, y, label=f"{layout}, {where}", dashes=dashes, **look)
            ax.set_title(rf"Cylinder pulled outwards, $\nu = {nu:g}$", fontsize=10)
            ax.set_xlabel("cells along the radius")
            ax.set_ylabel(r"error of the deviator [% of $\rho g R$]")
    for ax in axes:
        ax.set_xscale("log")
        ax.set_yscale("log")
    for ax in axes[1:]:
        ax.set_xticks(RING_NUMBERS, [str(n) for n in RING_NUMBERS])
        ax.minorticks_off()
    axes[0].set_title("Cook's membrane, n = 4, 8, 16, 32", fontsize=10)
    axes[0].set_xlabel("Lagrangian step [ms]")
    axes[0].set_ylabel("error of the deflection [%]")
    axes[0].legend(fontsize=8.5)
    axes[1].legend(fontsize=7.5, handlelength=3.5)
    common.save(fig, HERE)


def main():
    everything = cases()
    runs = {}
    for repeat in range(REPEATS):
        for name, scene in everything.items():
            if repeat and name[0] != "cook":
                continue
            one = common.run(scene, fields=not repeat)
            if name not in runs:
                runs[name] = one
            elif lagrangian_seconds(one) < lagrangian_seconds(runs[name]):
                runs[name].summary = one.summary
    rows = table(runs)
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
