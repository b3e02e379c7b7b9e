# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which time integration is exact for its time; what energy does a remap lose?"""

import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

INTEGRATIONS = {
    "Newmark": {"beta": 0.25, "gamma": 0.5},
    "HHT -0.05": {"alpha": -0.05},
    "HHT -0.1": {"alpha": -0.1},
    "HHT -0.3": {"alpha": -0.3},
    "explicit": {"beta": 0.0, "gamma": 0.5},
}
PER_PERIOD = [20, 40, 80, 160, 320, 640]
OSCILLATOR = [5, 10, 20, 40, 80, 160]  # steps per period too
RESOLUTION = 2e-3  # of the loss of amplitude, from what Newmark seems to lose [%]
PERIODS = 5
PERIOD = 0.4  # 4 H / c [s]

SCHEMES = ["donor_cell", "linear", "limited_linear"]
STRAINS = [1e-4, 1e-3, 1e-2]  # of the column, at the start
SWING_STEPS = 160  # steps per period
BAR_MICROSECONDS = 40

# A column under its own weight that is let go: H = 10 m, c = 100 m/s. The weight
# of 2e-4 g gives a mean strain of 1e-6 and a head that moves by 1e-5 m.
WEIGHT = 2e-3  # [m/s^2]
HANGING = {
    "title": "Column let go, for a study",
    "symmetry": "plane_strain",
    "mesh": {
        "shape": "rectangle",
        "width": 1.0,
        "height": 10.0,
        "cells": [2, 20],
        "diagonal": "alternating",
    },
    "material": {
        "soil": {"law": "elastic", "E": 5e7 / 3, "nu": 0.25, "density": 2000.0}
    },
    "stage": [
        {
            "name": "press",
            "duration": 1.0,
            "step": 1.0,
            "gravity": [0.0, -WEIGHT],
            "boundary": {
                "bottom": {"fixed": True},
                "left": {"roller": True},
                "right": {"roller": True},
            },
        },
        {
            "name": "swing",
            "duration": PERIODS * PERIOD,
            "step": 0.0025,
            "dynamics": {},
            "boundary": {
                "bottom": {"fixed": True},
                "left": {"roller": True},
                "right": {"roller": True},
            },
        },
    ],
    "solver": {"element": "mini", "tolerance": 1e-10},
    "output": {
        "curve": {
            "head": {
                "quantity": "displacement_y",
                "boundary": "top",
                # rho g H^2 / (2 M), M = 20 MPa
                "divide_by": 2000.0 * WEIGHT * 100.0 / 4e7,
            },
            "energy": {"quantity": "total_energy"},
            "kinetic": {"quantity": "kinetic_energy"},
        }
    },
}


def column(name, steps):
    return common.with_keys(
        HANGING,
        {"stage.1.dynamics": INTEGRATIONS[name], "stage.1.step": PERIOD / steps},
    )


def oscillator(name, steps):
    """One layer of cells: only the head moves, in one mode."""
    return common.with_keys(
        column(name, steps), {"mesh.cells": [2, 1], "solver.tolerance": 1e-12}
    )


def remapped(strain, scheme):
    """A column of this mean strain that swings, remapped onto its mesh each step."""
    weight = WEIGHT * strain / 1e-6  # mean strain rho g H / (2 M)
    out = common.with_keys(
        column("Newmark", SWING_STEPS), {"stage.0.gravity": [0.0, -weight]}
    )
    if scheme != "none":
        out["remap"] = {"mode": "eulerian", "every": 1, "transport": scheme}
    return out


def bar(scheme):
    """The demo's Taylor bar on its coarsest mesh, up to half its way."""
    with open(common.ROOT / "demos" / "taylor_bar" / "scene.toml", "rb") as stream:
        scene = tomllib.load(stream)
    for picture in ("chart", "picture"):
        scene["output"].pop(picture)
    scene["mesh"]["refine"] = 1
    scene["stage"][0]["duration"] = BAR_MICROSECONDS * 1e-6
    if scheme != "none":
        scene["remap"]["transport"] = scheme
    else:
        scene.pop("remap")
    return scene


def swing(run):
    """Time since the release and the curves from there on."""
    t = run.curves["time"]
    free = t > 1 - 1e-9
    return t[free] - 1, run.curves["head"][free], run.curves["energy"][free]


def exact_head(t):
    """D'Alembert: half parabolas, -1 at the release."""
    turn = (t / PERIOD * 4) % 4
    turn = np.minimum(turn, 4 - turn)
    return np.where(turn < 1, turn**2 - 1, 1 - (2 - turn) ** 2)


def root(t, head):
    """Angle and modulus per step of what a single mode does.

    head[k+1] = 2 m cos(a) head[k] - m^2 head[k-1], by least squares; the first
    steps are left out, HHT has a third root that dies within them.
    """
    skip = len(head) // PERIODS
    own = head[skip:]
    both = np.stack([own[1:-1], -own[:-2]], axis=1)
    one, two = np.linalg.lstsq(both, own[2:], rcond=None)[0]
    return np.arccos(one / 2 / np.sqrt(two)), np.sqrt(two)


def row(part, case, steps, run, **measured):
    names = {
        "period": "period error [%]",
        "amplitude": "amplitude lost per period [%]",
        "head": "RMS error of the head [%]",
        "energy": "energy lost [%]",
    }
    return {
        "part": part,
        "case": case,
        "steps per period": steps,
        **{names[k]: float(measured.get(k, np.nan)) for k in names},
        "seconds": run.seconds,
        "outcome": run.outcome.split(":")[0],
    }


def integration_rows(oscillators, columns):
    found = {}
    for (name, steps), run in oscillators.items():
        if run.outcome == "completed":
            t, head, _ = swing(run)
            angle, modulus = root(t, head)
            T = 2 * np.pi / angle * PERIOD / steps
            found[name, steps] = T, 1 - modulus ** (2 * np.pi / angle)
    # the period without error in time, Richardson
    fine = [found["Newmark", n][0] for n in OSCILLATOR[-2:]]
    limit = (4 * fine[1] - fine[0]) / 3
    print(f"period of the oscillator {limit:.6f} s")
    rows = []
    for key, run in oscillators.items():
        T, lost = found.get(key, (np.nan, np.nan))
        error = 100 * (T / limit - 1)
        rows.append(row("oscillator", *key, run, period=error, amplitude=100 * lost))
    for key, run in columns.items():
        error = np.nan
        if run.outcome == "completed":
            t, head, _ = swing(run)
            error = 100 * np.sqrt(np.mean((head - exact_head(t)) ** 2))
        rows.append(row("column", *key, run, head=error))
    return rows, limit


def loss_rows(columns, bars):
    rows = []
    for (strain, scheme), run in columns.items():
        # per period, of the energy that the released column has: what is kinetic
        # a quarter period later
        t, _, energy = swing(run)
        loss = (energy[0] - energy[-1]) / run.curves["kinetic"].max()
        loss *= 100 * PERIOD / t[-1]
        rows.append(row(f"strain {strain:g}", scheme, SWING_STEPS, run, energy=loss))
    for scheme, run in bars.items():
        total = run.curves["total"]
        loss = 100 * (1 - total[-1] / total[1])
        rows.append(row("bar", scheme, "", run, energy=loss))
    return rows


def draw(rows, limit):
    fig, axes = common.figure(2, rows=2, width=10, height=7.6)
    for i, name in enumerate(INTEGRATIONS):
        look = {"color": common.COLOURS[i], "marker": common.MARKERS[i]}

        def chosen(part):
            wanted = (part, name, "completed")
            return [r for r in rows if (r["part"], r["case"], r["outcome"]) == wanted]

        own = chosen("oscillator")
        x = [r["steps per period"] * limit / PERIOD for r in own]
        axes[0, 0].plot(x, [abs(r["period error [%]"]) for r in own], **look)
        lost = np.array([r["amplitude lost per period [%]"] for r in own])
        lost[lost < RESOLUTION] = np.nan
        axes[0, 1].plot(x, lost, label=name, **look)
        own = chosen("column")
        axes[1, 0].plot(
            [r["seconds"] for r in own],
            [r["RMS error of the head [%]"] for r in own],
            **look,
        )
    x = np.array([5.0, 160.0])
    theory = 100 * (2 * np.pi / x) ** 2
    black = {"color": "black", "linewidth": 1, "zorder": 1}
    over = r"$(\omega\Delta t)^2/"
    axes[0, 0].plot(x, theory / 12, label=over + "12$", dashes=(6, 3), **black)
    axes[0, 0].plot(x, theory / 24, label=over + "24$", dashes=(1, 2), **black)
    axes[0, 0].legend(fontsize=8.5)
    axes[0, 1].legend(fontsize=8.5)
    for ax in (axes[0, 0], axes[0, 1], axes[1, 0]):
        ax.set_xscale("log")
        ax.set_yscale("log")
    axes[1, 0].set_xticks([0.2, 0.4, 0.6, 1], ["0.2", "0.4", "0.6", "1"])
    axes[1, 0].minorticks_off()
    for ax in axes[0]:
        ax.set_xticks(OSCILLATOR, [str(n) for n in OSCILLATOR])
        ax.minorticks_off()
        ax.set_xlabel("steps per period")
    axes[0, 0].set_ylabel("error of the period, its magnitude [%]")
    axes[0, 1].set_ylabel("amplitude lost per period [%]")
    axes[1, 0].set_xlabel("seconds, five periods")
    axes[1, 0].set_ylabel("RMS error of the head over its amplitude [%]")
    groups = [f"strain {s:g}" for s in STRAINS] + ["bar"]
    ax = axes[1, 1]
    for i, scheme in enumerate(["none"] + SCHEMES):
        y = [
            next(
                r["energy lost [%]"]
                for r in rows
                if (r["part"], r["case"]) == (group, scheme)
            )
            for group in groups
        ]
        ax.bar(
            np.arange(len(groups)) + 0.2 * (i - 1.5),
            np.maximum(y, 1e-5),
            0.2,
            color=(["#999999"] + list(common.COLOURS))[i],
            label=scheme.replace("_", " "),
        )
    ax.set_yscale("log")
    ax.set_ylim(1e-5, None)
    labels = [f"column,\nstrain {s:g}" for s in STRAINS] + ["Taylor bar,\nin all"]
    ax.set_xticks(range(len(groups)), labels)
    ax.set_ylabel("energy lost, column per period [%]")
    ax.legend(fontsize=8.5, loc="upper left")
    common.save(fig, HERE)


def main():
    integrations = {(i, n): column(i, n) for i in INTEGRATIONS for n in PER_PERIOD}
    columns = {(e, s): remapped(e, s) for e in STRAINS for s in ["none"] + SCHEMES}
    bars = {s: bar(s) for s in ["none"] + SCHEMES}
    oscillators = {(i, n): oscillator(i, n) for i in INTEGRATIONS for n in OSCILLATOR}
    rows, limit = integration_rows(
        common.run_all(oscillators), common.run_all(integrations, repeats=3)
    )
    rows += loss_rows(common.run_all(columns), common.run_all(bars))
    common.write_table(HERE, rows)
    draw(rows, limit)


if __name__ == "__main__":
    main()
