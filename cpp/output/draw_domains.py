# SPDX-License-Identifier: LGPL-3.0-or-later
"""A domain, and beside it what the cells of the mesh cut out of it."""

import matplotlib.pyplot as plt
import numpy as np
from draw_fields import read_at
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.tri import Triangulation
from picture import INK, save
from read_run import read_polygons, read_rings

BODY = "#d9b97c"
MESH = "#8a97a3"
# Light enough for the mesh's lines, far enough from each other as neighbours.
MIXED = ["#4e9fd1", "#e07b39", "#3fae85", "#c97fb3", "#e3c13b", "#7a6fbe", "#d1495b"]


def outline(rings):
    """All rings in one path, so that holes stay open."""
    points, codes = [], []
    for ring in rings:
        points += [*ring, ring[0]]
        codes += [Path.MOVETO, *[Path.LINETO] * (len(ring) - 1), Path.CLOSEPOLY]
    return Path(points, codes)


def neighbours_apart(cells, chosen):
    """A colour for each chosen cell that no chosen cell at its vertices has, as
    far as there are enough; the least used one first."""
    around = {}
    for c in chosen:
        for n in cells[c]:
            around.setdefault(n, []).append(c)
    colour, used = {}, np.zeros(len(MIXED), int)
    for c in chosen:
        near = {colour[d] for n in cells[c] for d in around[n] if d in colour}
        order = np.argsort(used, kind="stable")
        colour[c] = next((k for k in order if k not in near), order[0])
        used[colour[c]] += 1
    return colour


def draw_domain(folder, plan, what):
    grid = read_at(folder, plan, None)
    rings = read_rings(folder / what["outline"])
    pieces = read_polygons(folder / what["pieces"])
    share = grid.cell[what["name"]]
    mixed = np.flatnonzero((share > 0) & (share < 1))
    colour = neighbours_apart(grid.cells, mixed)
    # Pieces count cells as the mesh does, the grid as its ranks have them: the
    # centre of a piece tells its cell.
    middle = np.array([polygon.mean(axis=0) for polygon in pieces.polygons])
    find = Triangulation(*grid.points.T, grid.cells).get_trifinder()
    inside = find(*middle.T) if len(middle) else []

    size = np.ptp(grid.points, axis=0)
    breadth = min(6.0, 5.0 * size[0] / size[1])
    height = breadth * size[1] / size[0]
    figure, axes = plt.subplots(1, 2, figsize=(2 * breadth + 0.6, height + 0.7))
    path = outline(rings)
    axes[0].add_patch(PathPatch(path, facecolor=BODY, edgecolor=INK, linewidth=0.4))
    faces = [MIXED[colour[c]] if c in colour else BODY for c in inside]
    axes[1].add_collection(
        PolyCollection(pieces.polygons, facecolors=faces, edgecolors=faces, lw=0.15)
    )
    edges = grid.points[np.concatenate([grid.cells, grid.cells[:, :1]], axis=1)]
    width = np.clip(9 / np.sqrt(len(grid.cells)), 0.1, 0.4)
    axes[1].add_collection(LineCollection(edges, colors=MESH, linewidths=width))
    axes[1].add_patch(PathPatch(path, fill=False, edgecolor=INK, linewidth=0.4))
    full = np.count_nonzero(share == 1)
    notes = [
        f"{plan['title']}: {what['name']}",
        f"{len(grid.cells)} cells: {len(mixed)} mixed, each in a colour of its own, "
        f"{full} full",
    ]
    low, high = grid.points.min(axis=0), grid.points.max(axis=0)
    for ax, note in zip(axes, notes):
        ax.set_aspect("equal")
        ax.set_xlim(low[0], high[0])
        ax.set_ylim(low[1], high[1])
        ax.set_title(note, fontsize=10)
        ax.set_xlabel("r [m]" if plan["axisymmetric"] else "x [m]")
    axes[0].set_ylabel("z [m]" if plan["axisymmetric"] else "y [m]")
    figure.subplots_adjust(wspace=0.12)
    save(figure, folder / what["file"])
