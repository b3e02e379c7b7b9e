# SPDX-License-Identifier: LGPL-3.0-or-later
"""Reads what a run has written: curves.csv, pictures.json, field files."""

import csv
import json
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from picture import Trouble


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


@dataclass
class Polygons:
    """Convex polygons in the plane and numbers for each."""

    polygons: list  # of shape (vertices, 2) each [m]
    data: dict  # name -> shape (polygons,)


def read_polygons(file):
    """A .vtp that the program has written."""
    piece = parse(file).find("./PolyData/Piece")
    if piece is None:
        raise Trouble(f"{file}: no polygons")
    points = read_arrays(piece.find("Points"))["points"].reshape(-1, 3)[:, :2]
    topology = read_arrays(piece.find("Polys"))
    corners = points[topology["connectivity"]]
    polygons = np.split(corners, topology["offsets"][:-1]) if len(corners) else []
    return Polygons(polygons, read_arrays(piece.find("CellData")))


def read_rings(file):
    """Rings of a domain's text: a point a line, an empty line between them."""
    try:
        parts = Path(file).read_text().strip().split("\n\n")
    except OSError as error:
        raise Trouble(f"{file}: {error.strerror}")
    try:
        return [
            np.array([line.split() for line in part.splitlines()], dtype=float)
            for part in parts
        ]
    except ValueError as error:
        raise Trouble(f"{file}: {error}")


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


def read_plan(folder):
    try:
        return json.loads((folder / "pictures.json").read_text())
    except OSError as error:
        raise Trouble(f"{folder / 'pictures.json'}: {error.strerror}")
    except json.JSONDecodeError as error:
        raise Trouble(f"{folder / 'pictures.json'}: {error}")
