# SPDX-License-Identifier: LGPL-3.0-or-later
"""The MINI element of METHOD.md, section 1, shared by all operators.

A nodal block (ux, uy, p) on P1 plus a hierarchical cubic bubble (bx, by).
Local unknowns: [ux uy p] of vertices 0, 1, 2, then bx, by; the solver condenses
the last two cell by cell.

u is the displacement increment of the step, p the total pressure at its end.
The nodal terms take one point (the centroid), so that the stress of a cell, the
mean pressure and the volume ratio are one number each, in the plane and about an
axis; the bubble's terms are integrated exactly.
"""

from itertools import permutations

import basix.ufl
import numpy as np
from ufl import Measure, FunctionSpace, Mesh, SpatialCoordinate, as_vector, grad

cell = "triangle"
node = basix.ufl.element("Lagrange", cell, 1, shape=(3,))
bubble = basix.ufl.element("Bubble", cell, 3, shape=(2,))
mini = basix.ufl.mixed_element([node, bubble])

mesh = Mesh(basix.ufl.element("Lagrange", cell, 1, shape=(2,)))
W = FunctionSpace(mesh, mini)
B = FunctionSpace(mesh, bubble)
Q = FunctionSpace(mesh, basix.ufl.element("Lagrange", cell, 1))
V = FunctionSpace(mesh, basix.ufl.element("Lagrange", cell, 1, shape=(2,)))
x = SpatialCoordinate(mesh)

# Two kernels a form, told apart by a number, since FFCx 0.9 mixes up the values of
# a coefficient at the points of two rules within one kernel. The solver calls both.
dx = Measure("dx", domain=mesh, subdomain_id=1, metadata={"quadrature_degree": 1})
dx_bubble = Measure(
    "dx", domain=mesh, subdomain_id=2, metadata={"quadrature_degree": 5}
)


def per_cell(*shape):
    """Space of one number, vector or matrix a cell."""
    return FunctionSpace(mesh, basix.ufl.element("DG", cell, 0, shape=shape))


def split(z):
    """Displacement, pressure and bubble displacement of a function."""
    nodal, bubble_displacement = z
    return as_vector((nodal[0], nodal[1])), nodal[2], bubble_displacement


def gradient(v, r, axisymmetric, value=1):
    """(xx, xy, yx, yy, zz) of grad v; zz is the hoop strain v_r / r.

    `value` is the share of v that counts where v itself stands.
    """
    g = grad(v)
    hoop = value * v[0] / r if axisymmetric else 0 * v[0]
    return as_vector((g[0, 0], g[0, 1], g[1, 0], g[1, 1], hoop))


def divergence(h):
    """Trace of a gradient in vector form."""
    return h[0] + h[3] + h[4]


def strain(h):
    """Symmetric part of a gradient, (xx, xy, yx, yy, zz)."""
    return as_vector((h[0], (h[1] + h[2]) / 2, (h[1] + h[2]) / 2, h[3], h[4]))


def deviator(h):
    """A tensor in vector form less its mean normal part."""
    m = divergence(h) / 3
    return as_vector((h[0] - m, h[1], h[2], h[3] - m, h[4] - m))


# Points of layout `quadrature`: a cell falls into triangles that move with it,
# three at its centroid or six between its medians, and each has its point where
# its mass is. So a point's weight is its triangle's volume, about an axis too,
# and the remap carries these triangles like cells.
_orbits = {3: (4 / 9, 4 / 9, 1 / 9), 6: (11 / 18, 5 / 18, 2 / 18)}
points = {
    n: np.array([c[1:] for c in sorted(set(permutations(orbit)), reverse=True)])
    for n, orbit in _orbits.items()
}


def dx_points(n):
    """Measure over the n points of a cell."""
    rule = {
        "quadrature_rule": "custom",
        "quadrature_points": points[n],
        "quadrature_weights": np.full(n, 0.5 / n),
    }
    return Measure("dx", domain=mesh, metadata=rule)


def bubble_value(n):
    """Share of the bubble's value that counts at the n points.

    The rule does not integrate by parts: of a bubble b about the centre x_c, the
    mean of b is to be -1/2 that of (x - x_c) . grad b. With b so scaled, neither a
    uniform stress about an axis nor p in balance with gravity moves the bubble.
    """
    shares = np.column_stack((1 - points[n].sum(axis=1), points[n]))
    b = 27 * np.mean(np.prod(shares, axis=1))
    pairs = np.mean(shares * np.roll(shares, 1, axis=1)) * 3
    return float((9 * pairs - 3 * b) / (2 * b))


def per_point(n, *shape):
    """Space of one number, vector or matrix a point."""
    element = basix.ufl.quadrature_element(
        cell, shape, points=points[n], weights=np.full(n, 0.5 / n)
    )
    return FunctionSpace(mesh, element)
