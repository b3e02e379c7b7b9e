# SPDX-License-Identifier: LGPL-3.0-or-later
"""Loads on a boundary: traction, and pressure that follows the surface.

The part of the residual that belongs to one facet of a cell, and the tangent of
the pressure (the traction is taken as dead on the facet's present length).
"""

from mini import W, divergence, gradient, mesh, split, x
from ufl import (
    Constant,
    FacetNormal,
    Measure,
    TestFunctions,
    TrialFunctions,
    dot,
    grad,
)

ds = Measure("ds", domain=mesh, metadata={"quadrature_degree": 2})
n = FacetNormal(mesh)
t = Constant(mesh, shape=(2,))  # traction on the body [Pa]
p_a = Constant(mesh)  # applied pressure, inward positive [Pa]


def residual(axisymmetric):
    """Minus the work of the load on the test function."""
    r = x[0] if axisymmetric else 1
    v, _, _ = split(TestFunctions(W))
    return (p_a * dot(n, v) - dot(t, v)) * r * ds


def tangent(axisymmetric):
    """Change of n da with the motion of the facet."""
    r = x[0] if axisymmetric else 1
    v, _, _ = split(TestFunctions(W))
    du, _, _ = split(TrialFunctions(W))
    growth = divergence(gradient(du, r, axisymmetric))
    return p_a * dot(growth * n - dot(grad(du).T, n), v) * r * ds


R_plane, J_plane = residual(False), tangent(False)
R_axi, J_axi = residual(True), tangent(True)
forms = [R_plane, J_plane, R_axi, J_axi]
