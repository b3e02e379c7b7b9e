# SPDX-License-Identifier: LGPL-3.0-or-later
"""Momentum and volume of METHOD.md, section 1 (form P), on the MINI element.

    momentum   ∫ (s - p I) : grad v - rho g . v                   = 0
    volume     ∫ q (theta - ln J)  -  ∫ q div u_b                 = 0
    bubble     ∫ 2 mu dev eps(u_b) : eps(v_b)
                 - (dp + lambda p) div v_b - (df + lambda f) . v_b = 0

with f = rho g, and dp, df the increments of the step. The bubble is a Maxwell
element: elastic it sees the increments only (a held load does not creep), in
plastic flow (lambda > 0) the total too (the pressure stays smooth).

In a fluid u_b is the place of the bubble, which the total forces of the step's end
hold it at, and the volume equation takes what it has moved since the start:

    momentum   - ∫ grad p . (grad v u_b)   more: it draws at the nodes
    volume     - ∫ q div (u_b - u_n)
    bubble     dp = p, df = f

The first is the transpose of how grad p, and so the bubble, turns with the nodes.

The laws enter as numbers per cell, with their derivatives for the tangent, which
is Newton's: `derivative` takes care of all that depends on w, so an added term
needs no tangent of its own.
"""

from mini import (
    B,
    W,
    deviator,
    divergence,
    dx,
    dx_bubble,
    gradient,
    mesh,
    per_cell,
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
    as_vector,
    derivative,
    dot,
    inner,
)
import ufl

# State. Tensors are (xx, xy, yx, yy, zz).
w = Coefficient(W)  # u [m], p [Pa] and the bubble at the end of the step
w_n = Coefficient(W)  # at its start: u = 0, p_n, no bubble
s = Coefficient(per_cell(5))  # stress deviator [Pa]
theta = Coefficient(per_cell())  # volume strain that the law needs for p [-]
ln_J = Coefficient(per_cell())  # volume strain of the cell [-]
mu = Coefficient(per_cell())  # shear modulus at the start of the step [Pa]
mu_b = Coefficient(per_cell())  # of the bubble [Pa]
memory = Coefficient(per_cell())  # 1, or 0 of a fluid
u_n = Coefficient(B)  # place of a fluid's bubble at the start of the step [m]
grad_p = Coefficient(per_cell(2))  # of a fluid, at the start of the step [Pa/m]
lam = Coefficient(per_cell())  # plastic flow over the step, 2 G dLambda [-]
rho = Coefficient(per_cell())  # density [kg/m3]
rho_b = Coefficient(per_cell())  # of the bubble [kg/m3]
# Tangent of the laws, by the gradient h of a variation du, and by p.
ds_dh = Coefficient(per_cell(5, 5))  # [Pa]; with geometric stiffness
ds_dp = Coefficient(per_cell(5))  # [-]
dtheta_dh = Coefficient(per_cell(5))  # of theta - ln J, and of the volume [-]
dtheta_dp = Coefficient(per_cell())  # [1/Pa]
dlam_dh = Coefficient(per_cell(5))  # [-]
dlam_dp = Coefficient(per_cell())  # [1/Pa]
g = Constant(mesh, shape=(2,))  # gravity at the end of the step [m/s2]
g_n = Constant(mesh, shape=(2,))  # and at its start
dt = Constant(mesh)  # step [s]


def turned(h, u_b):
    """grad p . (grad v u_b), h the gradient of v."""
    along = as_vector((h[0] * u_b[0] + h[1] * u_b[1], h[2] * u_b[0] + h[3] * u_b[1]))
    return dot(grad_p, along)


def residual(axisymmetric):
    """Virtual work of all forces on the three test functions."""
    r = x[0] if axisymmetric else 1
    u, p, u_b = split(ufl.split(w))
    _, p_n, _ = split(ufl.split(w_n))
    v, q, v_b = split(TestFunctions(W))
    h, h_b, e_b = (gradient(z, r, axisymmetric) for z in (v, v_b, u_b))
    momentum = inner(s, h) - p * divergence(h) - rho * dot(g, v)
    volume = q * (theta - ln_J)
    drive = p - memory * p_n + lam * p
    force = rho_b * (g - memory * g_n + lam * g)
    moved = e_b - gradient(u_n, r, axisymmetric)
    stabilise = (
        2 * mu_b * inner(deviator(strain(e_b)), strain(h_b))
        - drive * divergence(h_b)
        - dot(force, v_b)
        - q * divergence(moved)
        - turned(h, u_b)
    )
    return (momentum + volume) * r * dx + stabilise * r * dx_bubble


def tangent(axisymmetric):
    """Derivative of the residual by u, p and the bubble."""
    r = x[0] if axisymmetric else 1
    R = residual(axisymmetric)
    du, dp, _ = split(TrialFunctions(W))
    _, _, v_b = split(TestFunctions(W))
    dh = gradient(du, r, axisymmetric)
    dtheta = dot(dtheta_dh, dh) + dtheta_dp * dp
    dlam = dot(dlam_dh, dh) + dlam_dp * dp
    return (
        derivative(R, w, TrialFunction(W))
        - turned(dh, v_b) * r * dx_bubble
        + derivative(R, s, ds_dh * dh + ds_dp * dp)
        + derivative(R, theta, dtheta)
        + derivative(R, lam, dlam)
    )


def bubble_columns(axisymmetric):
    """The tangent's last two columns, all that a residual alone needs."""
    u_b = TrialFunction(B)
    direction = as_vector((0, 0, 0, u_b[0], u_b[1]))
    return derivative(residual(axisymmetric), w, direction)


R_plane, J_plane, B_plane = (f(False) for f in (residual, tangent, bubble_columns))
R_axi, J_axi, B_axi = (f(True) for f in (residual, tangent, bubble_columns))
forms = [R_plane, J_plane, B_plane, R_axi, J_axi, B_axi]
