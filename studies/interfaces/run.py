# SPDX-License-Identifier: LGPL-3.0-or-later
"""Interfaces in motion: error against time for every reconstruction, and where
they fail.

With --draw the charts are drawn anew from results.csv; pictures of interfaces
need the program and stay as they are.
"""

import csv
import io
import sys
from pathlib import Path

from matplotlib.collections import PolyCollection

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

SQUARES = [23, 45, 91]  # along a side, two triangles each
COURANT = 0.5
MAIN = "moment_of_fluid"
COLUMNS = [
    "method",
    "squares along a side",
    "cells",
    "number",
    "steps",
    "error",
    "relative",
    "volume drift",
    "spread",
    "bodies at half time",
    "mixed cells",
    "slivers swept",
    "slivers kept",
    "reconstruct s",
    "carry s",
    "move s",
    "outcome",
]
ERRORS = [
    ("vortex", 2, "Vortex, T = 2"),
    ("vortex", 4, "Vortex, T = 4"),
    ("vortex", 8, "Vortex, T = 8"),
    ("zalesak", 1, "Zalesak's disc, one turn"),
]
COURANTS = [0.05, 0.1, 0.2, 0.5, 1.0, 1.5, 2.0]
PERIODS = [1, 2, 3, 4, 6, 8, 10, 12]
PICTURES = [(MAIN, "moment of fluid"), ("lvira", "LVIRA"), ("donor_cell", "donor cell")]
COLOURS = [*common.COLOURS, "#888888", "#444444"]


def program():
    """The cases of this study, built beside the solver."""
    return common.built("interface_cases", "interfaces/program/interface_cases")


def cases(kind, time, words):
    """The rows that the program prints for some words."""
    print(" ".join(map(str, words[1:])), flush=True)
    rows = csv.reader(io.StringIO(common.output(words)))
    return [{"kind": kind, "T": time, **dict(zip(COLUMNS, row))} for row in rows]


def measured(tool, methods):
    rows = []

    def run(kind, case, time, method, n, courant):
        rows.extend(cases(kind, time, [tool, "run", case, time, method, n, courant]))

    for case, time, _ in ERRORS:
        for method in [*methods, "donor_cell"]:
            for n in SQUARES:
                run(case, case, time, method, n, COURANT)
    for time in (2, 4):
        for n in SQUARES:
            run("quarters", "quarters", time, MAIN, n, COURANT)
    for method in methods:
        for courant in COURANTS:
            run("Courant number", "vortex", 2, method, SQUARES[1], courant)
        for time in PERIODS:
            run("period", "vortex", time, method, SQUARES[1], COURANT)
        for kind in ("filament", "fraction", "aspect"):
            rows.extend(cases(kind, 1, [tool, kind, method]))
    return rows


def label(method):
    names = {"lvira": "LVIRA", "one_cut": "moment of fluid, no filaments"}
    return names.get(method, method.replace("_", " "))


def chosen(rows, **wanted):
    return [
        row for row in rows if all(str(row[k]) == str(v) for k, v in wanted.items())
    ]


def seconds(row):
    return sum(float(row[part]) for part in ("reconstruct s", "carry s", "move s"))


def draw(rows):
    methods = list(dict.fromkeys(row["method"] for row in rows))
    look = {
        method: {
            "color": COLOURS[i % len(COLOURS)],
            "marker": common.MARKERS[i],
            "markersize": 4.5,
            "linewidth": 1.2,
            "label": label(method),
        }
        for i, method in enumerate(methods)
    }
    fig, axes = common.figure(3, width=13, height=11.5, rows=3)
    panels = list(axes.flat)
    for ax, (case, time, title) in zip(panels, ERRORS):
        for method in methods:
            some = chosen(rows, kind=case, T=time, method=method)
            x = [seconds(row) for row in some]
            ax.plot(x, [float(row["error"]) for row in some], **look[method])
        ax.set(xscale="log", yscale="log")
        ax.set_title(f"{title}: 23², 45², 91² squares", fontsize=10)
        ax.set_xlabel("processor time of the steps [s]")
        ax.set_ylabel("L1 error")
    borders = [
        ("Courant number", "number", "error", "Vortex, T = 2, 45² squares", None),
        ("period", "T", "error", "Break-up: vortex on 45² squares", None),
        ("filament", "number", "relative", "Ring there and back", "breadth / square"),
        ("fraction", "number", "relative", "Flat layer, one remap", "depth / square"),
        ("aspect", "number", "relative", "Ellipse there and back", "aspect of cells"),
    ]
    for ax, (kind, x, y, title, name) in zip(panels[4:], borders):
        for method in methods:
            some = chosen(rows, kind=kind, method=method)
            if some:
                ax.plot(
                    [float(row[x]) for row in some],
                    [max(float(row[y]), 1e-17) for row in some],
                    **look[method],
                )
        ax.set(yscale="log")
        if kind != "period":
            ax.set(xscale="log")
        ax.set_title(title, fontsize=10)
        ax.set_xlabel(name or {"period": "period T"}.get(kind, kind))
        ax.set_ylabel({"error": "L1 error", "relative": "relative L1 error"}[y])
    lines = panels[0].get_legend_handles_labels()
    fig.legend(*lines, loc="outside lower center", ncols=6, fontsize=9)
    common.save(fig, HERE)


def polygons(text):
    """Half and end: values and polygons."""
    out = {"half": ([], []), "end": ([], [])}
    for line in text.splitlines():
        when, value, *numbers = line.split()
        corners = [float(v) for v in numbers]
        out[when][0].append(float(value))
        out[when][1].append(list(zip(corners[::2], corners[1::2])))
    return out


def picture(tool, name, case, time, n):
    """Interfaces at half time, and at the end."""
    rows = [[case, method, text] for method, text in PICTURES]
    if case == "quarters":
        rows = [[case, MAIN, PICTURES[0][1]]]
    fig, axes = common.figure(
        len(rows), width=4 * max(2, len(rows)), height=8, rows=2, squeeze=False
    )
    blue = common.plt.get_cmap("Blues")
    for j, (_, method, text) in enumerate(rows):
        words = [tool, "draw", case, time, method, n, COURANT]
        for ax, (when, (values, corners)) in zip(
            axes[:, j], polygons(common.output(words)).items()
        ):
            if method == "donor_cell":
                colours = [blue(v) for v in values]
            else:
                colours = [COLOURS[int(v) - 1] for v in values]
            ax.add_collection(
                PolyCollection(
                    corners, facecolors=colours, edgecolors=colours, linewidths=0.2
                )
            )
            ax.grid(False)
            ax.set(aspect="equal", xlim=(0, 1), ylim=(0, 1), xticks=[], yticks=[])
            if when == "end":
                angle = [2 * 3.141592653589793 * k / 200 for k in range(201)]
                np = common.np
                ax.plot(
                    0.5 + 0.15 * np.cos(angle),
                    0.75 + 0.15 * np.sin(angle),
                    "k-",
                    lw=0.6,
                )
                ax.set(xlim=(0.3, 0.7), ylim=(0.55, 0.95))
            moment = "half time" if when == "half" else "end, enlarged"
            ax.set_title(f"{text}, {moment}", fontsize=10)
    fig.savefig(HERE / f"{name}.png", dpi=110)
    common.plt.close(fig)


def main():
    if sys.argv[1:] == ["--draw"]:
        return draw(common.read_table(HERE))
    tool = program()
    methods = common.output([tool, "methods"]).split()
    rows = measured(tool, methods)
    common.write_table(HERE, rows)
    draw(rows)
    picture(tool, "vortex", "vortex", 8, 91)
    picture(tool, "quarters", "quarters", 2, 45)


if __name__ == "__main__":
    main()
