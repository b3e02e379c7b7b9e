# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which transport scheme for which field: cyclic remap, error against time.

With --draw the chart is drawn anew from results.csv.
"""

import csv
import io
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

SQUARES = [16, 23, 32, 45, 64]  # along a side; each is two triangles
FUNCTIONS = ["sine", "peak", "shock"]
PATHS = ["tensor", "smooth", "random"]
COLOURS = [*common.COLOURS, "#888888", common.COLOURS[1]]
COLUMNS = [
    "scheme",
    "method",
    "function",
    "path",
    "squares along a side",
    "cells",
    "seconds",
    "error",
    "out of bounds",
    "mass error",
    "sub-cycles",
    "outcome",
]
# Portage d1f27b6, 64 x 64 quadrilaterals, exact intersection, Barth-Jespersen
PORTAGE_CELLS = 4096
PORTAGE = {
    "sine": [4.10e-3, 1.64e-3, 4.37e-3],
    "peak": [1.08e-1, 7.30e-2, 8.90e-2],
    "shock": [3.79e-2, 1.76e-2, 3.06e-2],
}


def program():
    """The cases of the remap library, built beside the solver."""
    return common.built("remap_cases", "cyclic/program/remap_cases")


def cases(words, columns):
    """The rows that the program prints for some words."""
    text = common.output(words)
    rows = [dict(zip(columns, row)) for row in csv.reader(io.StringIO(text))]
    print(" ".join(words[1:]), flush=True)
    return rows


def scheme_names(program):
    return common.output([program, "schemes"]).split()


def draw(rows):
    schemes = list(dict.fromkeys((row["scheme"], row["method"]) for row in rows))
    fig, axes = common.figure(3, width=12, height=11, rows=3)
    for i, function in enumerate(FUNCTIONS):
        for j, path in enumerate(PATHS):
            ax = axes[i][j]
            for k, scheme in enumerate(schemes):
                chosen = [
                    row
                    for row in rows
                    if (row["scheme"], row["method"]) == scheme
                    and (row["function"], row["path"]) == (function, path)
                ]
                ax.plot(
                    [float(row["seconds"]) for row in chosen],
                    [float(row["error"]) for row in chosen],
                    color=COLOURS[k % len(COLOURS)],
                    marker=common.MARKERS[k % len(common.MARKERS)],
                    markersize=4.5,
                    linewidth=1.2,
                    linestyle="--" if scheme[1] == "overlay" else "-",
                    label=", ".join(scheme).replace("_", " ").replace(", swept", ""),
                )
            ax.axhline(
                PORTAGE[function][j],
                color="black",
                linewidth=1,
                dashes=(6, 3),
                label=f"Portage, {PORTAGE_CELLS} cells",
            )
            ax.set(xscale="log", yscale="log")
            ax.set_title(f"{function} on {path}", fontsize=10)
            if j == 0:
                ax.set_ylabel("L1 error after 80 remaps, relative")
            if i == 2:
                ax.set_xlabel("processor time of the remaps [s]")
    lines = axes[0][0].get_legend_handles_labels()
    fig.legend(*lines, loc="outside lower center", ncols=5, fontsize=9)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        return draw(common.read_table(HERE))
    remap_cases = program()
    rows = []
    both = [(scheme, "swept") for scheme in scheme_names(remap_cases)]
    for scheme, method in [*both, ("limited_linear", "overlay")]:
        for n in SQUARES:
            words = [remap_cases, "cyclic", scheme, method, str(n)]
            rows += cases(words, COLUMNS)
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
