# SPDX-License-Identifier: LGPL-3.0-or-later
"""Start meshes: nodes (n, 2) and cells (m, 3), counter-clockwise."""

import numpy as np


def grid(nx, ny, draw=None):
    """The unit square in squares cut in two: like a chess board, or at random."""
    i, j = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1))
    x = np.stack([i.ravel() / nx, j.ravel() / ny], 1)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(nx), np.arange(ny)))
    a = j * (nx + 1) + i
    b, c, d = a + 1, a + nx + 2, a + nx + 1
    other = (i + j) % 2 == 1 if draw is None else draw.random(len(a)) < 0.5
    first = np.where(other, [a, b, d], [a, b, c]).T
    second = np.where(other, [b, c, d], [a, c, d]).T
    return x, np.concatenate([first, second])


def areas(x, cells):
    u, v = (x[cells[:, k]] - x[cells[:, 0]] for k in (1, 2))
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def radius_ratio(x, cells):
    """Of each cell, negative where it is inverted."""
    a, b, c = (x[cells[:, k]] for k in range(3))
    la, lb, lc = (np.linalg.norm(p, axis=1) for p in (c - b, a - c, b - a))
    s = areas(x, cells)
    return 16 * s * np.abs(s) / ((la + lb + lc) * la * lb * lc)


def shake(x, cells, part, draw):
    """Inner nodes moved by up to a part of their shortest edge, each alone;
    a node that would invert a cell stays."""
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    length = np.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1)
    shortest = np.full(len(x), np.inf)
    for k in range(2):
        np.minimum.at(shortest, edges[:, k], length)
    known = {(a, b) for a, b in edges.tolist()}
    outer = [a for a, b in known if (b, a) not in known]
    outer += [b for a, b in known if (b, a) not in known]
    step = draw.uniform(-part, part, x.shape) * shortest[:, None]
    step[outer] = 0
    out = x + step
    while True:
        bad = np.unique(cells[radius_ratio(out, cells) < 1e-3])
        if len(bad) == 0:
            return out
        out[bad] = x[bad] + 0.9 * (out[bad] - x[bad])


def random(n=64, part=0.6, seed=1):
    """The unit square, diagonals and nodes at random."""
    draw = np.random.default_rng(seed)
    x, cells = grid(n, n, draw)
    return shake(x, cells, part, draw), cells


def graded(n=48, seed=2):
    """A quarter of a ring, radii 1/50 to 1: edges grow 50 times, shaken."""
    draw = np.random.default_rng(seed)
    rows = int(round(np.log(50) / (np.pi / 2) * n))
    x, cells = grid(rows, n)
    radius, angle = 50 ** (x[:, 0] - 1), np.pi / 2 * x[:, 1]
    x = np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)
    return shake(x, cells, 0.6, draw), cells


def hill(n=64, height=0.5, width=0.15):
    """A square over a hill: a domain that is not convex. Bottom nodes are evenly
    spaced along the hill, rows are spread evenly between bottom and top."""
    x, cells = grid(n, n)
    t = np.linspace(0, 1, 20001)
    y = height * np.exp(-(((t - 0.5) / width) ** 2))
    way = np.concatenate([[0], np.cumsum(np.hypot(np.diff(t), np.diff(y)))])
    at = np.interp(x[:, 0] * way[-1], way, t)
    foot = np.stack([at, np.interp(at, t, y)], 1)
    top = np.stack([x[:, 0], np.ones(len(x))], 1)
    return foot + x[:, 1:] * (top - foot), cells
