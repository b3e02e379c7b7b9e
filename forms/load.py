# SPDX-License-Identifier: LGPL-3.0-or-later
"""Loads on a boundary: traction, pressure that follows the surface, dashpots.

The part of the residual that belongs to one facet of a cell, and its tangent (the
traction is taken as dead on the facet's present length). Dashpots of impedance
z_p = rho c_p along the normal and z_s = rho c_s across let waves out (Lysmer &
Kuhlemeyer, J. Eng. Mech. Div. ASCE 95, 1969).
"""

from inertia import c_v, v_0
from balance import w
from mini import W, divergence, gradient, mesh, split, x
from ufl import (
    Constant,
    FacetNormal,
    Measure,
    TestFunctions,
    TrialFunction,
    TrialFunctions,
    derivative,
    dot,
    grad,
)
import ufl

ds = Measure("ds", domain=mesh, metadata={"quadrature_degree": 2})
n = FacetNormal(mesh)
t = Constant(mesh, shape=(2,))  # traction on the body [Pa]
p_a = Constant(mesh)  # applied pressure, inward positive [Pa]
z_p = Constant(mesh)  # impedance along the normal [Pa s/m]
z_s = Constant(mesh)  # impedance across [Pa s/m]


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


def dashpots(axisymmetric):
    """Resistance against the velocity at the end of the step."""
    r = x[0] if axisymmetric else 1
    u, _, _ = split(ufl.split(w))
    v, _, _ = split(TestFunctions(W))
    velocity = v_0 + c_v * u
    along = dot(velocity, n) * n
    return dot(z_p * along + z_s * (velocity - along), v) * r * ds


def dashpots_tangent(axisymmetric):
    """Its derivative by the motion of the facet, whose length stays."""
    return derivative(dashpots(axisymmetric), w, TrialFunction(W))


R_plane, J_plane = residual(False), tangent(False)
R_axi, J_axi = residual(True), tangent(True)
R_dashpots_plane, R_dashpots_axi = (dashpots(axi) for axi in (False, True))
J_dashpots_plane, J_dashpots_axi = (dashpots_tangent(axi) for axi in (False, True))
forms = [R_plane, J_plane, R_axi, J_axi]
forms += [R_dashpots_plane, J_dashpots_plane, R_dashpots_axi, J_dashpots_axi]
