# SPDX-License-Identifier: LGPL-3.0-or-later
"""Momentum and volume of METHOD.md, section 1, in layout `quadrature`.

    momentum   ∫ (s - p I) : grad (v + v_b) - rho g . (v + v_b)   = 0
    volume     ∫ q (theta - ln J)                                 = 0

The strain of a point includes the bubble, so the bubble stands in the laws'
answers; it has an equation of its own, the first with v_b, and is condensed. In
that equation an elastic spring of a small share of the cell's shear stiffness holds
the step's bubble: ideally plastic points alone cannot carry any gradient of p.
"""

from mini import (
    W,
    bubble_value,
    deviator,
    divergence,
    dx_points,
    gradient,
    mesh,
    per_cell,
    per_point,
    split,
    strain,
    x,
)
from ufl import (
    Coefficient,
    Constant,
    TestFunctions,
    TrialFunction,
    TrialFunctions,
    derivative,
    dot,
    inner,
)
import ufl

w = Coefficient(W)  # u [m], p [Pa] and the bubble at the end of the step
rho = Coefficient(per_cell())  # density [kg/m3]
mu = Coefficient(per_cell())  # shear modulus at the start of the step [Pa]
spring = Constant(mesh)  # share of it that always holds the bubble [-]
g = Constant(mesh, shape=(2,))  # gravity at the end of the step [m/s2]


class Laws:
    """The laws' answers at n points; names as in balance.py."""

    def __init__(self, n):
        self.s = Coefficient(per_point(n, 5))  # [Pa]
        self.excess = Coefficient(per_point(n))  # theta - ln J [-]
        self.ds_dh = Coefficient(per_point(n, 5, 5))  # [Pa]
        self.ds_dp = Coefficient(per_point(n, 5))  # [-]
        self.dtheta_dh = Coefficient(per_point(n, 5))  # [-]
        self.dtheta_dp = Coefficient(per_point(n))  # [1/Pa]


def residual(axisymmetric, n, laws):
    """Virtual work of all forces on the test functions."""
    r = x[0] if axisymmetric else 1
    _, p, u_b = split(ufl.split(w))
    v, q, v_b = split(TestFunctions(W))
    k = bubble_value(n)
    h_b, e_b = (gradient(z, r, axisymmetric, k) for z in (v_b, u_b))
    h = gradient(v, r, axisymmetric) + h_b
    momentum = inner(laws.s, h) - p * divergence(h) - rho * dot(g, v + k * v_b)
    held = 2 * spring * mu * inner(deviator(strain(e_b)), strain(h_b))
    return (momentum + held + q * laws.excess) * r * dx_points(n)


def tangent(axisymmetric, n, laws):
    """Derivative of the residual by u, p and the bubble."""
    r = x[0] if axisymmetric else 1
    R = residual(axisymmetric, n, laws)
    du, dp, du_b = split(TrialFunctions(W))
    dh = gradient(du, r, axisymmetric)
    dh += gradient(du_b, r, axisymmetric, bubble_value(n))
    return (
        derivative(R, w, TrialFunction(W))
        + derivative(R, laws.s, laws.ds_dh * dh + laws.ds_dp * dp)
        + derivative(R, laws.excess, dot(laws.dtheta_dh, dh) + laws.dtheta_dp * dp)
    )


# FFCx finds coefficients and forms by their names here: s_3, R_3_plane, ...
forms = []
for n in (3, 6):
    laws = Laws(n)
    globals().update({f"{name}_{n}": c for name, c in vars(laws).items()})
    made = {
        f"{letter}_{n}_{name}": operator(axisymmetric, n, laws)
        for name, axisymmetric in (("plane", False), ("axi", True))
        for letter, operator in (("R", residual), ("J", tangent))
    }
    globals().update(made)
    forms += made.values()
