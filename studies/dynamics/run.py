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
PER_PERIOD = [10, 20, 40, 80, 160, 320, 640]
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


def period(t, head):
    """From the first crossing of zero to the last [s]."""
    i = np.flatnonzero(head[:-1] * head[1:] < 0)
    zero = t[i] - head[i] * (t[i + 1] - t[i]) / (head[i + 1] - head[i])
    return 2 * (zero[-1] - zero[0]) / (len(zero) - 1)


def amplitude(t, head, T, first):
    """Of the fundamental over the period that begins at `first` periods."""
    own = (t > (first - 1e-9) * T) & (t < (first + 1 + 1e-9) * T)
    phase = 2 * np.pi * t[own] / T
    waves = [f(k * phase) for k in (1, 3) for f in (np.cos, np.sin)]
    found = np.linalg.lstsq(np.stack(waves, axis=1), head[own], rcond=None)[0]
    return float(np.hypot(found[0], found[1]))


def measures(run):
    t, head, energy = swing(run)
    if run.outcome != "completed":
        return np.nan, np.nan, np.nan
    T = period(t, head)
    kept = amplitude(t, head, T, PERIODS - 2) / amplitude(t, head, T, 0)
    error = np.sqrt(np.mean((head - exact_head(t)) ** 2))
    return T, 100 * (1 - kept ** (1 / (PERIODS - 2))), 100 * float(error)


def integration_rows(runs):
    T = {}
    rows = []
    for (name, steps), run in runs.items():
        T[name, steps], loss, error = measures(run)
        rows.append(
            {
                "part": "integration",
                "case": name,
                "steps per period": steps,
                "period error [%]": np.nan,
                "amplitude lost per period [%]": loss,
                "RMS error of the head [%]": error,
                "energy lost [%]": np.nan,
                "seconds": run.seconds,
                "outcome": run.outcome.split(":")[0],
            }
        )
    # the period of this mesh: the two ends of the same limit, Richardson
    fine = T["Newmark", PER_PERIOD[-1]], T["Newmark", PER_PERIOD[-2]]
    limit = (4 * fine[0] - fine[1]) / 3
    for row in rows:
        found = T[row["case"], row["steps per period"]]
        row["period error [%]"] = 100 * (found / limit - 1)
    print(f"period of the mesh {limit:.6f} s")
    return rows


def loss_rows(columns, bars):
    rows = []

    def add(part, case, loss, run):
        rows.append(
            {
                "part": part,
                "case": case,
                "steps per period": SWING_STEPS if part != "bar" else "",
                "period error [%]": np.nan,
                "amplitude lost per period [%]": np.nan,
                "RMS error of the head [%]": np.nan,
                "energy lost [%]": loss,
                "seconds": run.seconds,
                "outcome": run.outcome.split(":")[0],
            }
        )

    for (strain, scheme), run in columns.items():
        # per period, of the energy that the released column has: its work of
        # the stress at the start is the kinetic energy a quarter period later
        t, _, energy = swing(run)
        kinetic = run.curves["kinetic"].max()
        loss = 100 * (energy[0] - energy[-1]) / kinetic / (t[-1] / PERIOD)
        add(f"column {strain:g}", scheme, float(loss), run)
    for scheme, run in bars.items():
        total = run.curves["total"]
        add("bar", scheme, float(100 * (1 - total[-1] / total[1])), run)
    return rows


def draw(rows):
    fig, axes = common.figure(2, rows=2, width=10, height=7.6)
    for i, name in enumerate(INTEGRATIONS):
        look = {"color": common.COLOURS[i], "marker": common.MARKERS[i]}
        own = [
            r
            for r in rows
            if (r["part"], r["case"], r["outcome"])
            == ("integration", name, "completed")
        ]
        x = [r["steps per period"] for r in own]
        axes[0, 0].plot(x, [abs(r["period error [%]"]) for r in own], **look)
        lost = [max(r["amplitude lost per period [%]"], 1e-5) for r in own]
        axes[0, 1].plot(x, lost, label=name, **look)
        axes[1, 0].plot(
            [r["seconds"] for r in own],
            [r["RMS error of the head [%]"] for r in own],
            **look,
        )
    x = np.array(PER_PERIOD)
    theory = 100 * (2 * np.pi / x) ** 2
    black = {"color": "black", "linewidth": 1, "dashes": (6, 3)}
    axes[0, 0].plot(x, theory / 12, label=r"$(\omega\Delta t)^2/12$", **black)
    black["dashes"] = (1, 2)
    axes[0, 0].plot(x, theory / 24, label=r"$(\omega\Delta t)^2/24$", **black)
    axes[0, 0].legend(fontsize=8.5)
    axes[0, 1].legend(fontsize=8.5)
    for ax in (axes[0, 0], axes[0, 1], axes[1, 0]):
        ax.set_xscale("log")
        ax.set_yscale("log")
    for ax in axes[0]:
        ax.set_xticks(PER_PERIOD, [str(n) for n in PER_PERIOD])
        ax.minorticks_off()
        ax.set_xlabel("steps per period")
    axes[0, 0].set_ylabel("error of the period, its magnitude [%]")
    axes[0, 1].set_ylabel("amplitude lost per period [%]")
    axes[1, 0].set_xlabel("seconds, five periods")
    axes[1, 0].set_ylabel("RMS error of the head over its amplitude [%]")
    groups = [f"column {s:g}" for s in STRAINS] + ["bar"]
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
            np.maximum(y, 1e-4),
            0.2,
            color=(["#999999"] + list(common.COLOURS))[i],
            label=scheme.replace("_", " "),
        )
    ax.set_yscale("log")
    ax.set_ylim(1e-4, None)
    labels = [f"column,\nstrain {s:g}" for s in STRAINS] + ["Taylor bar,\nin all"]
    ax.set_xticks(range(len(groups)), labels)
    ax.set_ylabel("energy lost, column per period [%]")
    ax.legend(fontsize=8.5, loc="upper left")
    common.save(fig, HERE)


def main():
    integrations = {(i, n): column(i, n) for i in INTEGRATIONS for n in PER_PERIOD}
    columns = {(e, s): remapped(e, s) for e in STRAINS for s in ["none"] + SCHEMES}
    bars = {s: bar(s) for s in ["none"] + SCHEMES}
    rows = integration_rows(common.run_all(integrations))
    rows += loss_rows(common.run_all(columns), common.run_all(bars))
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
