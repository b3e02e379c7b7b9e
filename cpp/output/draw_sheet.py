# SPDX-License-Identifier: LGPL-3.0-or-later
"""Panels of an element test, each with its own abscissa, of one run or several."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from draw_charts import column, draw_points, plot
from picture import INK, Trouble, save
from read_run import read_curves

# Symbol, unit and what a value in SI is multiplied with to be shown in it.
AXES = {
    "time": ("time", "s", 1),
    "cycle": ("cycles", "", 1),
    "p": ("$p'$", "kPa", 1e-3),
    "q": ("$q$", "kPa", 1e-3),
    "von_mises": (r"$\sqrt{3/2}\,|s|$", "kPa", 1e-3),
    "sigma_a": (r"$\sigma'_a$", "kPa", 1e-3),
    "sigma_r": (r"$\sigma'_r$", "kPa", 1e-3),
    "sigma_t": (r"$\sigma'_t$", "kPa", 1e-3),
    "tau": (r"$\tau$", "kPa", 1e-3),
    "pore_pressure": ("$u$", "kPa", 1e-3),
    "eps_a": (r"$\varepsilon_a$", "%", 100),
    "eps_r": (r"$\varepsilon_r$", "%", 100),
    "eps_t": (r"$\varepsilon_t$", "%", 100),
    "eps_v": (r"$\varepsilon_v$", "%", 100),
    "eps_q": (r"$\varepsilon_q$", "%", 100),
    "gamma": (r"$\gamma$", "%", 100),
    "void_ratio": ("$e$", "", 1),
}


def axis(name, runs):
    """Label and factor of a column."""
    symbol, unit, factor = AXES.get(name, (name, "", 1))
    if unit == "kPa":
        values = [np.abs(column(c, name, "curves.csv")) for c in runs.values()]
        if np.nanmax(np.concatenate(values)) >= 1e7:
            unit, factor = "MPa", 1e-6
    return f"{symbol} [{unit}]" if unit else symbol, factor


def known_points(sheet, panel):
    """Reference values that lie in a panel, as x and y."""
    x, y = panel["x"], panel["y"]
    points = [
        (p["at"], p["value"]) for p in sheet["points"] if p["x"] == x and p["y"] == y
    ]
    # A place on a third column (a cycle, say) has a point where both are known.
    places = {}
    for p in sheet["points"]:
        places.setdefault((p["x"], p["at"]), {})[p["y"]] = p["value"]
    points += [(v[x], v[y]) for v in places.values() if x in v and y in v]
    return np.array(points).reshape(-1, 2).T


def draw_panel(ax, panel, runs, sheet, data):
    x_label, x_factor = axis(panel["x"], runs)
    y_label, y_factor = axis(panel["y"], runs)
    for i, (label, curves) in enumerate(runs.items()):
        x = x_factor * column(curves, panel["x"], "curves.csv")
        y = y_factor * column(curves, panel["y"], "curves.csv")
        if panel["log_x"]:
            y = np.where(x > 0, y, np.nan)
        plot(ax, x, y, i, label or "test")
    x, y = known_points(sheet, panel)
    if len(x):
        draw_points(ax, x_factor * x, y_factor * y)
    if data and panel["x"] in data and panel["y"] in data:
        ax.plot(
            x_factor * data[panel["x"]],
            y_factor * data[panel["y"]],
            linestyle="none",
            marker="o",
            markerfacecolor="none",
            color=INK,
            markersize=4,
            zorder=2,
            label="data",
        )
    if panel["log_x"]:
        ax.set_xscale("log")
    else:
        ax.locator_params(axis="x", nbins=7)
    # Consolidation curves fall with pressure, as in a textbook.
    if panel["y"] == "eps_v" and panel["log_x"]:
        ax.invert_yaxis()
    ax.grid(True, color="#dddddd", linewidth=0.5, which="both")
    ax.set_axisbelow(True)
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)


def draw_sheets(runs, plan, sheet, file):
    """runs: dict label -> folder of a run."""
    curves = {label: read_curves(folder) for label, folder in runs.items()}
    if not any(len(next(iter(c.values()))) for c in curves.values()):
        raise Trouble("no row yet")
    data = None
    if sheet["data"]:
        data = read_curves(next(iter(runs.values())), sheet["data"])
    panels = sheet["panels"]
    rows = -(-len(panels) // 2)
    figure, axes = plt.subplots(
        rows, 2, squeeze=False, figsize=(9.0, 3.3 * rows), layout="constrained"
    )
    for ax, panel in zip(axes.flat, panels):
        draw_panel(ax, panel, curves, sheet, data)
    for ax in axes.flat[len(panels) :]:
        ax.set_visible(False)
    handles = {}
    for ax in axes.flat:
        for handle, label in zip(*ax.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    if len(handles) > 1:
        figure.legend(
            handles.values(),
            handles.keys(),
            fontsize=8,
            ncols=min(len(handles), 4),
            loc="outside lower center",
        )
    figure.suptitle(plan["title"], fontsize=11, x=0.01, ha="left")
    save(figure, file)


def draw_sheet(folder, plan, sheet):
    draw_sheets({"": Path(folder)}, plan, sheet, Path(folder) / sheet["file"])
