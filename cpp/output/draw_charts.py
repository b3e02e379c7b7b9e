# SPDX-License-Identifier: LGPL-3.0-or-later
"""Curves of a run, or of several, as charts."""

import re

import matplotlib.pyplot as plt
import numpy as np
from picture import COLOURS, DASHES, INK, Trouble, save
from read_run import read_curves

# Names that have a symbol; others are shown as they are written.
SYMBOLS = {
    "time": "time [s]",
    "z_B": "penetration $z/B$",
    "p_sy": r"$p/\sigma_y$",
    "p_sy_eff": r"$p/\sigma_y$, breadth $b + h/2$",
}


def symbol(name):
    return SYMBOLS.get(name, name)


def pretty(text):
    """Formulae as they are printed: (2+pi)/sqrt(3) becomes (2+π)/√3."""
    text = re.sub(r"sqrt\((\w+)\)", r"√\1", text)
    return re.sub(r"(?<![A-Za-z])pi(?![A-Za-z])", "π", text)


def column(curves, name, where):
    if name not in curves:
        raise Trouble(f'{where}: no curve "{name}"; there are {", ".join(curves)}')
    return curves[name]


def draw_references(ax, references):
    for line in references:
        ax.axhline(
            line["value"],
            color="black",
            linewidth=1,
            dashes=(6, 3),
            zorder=3,
            label=f"{pretty(line['label'])}: {line['value']:.5g}",
        )


def dress(ax, values, references):
    """Grid and limits: from 0 where nothing is below it, and some air."""
    ax.grid(True, color="#dddddd", linewidth=0.5)
    ax.set_axisbelow(True)
    ax.margins(x=0.01)
    known = [np.asarray(v)[np.isfinite(v)] for v in values]
    known = np.concatenate([*known, [line["value"] for line in references]])
    if len(known) and known.min() >= 0 and known.max() > 0:
        # A band far from 0 (a pulse's 0.57 to 0.58) keeps its detail.
        if np.ptp(known) > 0.2 * known.max():
            ax.set_ylim(0, 1.12 * known.max())


def plot(ax, x, y, i, label=None):
    few = len(x) <= 25
    ax.plot(
        x,
        y,
        color=COLOURS[i % len(COLOURS)],
        linestyle=DASHES[i // len(COLOURS) % len(DASHES)],
        marker="o" if few else None,
        markersize=3,
        label=label,
    )


def draw_points(ax, x, y):
    ax.plot(
        x,
        y,
        linestyle="none",
        marker="x",
        color=INK,
        markersize=6,
        zorder=3,
        label="reference",
    )


def known_points(chart):
    """Reference values of a chart's curves, as x and y."""
    x, y = chart["x"], chart["y"]
    known = [p for p in chart.get("points", []) if p["x"] == x and p["y"] in y]
    return [p["at"] for p in known], [p["value"] for p in known]


def close_to(references, series):
    """Limits that show the plateau beside a reference, or None."""
    if len(references) != 1 or references[0]["value"] <= 0:
        return None
    value = references[0]["value"]
    ends = [y[np.isfinite(y)][-1:] for _, y, _, _ in series]
    tops = [np.nanmax(y) for _, y, _, _ in series if np.any(np.isfinite(y))]
    lowest = min([e[0] for e in ends if len(e)] + [value])
    highest = max([*tops, value])
    if not 0.7 * value < lowest or not highest < 1.5 * value:
        return None
    room = 0.15 * (highest - lowest) + 0.02 * value
    return lowest - room, highest + room


def draw_together(plan, chart, series, file):
    """Curves in one chart, and their plateau larger where there is one.

    series: list of (x, y, name, label)."""
    references = chart["references"]
    points = known_points(chart)
    near = close_to(references, series)
    figure, axes = plt.subplots(
        1,
        2 if near else 1,
        squeeze=False,
        figsize=(9.4 if near else 6.2, 4.0),
        layout="constrained",
    )
    for ax in axes.flat:
        for i, (x, y, _, label) in enumerate(series):
            plot(ax, x, y, i, label)
        dress(ax, [s[1] for s in series], references)
        draw_references(ax, references)
        if points[0]:
            draw_points(ax, *points)
        ax.set_xlabel(chart.get("x_label") or symbol(chart["x"]))
    axes[0, 0].set_ylabel(chart.get("y_label") or symbol(series[0][2]))
    if near:
        axes[0, 1].set_ylim(*near)
        axes[0, 1].set_title("the same, near the reference", fontsize=9, color=INK)
    if len(series) + len(references) + len(points[0]) > 1:
        axes[0, 0].legend(fontsize=9 if len(series) <= 8 else 7)
    axes[0, 0].set_title(chart.get("title") or plan["title"])
    save(figure, file)


def draw_panels(title, x_name, runs, names, file, compact=False):
    """One panel a curve: they need not have a unit in common.

    runs: dict label -> curves of a run"""
    columns = (1 if len(names) <= 3 else 2) if not compact else min(len(names), 4)
    rows = -(-len(names) // columns)
    breadth, height = (2.9, 1.5) if compact else (6.2 if columns == 1 else 4.4, 1.9)
    figure, axes = plt.subplots(
        rows,
        columns,
        sharex=True,
        squeeze=False,
        figsize=(max(breadth * columns, 6.2), max(height * rows, 3.0) + 0.4),
        layout="constrained",
    )
    for i, (ax, name) in enumerate(zip(axes.flat, names)):
        for k, (label, curves) in enumerate(runs.items()):
            x = column(curves, x_name, "curves.csv")
            plot(ax, x, column(curves, name, "curves.csv"), k, label)
        dress(ax, [curves[name] for curves in runs.values()], [])
        if compact:
            ax.set_title(symbol(name), fontsize=8)
            ax.tick_params(labelsize=7)
            ax.yaxis.get_offset_text().set_fontsize(7)
        else:
            ax.set_ylabel(symbol(name))
        ax.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=True)
        if i + columns >= len(names):
            ax.set_xlabel(symbol(x_name), fontsize=8 if compact else None)
            ax.tick_params(labelbottom=True)
    for ax in axes.flat[len(names) :]:
        ax.set_visible(False)
    if len(runs) > 1:
        axes[0, 0].legend(fontsize=8)
    if not compact:
        figure.align_ylabels()
    figure.suptitle(title, fontsize=11, x=0.01, ha="left")
    save(figure, file)


def telling(curves, names):
    """Those of the names whose curve is somewhere neither NaN nor 0."""
    return [n for n in names if n in curves and np.any(np.nan_to_num(curves[n]))]


def draw_chart(folder, plan, chart):
    curves = read_curves(folder, plan["curves"])
    x = column(curves, chart["x"], plan["curves"])
    if not len(x):
        raise Trouble(f"{plan['curves']}: no row yet")
    file = folder / chart["file"]
    layout = chart.get("layout", "together")
    if layout == "diagnostics":
        names = telling(curves, chart["y"])
        if names:
            title = f"{plan['title']}: diagnostics"
            draw_panels(title, chart["x"], {"": curves}, names, file, True)
        return
    if layout == "panels":
        draw_panels(plan["title"], chart["x"], {"": curves}, chart["y"], file)
        return
    series = [
        (x, column(curves, name, plan["curves"]), name, symbol(name))
        for name in chart["y"]
    ]
    draw_together(plan, chart, series, file)
