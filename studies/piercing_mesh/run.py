# SPDX-License-Identifier: LGPL-3.0-or-later
"""What does a per cent of error cost: mesh, transport, how often to remap?"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

Z = 0.05
# edge in the bulk, edge at the corner [B]
UNIFORM = [(0.1, 0.1), (0.05, 0.05), (0.025, 0.025)]
GRADED = [(0.1, 0.025), (0.05, 0.0125), (0.025, 0.00625)]
MIDDLE = GRADED[1]
TRANSPORTS = ["limited_linear", "donor_cell"]
RHYTHMS = {
    "every 2nd step": {"remap.every": 2},
    "every 5th step": {"remap.every": 5},
    "on quality < 0.2": {"remap.every": 0, "remap.quality_below": 0.2},
    "never": {"remap.mode": "lagrangian", "remap.every": 0},
}
DEEP = {  # to z/B = 0.25 on the middle graded mesh
    "every step": {},
    "on quality < 0.2": RHYTHMS["on quality < 0.2"],
    "never": RHYTHMS["never"],
}
# CalculiX 2.20, finite-strain J2 slab of bricks, smooth punch: elements of the
# whole half model, error [%] at z/B = 0.05, processor time [s] to the depth at
# which the run stopped.
PEERS = [
    ("C3D20R", 150, 8.9, 24.6, "0.50"),
    ("C3D20R", 600, 5.4, 134, "0.33"),
    ("C3D8R", 600, 7.2, 4.3, "0.16"),
    ("C3D8R", 2400, 6.3, 42, "0.09"),
    ("C3D8I", 600, 2.7, 27, "0.06"),
    ("C3D8", 600, 14.9, 21, "0.44"),
]


def scene(mesh, keys=None, duration=Z):
    size, corner = mesh
    grading = {"towards": [0.5, 1.5], "size": corner, "growth": 1.15}
    changes = {
        "mesh.size": size,
        "mesh.grading": None if size == corner else grading,
        "stage.0.duration": duration,
        # a run that needs smaller steps than this is over
        "stage.0.step_min": 0.001 / 64,
    }
    return common.with_keys(common.PIERCING, changes | (keys or {}))


def cases():
    out = {}
    for family, meshes in (("uniform", UNIFORM), ("graded", GRADED)):
        for mesh in meshes:
            for transport in TRANSPORTS:
                keys = {"remap.transport": transport}
                out[family, mesh, transport, "every step"] = scene(mesh, keys)
    for rhythm, keys in RHYTHMS.items():
        out["graded", MIDDLE, TRANSPORTS[0], rhythm] = scene(MIDDLE, keys)
    return out


def draw(runs, deep):
    fig, (left, right) = common.figure(2, width=11.4, height=5.2)
    looks = {
        ("uniform", "limited_linear"): (0, "o", "-"),
        ("uniform", "donor_cell"): (0, "o", ":"),
        ("graded", "limited_linear"): (1, "s", "-"),
        ("graded", "donor_cell"): (1, "s", ":"),
    }
    for (family, transport), (colour, marker, line) in looks.items():
        chosen = [
            r
            for (f, _, t, rhythm), r in runs.items()
            if (f, t, rhythm) == (family, transport, "every step")
        ]
        left.plot(
            [r.seconds for r in chosen],
            [r.excess(Z) for r in chosen],
            marker=marker,
            linestyle=line,
            color=common.COLOURS[colour],
            markerfacecolor="white" if line == ":" else None,
            label=f"{family}, {transport.replace('_', ' ')}",
        )
        if line == "-":
            for run in chosen:
                left.annotate(
                    f"{run.summary['cells']}",
                    (run.seconds, run.excess(Z)),
                    (5, 4),
                    textcoords="offset points",
                    fontsize=8,
                    color=common.COLOURS[colour],
                )
    for i, rhythm in enumerate(RHYTHMS):
        run = runs["graded", MIDDLE, TRANSPORTS[0], rhythm]
        if run.reached < Z - 1e-9:
            continue
        left.plot(
            run.seconds,
            run.excess(Z),
            common.MARKERS[3 + i],
            color=common.COLOURS[2],
            linestyle="",
            label=f"graded, {MIDDLE[1]}: remap {rhythm}",
        )
    for i, (element, number, error, seconds, stop) in enumerate(PEERS):
        left.plot(
            seconds,
            error,
            "x",
            color="#555555",
            label="CalculiX, whole run (elements; stops)" if i == 0 else None,
        )
        left.annotate(
            f"{element} {number}; {stop}",
            (seconds, error),
            (0, 6),
            textcoords="offset points",
            ha="center",
            fontsize=7.5,
            color="#555555",
        )
    left.set(xscale="log", yscale="log")
    ticks = [0.5, 1, 1.5, 2, 3, 5, 7, 10, 15]
    left.set_yticks(ticks, [f"{t:g}" for t in ticks])
    left.minorticks_off()
    left.set_xlabel("processor time [s], ours to $z/B = 0.05$")
    left.set_ylabel(r"excess of $p/\sigma_y$ over $(2+\pi)/\sqrt{3}$ [%]")
    left.set_title("Error at $z/B = 0.05$ (numbers: cells)", fontsize=10)
    left.legend(fontsize=7.5, loc="lower left")
    for i, (name, run) in enumerate(deep.items()):
        colour = common.COLOURS[i]
        right.plot(
            run.curves["z_B"],
            run.curves["p_sy"],
            color=colour,
            label=f"remap {name}: {run.seconds:.0f} s",
        )
        if run.outcome != "completed":
            end = run.reached, run.curves["p_sy"][-1]
            right.plot(*end, "X", color=colour, markersize=9)
            right.annotate(
                f"stops at {run.reached:.3f}",
                end,
                (6, 6),
                textcoords="offset points",
                fontsize=8.5,
                color=colour,
            )
    right.axhline(common.EXACT, color="black", linewidth=1, dashes=(6, 3))
    right.text(0.245, common.EXACT - 0.03, "2.9685", ha="right", va="top", fontsize=8.5)
    right.set_xlim(0, 0.255)
    right.set_ylim(2.4, 3.6)
    right.set_xlabel("penetration $z/B$")
    right.set_ylabel(r"$p/\sigma_y$")
    right.set_title(f"To $z/B = 0.25$, edge {MIDDLE[1]} B at the corner", fontsize=10)
    right.legend(fontsize=8.5, loc="lower right")
    common.save(fig, HERE)


def row(mesh, transport, rhythm, run):
    worst = run.curves.get("quality", run.curves["z_B"] * float("nan"))
    return {
        "edge": mesh[0],
        "edge at corner": mesh[1],
        "transport": transport,
        "remap": rhythm,
        "cells": run.summary["cells"],
        "remaps": run.summary["remaps"],
        "seconds": run.seconds,
        "newton_iterations": run.summary["newton_iterations"],
        "rejected_steps": run.summary["rejected_steps"],
        "excess at 0.05 [%]": run.excess(Z),
        "excess at 0.25 [%]": run.excess(0.25),
        "reached z/B": run.reached,
        "worst quality": float(min(worst)),
        "outcome": run.outcome.split(":")[0],
    }


def main():
    runs = common.run_all(cases())
    deep = common.run_all({name: scene(MIDDLE, k, 0.25) for name, k in DEEP.items()})
    rows = [row(m, t, rhythm, run) for (_, m, t, rhythm), run in runs.items()]
    rows += [row(MIDDLE, TRANSPORTS[0], name, run) for name, run in deep.items()]
    common.write_table(HERE, rows)
    draw(runs, deep)


if __name__ == "__main__":
    main()
