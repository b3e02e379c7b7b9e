# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which transport scheme buys the most for a second? A pulse carried around.

With --draw the chart is drawn anew from results.csv.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

SCHEMES = [
    "donor_cell",
    "limited_linear",
    "linear",
    "smooth_extrema",
    "barth_jespersen",
    "venkatakrishnan",
    "van_leer",
    "minmod",
]
MAIN = SCHEMES[:3]  # whose meshes are named in the chart
SQUARES = [17, 25, 35, 70, 140]  # along a side
HEIGHT = 100.0  # of the pulse
COLOURS = [*common.COLOURS, "#888888"]

PULSE = {
    "title": "Rotating pulse, for a study",
    "mesh": {
        "shape": "rectangle",
        "width": 1.0,
        "height": 1.0,
        "cells": [35, 35],
        "diagonal": "alternating",
    },
    "tracer": {
        "pulse": {
            "shape": "circle",
            "centre": [0.5, 0.75],
            "radius": 0.15,
            "inside": HEIGHT,
            "outside": 0.0,
        }
    },
    "motion": {"centre": [0.5, 0.5], "revolutions": -1.0},
    "stage": [{"name": "turn", "duration": 720.0, "step": 1.0}],
    "remap": {
        "mode": "eulerian",
        "every": 1,
        "transport": "donor_cell",
        "max_loss": 0.5,
        "open": ["left", "right", "bottom", "top"],
    },
    "output": {
        "curve": {
            "peak": {"quantity": "tracer_max", "tracer": "pulse"},
            "lowest": {"quantity": "tracer_min", "tracer": "pulse"},
            "total": {"quantity": "tracer_total", "tracer": "pulse"},
        }
    },
}


def scene(scheme, n):
    changes = {"mesh.cells": [n, n], "remap.transport": scheme}
    return common.with_keys(PULSE, changes)


def error(run):
    """L1 norm of what one turn has changed, over that of the pulse [-]."""
    x, cells = run.first.points, run.first.cells
    a, b, c = (x[cells[:, i]] for i in range(3))
    u, v = (b - a).T, (c - a).T
    area = 0.5 * np.abs(u[0] * v[1] - u[1] * v[0])
    was, now = run.first.cell["pulse"], run.last.cell["pulse"]
    return float(np.sum(area * np.abs(now - was)) / np.sum(area * was))


def overshoot(run):
    """Farthest outside [0, HEIGHT] at any time, over HEIGHT [-]."""
    high, low = run.curves["peak"].max() - HEIGHT, -run.curves["lowest"].min()
    return float(max(high, low, 0) / HEIGHT)


def draw(rows):
    """The chart from the table, as text or as numbers."""
    table = {(r["scheme"], int(r["squares along a side"])): r for r in rows}

    def column(scheme, name, scale=1.0):
        return [float(table[scheme, n][name]) / scale for n in SQUARES]

    fig, (left, middle, right) = common.figure(3, width=12, height=4.8)
    for i, scheme in enumerate(SCHEMES):
        look = {
            "color": COLOURS[i],
            "marker": common.MARKERS[i],
            "label": scheme.replace("_", " "),
        }
        seconds, errors = column(scheme, "seconds"), column(scheme, "L1 error")
        peaks = column(scheme, "peak", HEIGHT)
        left.plot(seconds, errors, **look)
        middle.plot(seconds, peaks, **look)
        right.plot(
            SQUARES, [max(v, 1e-17) for v in column(scheme, "overshoot")], **look
        )
        for ax, values in ((left, errors), (middle, peaks)):
            for n, x, y in zip(SQUARES, seconds, values if scheme in MAIN else []):
                ax.annotate(
                    f"{n}²",
                    (x, y),
                    (4, 4),
                    textcoords="offset points",
                    fontsize=8,
                    color=COLOURS[i],
                )
    left.set(xscale="log", yscale="log")
    ticks = [0.1, 0.2, 0.3, 0.5, 1.0, 1.5]
    left.set_yticks(ticks, [f"{t:g}" for t in ticks])
    left.minorticks_off()
    left.set_ylabel("L1 error over the pulse's content")
    left.set_title("Error after one turn in 720 steps", fontsize=10)
    middle.set(xscale="log", ylim=(0, 1.25))
    middle.axhline(1, color="black", linewidth=1, dashes=(6, 3))
    middle.plot(
        float(table["donor_cell", 35]["seconds"]),
        0.57,
        "*",
        color="black",
        markersize=11,
        label="the paper's peak, order 1",
        linestyle="",
    )
    lines = middle.get_legend_handles_labels()
    fig.legend(*lines, loc="outside lower center", ncols=5, fontsize=9)
    middle.set_ylabel("peak over the pulse's height")
    middle.set_title("Peak after one turn", fontsize=10)
    for ax in (left, middle):
        ax.set_xlabel("processor time [s]")
    right.set(xscale="log", yscale="log")
    right.set_xticks(SQUARES, [f"{n}²" for n in SQUARES])
    right.minorticks_off()
    right.set_xlabel("squares of the mesh, two triangles each")
    right.set_ylabel("overshoot over the pulse's height")
    right.set_title("Farthest out of bounds at any time", fontsize=10)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        return draw(common.read_table(HERE))
    cases = {(s, n): scene(s, n) for n in SQUARES for s in SCHEMES}
    runs = common.run_all(cases, repeats=2, fields=True)
    rows = []
    for (scheme, n), run in runs.items():
        coarser = runs.get((scheme, n // 2))
        order = np.nan
        if coarser:
            ratio = run.summary["cells"] / coarser.summary["cells"]
            order = float(np.log(error(coarser) / error(run)) / np.log(ratio**0.5))
        total = run.curves["total"]
        rows.append(
            {
                "scheme": scheme,
                "squares along a side": n,
                "cells": run.summary["cells"],
                "seconds": run.seconds,
                "L1 error": error(run),
                "order of it": order,
                "peak": float(run.curves["peak"][-1]),
                "overshoot": overshoot(run),
                "content left": float(total[-1] / total[0]),
            }
        )
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
