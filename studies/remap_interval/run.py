# SPDX-License-Identifier: LGPL-3.0-or-later
"""How often must one remap, and what share of a run does the remap take?"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

SHALLOW, DEEP = 0.05, 0.25  # z/B
STEP = 0.001
COARSE = (0.1, 0.025)  # demos/piercing at refine = 1: edge in the bulk, at the corner
MIDDLE, FINE = (0.05, 0.0125), (0.025, 0.00625)
EVERY = [1, 2, 5, 10, 20]
QUALITY = [0.2, 0.3, 0.5, 0.7]
# Beside limited_linear. The stress stays in a ball with smooth_extrema, in the
# hull of its neighbours with the others.
TRANSPORTS = ["donor_cell", "smooth_extrema", "barth_jespersen"]
PARTS = {  # of a run, by the solver's timers
    "Lagrangian step": "1 lagrangian",
    "smoothing": "2 smooth",
    "transport": "3 transport",
}


def scene(mesh=COARSE, depth=DEEP, every=1, quality=0.0, **keys):
    """The piercing; keys are those of the remap."""
    changes = {
        "mesh.size": mesh[0],
        "mesh.grading.size": mesh[1],
        "stage.0.duration": depth,
        "stage.0.step": STEP,
        # a run that needs smaller steps than this is over
        "stage.0.step_min": STEP / 64,
        "remap.every": every,
        "remap.quality_below": quality,
    }
    changes |= {f"remap.{key}": value for key, value in keys.items()}
    return common.with_keys(common.PIERCING, changes)


def cases():
    """Name -> scene, in groups; the name's first part is the group."""
    out = {("rhythm", f"every {n}"): scene(every=n) for n in EVERY}
    out["rhythm", "never"] = scene(every=0, mode="lagrangian")
    for q in QUALITY:
        out["quality", f"below {q}"] = scene(every=0, quality=q)
    for n in (5, 20):
        for q in (0.3, 0.7):
            out["both", f"every {n}, below {q}"] = scene(every=n, quality=q)
    for q in (0.3, 0.7):
        out["threshold", f"every 1, below {q}"] = scene(quality=q)
    for name in TRANSPORTS:
        out["transport", f"every 1, {name}"] = scene(transport=name)
    out["2100 cells", "every 1"] = scene(MIDDLE)
    out["2100 cells", "every 1, donor_cell"] = scene(MIDDLE, transport="donor_cell")
    out["2100 cells", "every 5"] = scene(MIDDLE, every=5)
    out["2100 cells", "below 0.5"] = scene(MIDDLE, every=0, quality=0.5)
    out["2100 cells", "every 5, below 0.5"] = scene(MIDDLE, every=5, quality=0.5)
    out["6500 cells", "every 1, to 0.05"] = scene(FINE, SHALLOW)
    return out


def share(run, part):
    """Part of the wall time that a timer saw [%]."""
    for timer in run.summary["timers"]:
        if timer["name"] == PARTS[part]:
            return 100 * timer["seconds"] / run.summary["wall_seconds"]
    return 0.0


def ripple(run):
    """Standard deviation of p/sigma_y about its line, z/B 0.2 to 0.25 [%]."""
    z, p = run.curves["z_B"], run.curves["p_sy"]
    late = z > 0.2
    if run.reached < DEEP - 1e-9:
        return np.nan
    return 100 * np.std(p[late] - np.polyval(np.polyfit(z[late], p[late], 1), z[late]))


def row(group, name, run):
    s = run.summary
    quality = run.curves.get("quality", [np.nan])  # recorded where it remaps
    return {
        "group": group,
        "remap": name,
        "cells": s["cells"],
        "remaps": s["remaps"],
        "steps": s["steps"],
        "rejected_steps": s["rejected_steps"],
        "newton_iterations": s["newton_iterations"],
        "excess at 0.05 [%]": run.excess(SHALLOW),
        "excess at 0.25 [%]": run.excess(DEEP),
        "ripple 0.2-0.25 [%]": ripple(run),
        "reached z/B": run.reached,
        "worst quality": float(min(quality)),
        "seconds": run.seconds,
        "wall_seconds": s["wall_seconds"],
        "lagrangian [%]": share(run, "Lagrangian step"),
        "smooth [%]": share(run, "smoothing"),
        "transport [%]": share(run, "transport"),
        "smooth + transport [%]": share(run, "smoothing") + share(run, "transport"),
        "outcome": run.outcome.split(":")[0],
    }


def draw(runs):
    fig, (left, right) = common.figure(2, width=11.4, height=6.4, sharey=True)
    names = list(runs)
    places = -np.arange(len(names), dtype=float)
    for i, (depth, marker) in enumerate(((SHALLOW, "o"), (DEEP, "s"))):
        left.plot(
            [runs[n].excess(depth) for n in names],
            places,
            marker,
            color=common.COLOURS[i],
            linestyle="",
            label=f"at $z/B = {depth}$",
        )
    for n, y in zip(names, places):
        end = SHALLOW if "to 0.05" in n[1] else DEEP
        if runs[n].reached < end - 1e-9:
            left.annotate(
                f"stops at {runs[n].reached:.3f}",
                (0.985, y),
                xycoords=("axes fraction", "data"),
                ha="right",
                va="center",
                fontsize=8.5,
                color="#b00020",
            )
    left.set_xlim(left=0)
    left.set_yticks(places, [f"{n}: {m}" if "cells" in n else m for n, m in names])
    left.set_xlabel(r"excess of $p/\sigma_y$ over $(2+\pi)/\sqrt{3}$ [%]")
    left.legend(fontsize=8.5, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=2)
    begin = np.zeros(len(names))
    for i, part in enumerate(PARTS):
        width = np.array([share(runs[n], part) for n in names])
        right.barh(places, width, 0.7, begin, color=common.COLOURS[i + 2], label=part)
        begin += width
    right.barh(places, 100 - begin, 0.7, begin, color="#cccccc", label="output, start")
    for n, y in zip(names, places):
        right.text(102, y, f"{runs[n].seconds:.1f} s", va="center", fontsize=8.5)
    right.set_xlim(0, 114)
    right.set_xticks(range(0, 101, 20))
    right.set_xlabel("share of the time [%]; at the bar: processor seconds")
    right.legend(fontsize=8.5, loc="lower center", bbox_to_anchor=(0.45, 1), ncols=4)
    for ax in (left, right):
        for i in range(1, len(names)):
            if names[i][0] != names[i - 1][0]:
                ax.axhline(places[i] + 0.5, color="#888888", linewidth=0.6)
    common.save(fig, HERE)


def main():
    runs = common.run_all(cases())
    common.write_table(HERE, [row(*name, run) for name, run in runs.items()])
    draw(runs)


if __name__ == "__main__":
    main()
