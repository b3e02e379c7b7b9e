# SPDX-License-Identifier: LGPL-3.0-or-later
"""Pictures of fields on the mesh as it stood at an output."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.tri import Triangulation
from picture import COLOUR_MAP, COLOURS, INK, Trouble, save
from read_run import nearest_output, read_grid


def scalar(grid, name):
    """A field as one number a node or cell, whether nodal, and its name."""
    for data, nodal in ((grid.nodal, True), (grid.cell, False)):
        if name in data:
            values = data[name]
            break
    else:
        known = ", ".join([*grid.nodal, *grid.cell])
        raise Trouble(f'no field "{name}" in the output; there are {known}')
    label = name.replace("_", " ")
    if values.ndim == 1:
        return values, nodal, label
    if values.shape[1] == 9:
        s = values.reshape(-1, 3, 3)
        s = s - np.trace(s, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
        return np.sqrt(1.5 * np.sum(s * s, axis=(1, 2))), nodal, f"von Mises {label}"
    return np.linalg.norm(values, axis=1), nodal, f"|{label}|"


def colour_range(values):
    """Range of the colours; one cell at a corner must not take them all."""
    values = values[np.isfinite(values)]
    if not len(values):
        raise Trouble("the field has no finite value")
    low, high = values.min(), values.max()
    extend = "neither"
    p_low, p_high = np.percentile(values, [0.3, 99.7])
    if high - p_high > 0.5 * (p_high - low) and p_high > low:
        high, extend = p_high, "max"
    if p_low - low > 0.5 * (high - p_low) and high > p_low:
        low, extend = p_low, "min" if extend == "neither" else "both"
    size = max(abs(low), abs(high))
    if high - low <= 1e-9 * size or size == 0:
        low, high = low - (0.05 * size or 1), high + (0.05 * size or 1)
    return low, high, extend


def border(cells):
    """Edges that belong to one cell only, shape (edges, 2)."""
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    return edges[first[count == 1]]


def sample(grid, values, spacing):
    """Places on a square lattice inside the body, and nodal values there."""
    low, high = grid.points.min(axis=0), grid.points.max(axis=0)
    count = np.maximum(np.floor((high - low) / spacing).astype(int), 1)
    axes = [
        low[k] + (high[k] - low[k]) * (np.arange(count[k]) + 0.5) / count[k]
        for k in range(2)
    ]
    at = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    a, b, c = (grid.points[grid.cells[:, k]] for k in range(3))
    area = cross(b - a, c - a)
    out, inside = np.zeros((len(at), 2)), np.zeros(len(at), bool)
    # A few hundred places: each looks through all cells at once. A tangled
    # mesh, at which matplotlib's own search gives up, does no harm here.
    with np.errstate(divide="ignore", invalid="ignore"):
        for i, x in enumerate(at):
            w = np.stack(
                [cross(b - x, c - x), cross(c - x, a - x), cross(a - x, b - x)]
            )
            w = w / area
            depth = np.nan_to_num(w.min(axis=0), nan=-1.0)
            best = int(np.argmax(depth))
            if depth[best] >= 0:
                inside[i] = True
                out[i] = w[:, best] @ values[grid.cells[best], :2]
    return at[inside], out[inside]


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def nice(value):
    """The next number below of the form 1, 2, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-12))


def draw_arrows(ax, grid, name, over_colours):
    if name not in grid.nodal:
        raise Trouble(f'no nodal field "{name}" for arrows')
    size = np.ptp(grid.points, axis=0)
    spacing = np.sqrt(size[0] * size[1] / 260)
    at, v = sample(grid, grid.nodal[name], spacing)
    length = np.linalg.norm(v, axis=1)
    top = length.max(initial=0.0)
    if top == 0:
        ax.set_title(f"{name}: at rest", loc="right", fontsize=8, color=INK)
        return
    # The longest arrow fills its lattice cell; the shortest would be dots.
    seen = length > 0.04 * top
    look = {"color": "white", "edgecolor": INK, "linewidth": 0.3}
    if not over_colours:
        look = {"color": COLOURS[0], "linewidth": 0}
    quiver = ax.quiver(
        *at[seen].T,
        *v[seen].T,
        angles="xy",
        scale_units="xy",
        scale=top / spacing,
        width=0.07 * spacing,
        pivot="mid",
        clip_on=False,
        units="xy",
        headwidth=4,
        headlength=4.5,
        headaxislength=4,
        minlength=0.4,
        zorder=4,
        **look,
    )
    # Its extent is taken from places before they are scaled: far too large.
    quiver.set_in_layout(False)
    unit = " m/s" if name == "velocity" else ""
    key = nice(top)
    # Beside the name of the abscissa, where nothing else is written.
    ax.figure.canvas.draw()
    place = ax.xaxis.label.get_window_extent()
    row = ax.transAxes.inverted().transform((0, (place.y0 + place.y1) / 2))[1]
    ax.quiverkey(quiver, 0.93, row, key, f"{key:g}{unit}", labelpos="W", labelsep=0.07)


def draw_mesh(ax, grid, faint):
    triangulation = np.concatenate([grid.cells, grid.cells[:, :1]], axis=1)
    area = np.prod(np.ptp(grid.points, axis=0))
    # Lines must not hide the colours of fine meshes.
    typical = np.sqrt(area / len(grid.cells)) / np.sqrt(area)
    width = np.clip(12 * typical, 0.1, 0.5)
    ax.add_collection(
        LineCollection(
            grid.points[triangulation],
            colors="white" if faint else "#5b6b7a",
            linewidths=width,
            alpha=0.55 * np.clip(typical / 0.02, 0.25, 1) if faint else 1,
            zorder=2,
        )
    )


def shown_values(grid, picture):
    """Values of a picture's field, whether nodal, and its label; None, False,
    "" for the mesh alone."""
    if not picture["field"]:
        return None, False, ""
    values, nodal, label = scalar(grid, picture["field"])
    unit = picture.get("unit", "")
    return values, nodal, f"{label} [{unit}]" if unit not in ("", "-", "1") else label


def draw_body(ax, grid, values, nodal, limits):
    """Field or plain body in the plane; returns what a colour bar needs."""
    tri = Triangulation(*grid.points.T, grid.cells)
    if values is None:
        ax.tripcolor(
            tri,
            facecolors=np.zeros(len(grid.cells)),
            cmap=ListedColormap(["#e8edf2"]),
            zorder=1,
        )
        return None
    colours = {"cmap": COLOUR_MAP, "vmin": limits[0], "vmax": limits[1], "zorder": 1}
    if nodal:
        return ax.tripcolor(tri, values, shading="gouraud", **colours)
    return ax.tripcolor(
        tri, facecolors=values, edgecolors="face", linewidth=0.4, **colours
    )


def at_nodes(grid, values):
    """Cell values as means around the nodes, weighted by area."""
    a, b, c = (grid.points[grid.cells[:, k]] for k in range(3))
    weight = np.repeat(np.abs(cross(b - a, c - a)), 3)
    nodes = grid.cells.ravel()
    total = np.bincount(nodes, weight * np.repeat(values, 3), len(grid.points))
    return total / np.bincount(nodes, weight, len(grid.points))


def draw_surface(ax, grid, values, nodal, limits):
    """A field as height over the plane, in axes of three dimensions."""
    heights = values if nodal else at_nodes(grid, values)
    ax.plot_trisurf(
        *grid.points.T,
        heights,
        triangles=grid.cells,
        cmap=COLOUR_MAP,
        vmin=limits[0],
        vmax=limits[1],
        linewidth=0.1,
        edgecolor="#00000040",
        antialiased=True,
    )
    ax.set_zlim(*limits)
    ax.view_init(elev=28, azim=-60)
    ax.set_box_aspect((1, 1, 0.7), zoom=0.92)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_pane_color((1, 1, 1, 0))
        axis.line.set_linewidth(0.6)
    ax.tick_params(labelsize=7, pad=-1)


def dress_plane(ax, grid, picture, plan, over_colours):
    """Mesh, border, axes and arrows of a picture in the plane."""
    size = np.ptp(grid.points, axis=0)
    if picture["mesh"]:
        draw_mesh(ax, grid, faint=over_colours)
    ax.add_collection(
        LineCollection(
            grid.points[border(grid.cells)], colors=INK, linewidths=0.8, zorder=3
        )
    )
    ax.set_aspect("equal")
    margin = 0.02 * size.max()
    ax.set_xlim(grid.points[:, 0].min() - margin, grid.points[:, 0].max() + margin)
    ax.set_ylim(grid.points[:, 1].min() - margin, grid.points[:, 1].max() + margin)
    ax.set_xlabel("r [m]" if plan["axisymmetric"] else "x [m]")
    ax.set_ylabel("z [m]" if plan["axisymmetric"] else "y [m]")
    ax.locator_params(nbins=6)
    if size[0] < 0.4 * size[1]:  # numbers need room beside each other
        ax.locator_params(axis="x", nbins=2)
    if picture["arrows"]:
        draw_arrows(ax, grid, picture["arrows"], over_colours)


def add_bar(figure, ax, shown, extend, label, highest, height):
    """A colour bar as tall as the body, at its side, whatever its shape."""
    side = ax.inset_axes([1 + 0.04 * height / figure.get_figwidth(), 0, 0.04, 1])
    bar = figure.colorbar(shown, cax=side, extend=extend, extendfrac=0.04)
    bar.outline.set_linewidth(0.4)
    bar.set_label(label)
    if extend != "neither":
        side.set_xlabel(f"max {highest:.3g}", fontsize=7)


def draw_grids(grids, plan, picture, notes, file):
    """One picture with a part a grid, all in the same colours.

    notes: a line of words for each grid."""
    fields = [shown_values(grid, picture) for grid in grids]
    _, nodal, label = fields[0]
    limits, extend, highest = None, "neither", 0
    if label:
        together = np.concatenate([values for values, _, _ in fields])
        *limits, extend = colour_range(together)
        highest = together.max()
    solid = picture.get("surface", False)
    size = np.ptp(grids[0].points, axis=0)
    height = min(6.0, 5.0 * size[1] / size[0]) if len(grids) == 1 else 4.2
    breadth = max(height * size[0] / size[1], 2.0) + 0.8 * (len(grids) > 1)
    figure, axes = plt.subplots(
        1,
        len(grids),
        squeeze=False,
        figsize=((4.0 if solid else breadth) * len(grids), 4.0 if solid else height),
        subplot_kw={"projection": "3d"} if solid else {},
    )
    for ax, grid, (values, nodal, _), note in zip(axes.flat, grids, fields, notes):
        if solid:
            draw_surface(ax, grid, values, nodal, limits)
            note += f"\n{label}: {values.min():.3g} to {values.max():.4g}"
            ax.set_title(note, fontsize=10, loc="center")
            continue
        shown = draw_body(ax, grid, values, nodal, limits)
        if shown is not None and ax is axes.flat[-1]:
            add_bar(figure, ax, shown, extend, label, highest, height)
        dress_plane(ax, grid, picture, plan, over_colours=bool(label))
        ax.set_title(note, fontsize=11 if len(grids) == 1 else 9)
    if len(grids) > 1:
        figure.suptitle(plan["title"], fontsize=11, x=0.08, y=1.0, ha="left")
        figure.subplots_adjust(wspace=0.02 if solid else 0.3)
    save(figure, file)


def read_at(folder, plan, time):
    return read_grid(*nearest_output(folder / plan["field_file"], time)[::-1])


def when(grid, picture):
    """What is shown, in words: its time and the arrows."""
    asked, words = picture["time"], f"t = {grid.time:.4g} s"
    if asked is not None and abs(asked - grid.time) > 1e-6 * max(asked, grid.time):
        words += f" (nearest output to {asked:.4g} s)"
    if picture["arrows"]:
        words += f", arrows: {picture['arrows'].replace('_', ' ')}"
    return words


def draw_field(folder, plan, picture):
    """One picture of a field on the mesh as it stood."""
    grid = read_at(folder, plan, picture["time"])
    grids, notes = [grid], [when(grid, picture)]
    if picture.get("start"):
        grids.insert(0, read_at(folder, plan, 0.0))
        notes.insert(0, "start")
    elif plan["title"]:
        notes = [f"{plan['title']}\n{notes[0]}"]
    draw_grids(grids, plan, picture, notes, folder / picture["file"])


def draw_fields(runs, plan, picture, file):
    """One picture of a field with a part for each of several runs.

    runs: dict label -> folder"""
    grids = [read_at(folder, plan, picture["time"]) for folder in runs.values()]
    notes = [f"{label}\n{when(g, picture)}" for label, g in zip(runs, grids)]
    if picture.get("start"):
        grids.insert(0, read_at(next(iter(runs.values())), plan, 0.0))
        notes.insert(0, "start")
    draw_grids(grids, plan, picture, notes, file)
