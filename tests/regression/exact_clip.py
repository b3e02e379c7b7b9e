# SPDX-License-Identifier: LGPL-3.0-or-later
"""Rings cut by triangles in exact rational arithmetic, from the files of a run.

Nothing of it is the program's: numbers are taken as the doubles that its files
hold, and cut without rounding. Standard library only.
"""

import xml.etree.ElementTree as ElementTree
from fractions import Fraction
from pathlib import Path


def read_rings(file):
    parts = Path(file).read_text().strip().split("\n\n")
    return [
        [tuple(float(x) for x in line.split()) for line in part.splitlines()]
        for part in parts
    ]


def read_cells(folder, name):
    """(corners, share, centroid) of each cell, ghosts left out."""
    out = []
    for file in sorted(Path(folder).glob("fields_p*_000000.vtu")):
        piece = ElementTree.parse(file).getroot().find("./UnstructuredGrid/Piece")

        def array(parent, name=None):
            for a in piece.find(parent):
                if a.get("Name") == name or name is None:
                    return (a.text or "").split()

        x = list(map(float, array("Points")))
        nodes = list(map(int, array("Cells", "connectivity")))
        share = list(map(float, array("CellData", name)))
        centre = list(map(float, array("CellData", name + "_centroid")))
        for c, ghost in enumerate(array("CellData", "vtkGhostType")):
            if ghost == "0":
                corners = nodes[3 * c : 3 * c + 3]
                place = [(x[3 * n], x[3 * n + 1]) for n in corners]
                out.append((place, share[c], centre[3 * c : 3 * c + 2]))
    return out


def seen(ring, corners):
    """The ring without points that, with both neighbours, lie beyond one side of
    the corners' box: what it encloses in the box stays the same."""
    xs, ys = zip(*corners)
    low, high = (min(xs), min(ys)), (max(xs), max(ys))

    def beyond(p):
        return (
            (p[0] < low[0])
            | (p[0] > high[0]) << 1
            | (p[1] < low[1]) << 2
            | (p[1] > high[1]) << 3
        )

    out = []
    for p in ring:
        while len(out) > 1 and beyond(p) & beyond(out[-1]) & beyond(out[-2]):
            out.pop()
        out.append(p)
    return out


def exact(points):
    return [(Fraction(x), Fraction(y)) for x, y in points]


def cut(ring, a, b):
    """What of a ring lies to the left of the way from a to b."""

    def depth(p):
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    out = []
    for p, q in zip([ring[-1], *ring], ring):
        dp, dq = depth(p), depth(q)
        if (dp > 0) != (dq > 0) and dp != dq:
            t = dp / (dp - dq)
            out.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
        if dq > 0:
            out.append(q)
    return out


def moments(ring):
    """Area and first moments, each part as often as the ring runs around it."""
    area = x = y = Fraction(0)
    for p, q in zip([*ring[-1:], *ring], ring):
        w = p[0] * q[1] - p[1] * q[0]
        area += w
        x += w * (p[0] + q[0])
        y += w * (p[1] + q[1])
    return [area / 2, x / 6, y / 6]


def add(a, b):
    return [s + t for s, t in zip(a, b)]


def whole(rings):
    total = [Fraction(0)] * 3
    for ring in rings:
        total = add(total, moments(exact(ring)))
    return total


def part(rings, corners):
    """Moments of the rings' part in a triangle, and those of the triangle."""
    triangle = exact(corners)
    if moments(triangle)[0] < 0:
        triangle.reverse()
    total = [Fraction(0)] * 3
    for ring in rings:
        piece = exact(seen(ring, corners))
        for k in range(3):
            if piece:
                piece = cut(piece, triangle[k], triangle[(k + 1) % 3])
        total = add(total, moments(piece))
    return total, moments(triangle)
