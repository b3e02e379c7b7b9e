# SPDX-License-Identifier: LGPL-3.0-or-later
"""Small-strain plasticity on the MINI element, as a DOLFINx user would write it.

Unknowns: P1 displacement, bubble displacement, P1 pressure; stress deviator and
tangent are quadrature functions of degree 4 (six points), filled by the program.
"""

import basix
import basix.ufl
from ufl import (
    Coefficient,
    Constant,
    FunctionSpace,
    Measure,
    Mesh,
    TestFunctions,
    TrialFunctions,
    as_vector,
    div,
    dot,
    split,
    sym,
    grad,
)

cell, degree = "triangle", 4
mesh = Mesh(basix.ufl.element("Lagrange", cell, 1, shape=(2,)))
W = FunctionSpace(
    mesh,
    basix.ufl.mixed_element(
        [
            basix.ufl.element("Lagrange", cell, 1, shape=(2,)),
            basix.ufl.element("Bubble", cell, 3, shape=(2,)),
            basix.ufl.element("Lagrange", cell, 1),
        ]
    ),
)


def at_points(shape):
    """Values at the quadrature points."""
    e = basix.ufl.quadrature_element(cell, value_shape=shape, degree=degree)
    return FunctionSpace(mesh, e)


dx = Measure("dx", domain=mesh, metadata={"quadrature_degree": degree})
w = Coefficient(W)
s = Coefficient(at_points((4,)))  # xx, yy, zz, xy [Pa]
D = Coefficient(at_points((4, 4)))  # ds / d(strain) [Pa]
K = Constant(mesh)  # bulk modulus [Pa]


def strain(u):
    """xx, yy, zz and twice xy."""
    e = sym(grad(u))
    return as_vector((e[0, 0], e[1, 1], 0, 2 * e[0, 1]))


u1, ub, p = split(w)
v1, vb, q = TestFunctions(W)
du1, dub, dp = TrialFunctions(W)
u, v, du = u1 + ub, v1 + vb, du1 + dub

F = (dot(s, strain(v)) - p * div(v) - q * (div(u) + p / K)) * dx
J = (dot(D * strain(du), strain(v)) - dp * div(v) - q * (div(du) + dp / K)) * dx
forms = [F, J]

points, _ = basix.make_quadrature(basix.CellType.triangle, degree)
expressions = [(strain(u), points)]
