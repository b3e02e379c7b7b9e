#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Pictures of a run, from the files in its folder.

    draw.py run FOLDER
        all pictures that FOLDER/pictures.json asks for
    draw.py compare FOLDER FOLDER ... -o PICTURE.png [--x NAME] [--y NAME]
        one curve of several runs in one chart, with the reference line

Reads curves.csv and the ASCII field files (.pvd, .pvtu, .vtu) of the run.
Needs numpy and matplotlib, nothing else.
"""

import argparse
import csv
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    from matplotlib.collections import LineCollection
    from matplotlib.tri import Triangulation
except ImportError as error:
    sys.exit(f"no pictures: numpy and matplotlib are needed ({error})")

STYLE = {
    "font.size": 10,
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "savefig.dpi": 200,
    "savefig.bbox": "tight",
    "savefig.pad_inches": 0.08,
}
# Okabe and Ito's colours, told apart by everyone; yellow is left out on white.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
DASHES = ["-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5))]
COLOUR_MAP = "viridis"
INK = "#222222"

# Names that have a symbol; others are shown as they are written.
SYMBOLS = {
    "time": "time [s]",
    "z_B": "penetration $z/B$",
    "p_sy": r"$p/\sigma_y$",
    "p_sy_eff": r"$p/\sigma_y$, breadth $b + h/2$",
}


class Trouble(Exception):
    """What keeps a picture from being drawn, in words for the user."""


# ---------------------------------------------------------------- reading


@dataclass
class Grid:
    """Triangles and what is known on them, all pieces in one."""

    time: float
    points: np.ndarray  # shape (nodes, 2) [m]
    cells: np.ndarray  # shape (cells, 3)
    nodal: dict  # name -> shape (nodes,) or (nodes, components)
    cell: dict  # name -> shape (cells,) or (cells, components)


def read_curves(folder, name="curves.csv"):
    """Columns of curves.csv by name, in the file's order."""
    file = Path(folder) / name
    try:
        with open(file, newline="") as stream:
            rows = list(csv.reader(stream))
    except OSError as error:
        raise Trouble(f"{file}: {error.strerror}")
    if not rows:
        raise Trouble(f"{file}: empty")
    try:
        table = np.array(rows[1:], dtype=float).reshape(-1, len(rows[0]))
    except ValueError as error:
        raise Trouble(f"{file}: {error}")
    return dict(zip(rows[0], table.T))


def read_arrays(parent):
    """Data arrays of an XML element, by name."""
    out = {}
    for array in parent if parent is not None else []:
        if array.get("format") != "ascii":
            raise Trouble(f"{array.get('Name')}: only ASCII arrays can be read")
        kind = float if array.get("type", "").startswith("Float") else np.int64
        values = np.array((array.text or "").split(), dtype=kind)
        width = int(array.get("NumberOfComponents") or 1)
        out[array.get("Name") or "points"] = (
            values.reshape(-1, width) if width > 1 else values
        )
    return out


def parse(file):
    try:
        return ElementTree.parse(file).getroot()
    except OSError as error:
        raise Trouble(f"{file}: {error.strerror}")
    except ElementTree.ParseError as error:
        raise Trouble(f"{file}: {error}")


def read_piece(file):
    """Points, owned cells, nodal and cell data and global node ids of a .vtu."""
    piece = parse(file).find("./UnstructuredGrid/Piece")
    if piece is None:
        raise Trouble(f"{file}: no unstructured grid")
    points = read_arrays(piece.find("Points"))["points"]
    topology = read_arrays(piece.find("Cells"))
    cells = topology["connectivity"].reshape(-1, 3)
    if not np.all(np.diff(topology["offsets"]) == 3):
        raise Trouble(f"{file}: not all cells are triangles")
    nodal = read_arrays(piece.find("PointData"))
    cell = read_arrays(piece.find("CellData"))
    own = cell.get("vtkGhostType", np.zeros(len(cells))) == 0
    ids = nodal.get("vtkOriginalPointIds", np.arange(len(points)))
    cell = {name: values[own] for name, values in cell.items()}
    return points, cells[own], nodal, cell, ids


def read_grid(file, time):
    """A .vtu, or all pieces of a .pvtu joined at their common nodes."""
    file = Path(file)
    files = [file]
    if file.suffix == ".pvtu":
        files = [
            file.parent / piece.get("Source") for piece in parse(file).iter("Piece")
        ]
    pieces = [read_piece(f) for f in files]
    ids = np.concatenate([piece[4] for piece in pieces])
    _, first, number = np.unique(ids, return_index=True, return_inverse=True)
    start = np.cumsum([0] + [len(piece[0]) for piece in pieces])
    cells = [number[start[i] + piece[1]] for i, piece in enumerate(pieces)]

    def join(k, name):
        return np.concatenate([piece[k][name] for piece in pieces])

    def names(k):
        return [n for n in pieces[0][k] if not n.startswith("vtk")]

    points = np.concatenate([piece[0] for piece in pieces])[first, :2]
    return Grid(
        time,
        points,
        np.concatenate(cells),
        {name: join(2, name)[first] for name in names(2)},
        {name: join(3, name) for name in names(3)},
    )


def nearest_output(pvd, time):
    """Time and file of the output nearest to a time; None is the last."""
    sets = [
        (float(s.get("timestep")), pvd.parent / s.get("file"))
        for s in parse(pvd).iter("DataSet")
    ]
    if not sets:
        raise Trouble(f"{pvd}: no output in it")
    if time is None:
        return sets[-1]
    return min(sets, key=lambda s: abs(s[0] - time))


# ---------------------------------------------------------------- fields


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
    spacing = np.sqrt(size[0] * size[1] / 350)
    at, v = sample(grid, grid.nodal[name], spacing)
    length = np.linalg.norm(v, axis=1)
    top = length.max(initial=0.0)
    if top == 0:
        ax.set_title(f"{name}: at rest", loc="right", fontsize=8, color=INK)
        return
    # The longest arrow spans 1.6 lattice cells; the shortest are dots at best.
    seen = length > 0.03 * top
    look = {"color": "white", "edgecolor": INK, "linewidth": 0.35}
    if not over_colours:
        look = {"color": COLOURS[0], "linewidth": 0}
    quiver = ax.quiver(
        *at[seen].T,
        *v[seen].T,
        angles="xy",
        scale_units="xy",
        scale=top / (1.6 * spacing),
        width=0.16 * spacing,
        units="xy",
        headwidth=3.2,
        headlength=3.6,
        headaxislength=3.2,
        minlength=0.4,
        zorder=4,
        **look,
    )
    unit = " m/s" if name == "velocity" else ""
    key = nice(top)
    ax.quiverkey(
        quiver,
        0.98,
        -0.13 if ax.get_xlabel() else -0.05,
        key,
        f"{key:g}{unit}",
        labelpos="W",
        coordinates="axes",
        fontproperties={"size": 9},
    )


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
            alpha=0.55 if faint else 1,
            zorder=2,
        )
    )


def draw_field(folder, plan, picture):
    """One picture of a field on the mesh as it stood."""
    asked = picture["time"]
    time, file = nearest_output(folder / plan["field_file"], asked)
    grid = read_grid(file, time)
    size = np.ptp(grid.points, axis=0)
    height = min(6.0, 5.0 * size[1] / size[0])
    figure, ax = plt.subplots(figsize=(max(height * size[0] / size[1], 2.0), height))
    tri = Triangulation(*grid.points.T, grid.cells)

    field = picture["field"]
    if field:
        values, nodal, label = scalar(grid, field)
        low, high, extend = colour_range(values)
        colours = {"cmap": COLOUR_MAP, "vmin": low, "vmax": high, "zorder": 1}
        if nodal:
            shown = ax.tripcolor(tri, values, shading="gouraud", **colours)
        else:
            shown = ax.tripcolor(
                tri, facecolors=values, edgecolors="face", linewidth=0.1, **colours
            )
        # As tall as the body, at its side, whatever its shape.
        side = ax.inset_axes([1 + 0.04 * height / figure.get_figwidth(), 0, 0.04, 1])
        bar = figure.colorbar(shown, cax=side, extend=extend, extendfrac=0.04)
        bar.outline.set_linewidth(0.4)
        unit = picture.get("unit", "")
        bar.set_label(f"{label} [{unit}]" if unit not in ("", "-", "1") else label)
        if extend != "neither":
            side.set_xlabel(f"max {values.max():.3g}", fontsize=7)
    else:
        ax.tripcolor(
            tri,
            facecolors=np.zeros(len(grid.cells)),
            cmap=matplotlib.colors.ListedColormap(["#e8edf2"]),
            zorder=1,
        )
    if picture["mesh"]:
        draw_mesh(ax, grid, faint=bool(field))
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
    if picture["arrows"]:
        draw_arrows(ax, grid, picture["arrows"], over_colours=bool(field))
    title = f"t = {time:.4g} s"
    if asked is not None and abs(asked - time) > 1e-6 * max(abs(asked), abs(time)):
        title += f" (nearest output to {asked:.4g} s)"
    ax.set_title(f"{plan['title']}\n{title}" if plan["title"] else title)
    save(figure, folder / picture["file"])


# ---------------------------------------------------------------- curves


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
        ax.axhline(line["value"], color="#666666", linewidth=0.9, dashes=(6, 3))
        ax.annotate(
            f"{pretty(line['label'])} = {line['value']:.5g}",
            (0.99, line["value"]),
            xycoords=("axes fraction", "data"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=8.5,
            color="#444444",
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


def draw_together(figure_title, x_name, series, references, file):
    """Curves in one chart. series: list of (x, y, name, label)."""
    figure, ax = plt.subplots(figsize=(6.2, 4.0))
    for i, (x, y, _, label) in enumerate(series):
        plot(ax, x, y, i, label)
    dress(ax, [s[1] for s in series], references)
    draw_references(ax, references)
    ax.set_xlabel(symbol(x_name))
    names = {s[2] for s in series}
    ax.set_ylabel(symbol(series[0][2]))
    if len(series) > 1:
        if len(names) == 1 and len(series) <= 12 or len(names) > 1:
            ax.legend(fontsize=9)
        else:
            ax.legend(fontsize=7, ncols=2)
    ax.set_title(figure_title)
    save(figure, file)


def draw_panels(title, x_name, curves, names, file):
    """One panel a curve: they need not have a unit in common."""
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    figure, axes = plt.subplots(
        rows,
        columns,
        sharex=True,
        squeeze=False,
        figsize=(3.7 * columns if columns > 1 else 6.2, max(2.1 * rows, 3.0) + 0.4),
        layout="constrained",
    )
    for i, (ax, name) in enumerate(zip(axes.flat, names)):
        plot(ax, curves[x_name], column(curves, name, file.name), 0)
        dress(ax, [curves[name]], [])
        ax.set_ylabel(symbol(name))
        ax.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=True)
        if i + columns >= len(names):
            ax.set_xlabel(symbol(x_name))
            ax.tick_params(labelbottom=True)
    if len(names) < rows * columns:
        axes.flat[-1].set_visible(False)
    figure.suptitle(title, fontsize=11, x=0.01, ha="left")
    save(figure, file)


def draw_chart(folder, plan, chart):
    curves = read_curves(folder, plan["curves"])
    x = column(curves, chart["x"], plan["curves"])
    if not len(x):
        raise Trouble(f"{plan['curves']}: no row yet")
    file = folder / chart["file"]
    kin = all(name.startswith(chart["y"][0]) for name in chart["y"])
    if not kin and not chart["references"]:
        draw_panels(plan["title"], chart["x"], curves, chart["y"], file)
        return
    series = [
        (x, column(curves, name, plan["curves"]), name, symbol(name))
        for name in chart["y"]
    ]
    draw_together(plan["title"], chart["x"], series, chart["references"], file)


# ---------------------------------------------------------------- programs


def save(figure, file):
    """Whole or not at all: a picture of an older run must not mix with this."""
    part = file.with_name(file.name + ".part")
    try:
        figure.savefig(part, format="png")
        part.replace(file)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise Trouble(f"{file}: {error.strerror or error}")
    finally:
        plt.close(figure)


def read_plan(folder):
    try:
        return json.loads((folder / "pictures.json").read_text())
    except OSError as error:
        raise Trouble(f"{folder / 'pictures.json'}: {error.strerror}")
    except json.JSONDecodeError as error:
        raise Trouble(f"{folder / 'pictures.json'}: {error}")


def run(folder):
    """All pictures of a run; those that fail do not stop the others."""
    plan = read_plan(folder)
    failed = []
    jobs = [(draw_chart, chart) for chart in plan["charts"]]
    jobs += [(draw_field, picture) for picture in plan["fields"]]
    for job, what in jobs:
        try:
            job(folder, plan, what)
        except Trouble as trouble:
            failed.append(f"{what['file']}: {trouble}")
    if failed:
        raise Trouble("; ".join(failed))


def flatten(scene, path=""):
    """Leaves of a scene by their dotted keys."""
    if isinstance(scene, dict):
        pairs = [(f"{path}.{k}" if path else k, v) for k, v in scene.items()]
    elif isinstance(scene, list) and any(isinstance(v, (dict, list)) for v in scene):
        pairs = [(f"{path}[{i}]", v) for i, v in enumerate(scene)]
    else:
        return {path: scene}
    out = {}
    for key, value in pairs:
        out.update(flatten(value, key))
    return out


def run_labels(folders):
    """What tells the runs apart: the keys in which their scenes differ."""
    scenes = []
    for folder in folders:
        try:
            summary = json.loads((folder / "summary.json").read_text())
            scenes.append(flatten(summary.get("scene", {})))
        except (OSError, json.JSONDecodeError):
            return [folder.name for folder in folders]
    keys = dict.fromkeys(key for scene in scenes for key in scene)
    differ = [k for k in keys if len({json.dumps(s.get(k)) for s in scenes}) > 1]
    differ = [k for k in differ if k != "title"]
    if not 0 < len(differ) <= 3:
        return [folder.name for folder in folders]

    def show(value):
        return f"{value:g}" if isinstance(value, float) else str(value)

    return [", ".join(f"{k} = {show(s[k])}" for k in differ if k in s) for s in scenes]


def compare(folders, output, x_name=None, y_name=None):
    """One curve of several runs in one chart."""
    plan = read_plan(folders[0])
    chart = next((c for c in plan["charts"] if c["references"]), None)
    chart = chart or next(iter(plan["charts"]), None)
    if chart is None and (x_name is None or y_name is None):
        raise Trouble(f"{folders[0]}: no chart to go by; give --x and --y")
    x_name = x_name or chart["x"]
    y_name = y_name or chart["y"][0]
    references = []
    for c in plan["charts"]:
        if c["x"] == x_name and c["y"][0] == y_name:
            references = c["references"]
    series = []
    for folder, label in zip(folders, run_labels(folders)):
        curves = read_curves(folder)
        where = folder / "curves.csv"
        x, y = column(curves, x_name, where), column(curves, y_name, where)
        series.append((x, y, y_name, label))
    draw_together(plan["title"], x_name, series, references, output)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    one = verbs.add_parser("run", help="all pictures of a run")
    one.add_argument("folder", type=Path)
    many = verbs.add_parser("compare", help="a curve of several runs")
    many.add_argument("folders", type=Path, nargs="+")
    many.add_argument("-o", "--output", type=Path, required=True)
    many.add_argument("--x", help="name of the abscissa")
    many.add_argument("--y", help="name of the curve")
    options = parser.parse_args(arguments)
    with plt.rc_context(STYLE):
        try:
            if options.verb == "run":
                run(options.folder)
            else:
                compare(options.folders, options.output, options.x, options.y)
        except Trouble as trouble:
            sys.exit(str(trouble))


if __name__ == "__main__":
    main()
