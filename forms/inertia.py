# SPDX-License-Identifier: LGPL-3.0-or-later
"""What dynamics adds to a cell: the bubble's inertia, and viscous damping.

The nodes' own inertia is lumped and stands outside of the forms. Newmark gives
acceleration, velocity and pressure rate at the end of the step as lines,

    a = a_0 + c_a u,    v = v_0 + c_v u,    dp/dt = r_0 + c_r p.

    bubble, layout mean         rho (a - a_n + lambda a + c_a u_b) . v_b
                                (of a fluid without a_n, and of the acceleration
                                that the forces of the step's end give alone)
    damping                     b (2 mu dev D(v) - dp/dt I) : grad v

The bubbles of layout `quadrature` have none. They hold a stress from step to step
but no velocity, and the lumped nodes do not feel them: forces on the bubble alone
would give it energy that nothing has lost.
"""

from balance import dlam_dh, dlam_dp, lam, memory, mu, rho_b, w
from mini import (
    B,
    V,
    W,
    deviator,
    divergence,
    dx,
    dx_bubble,
    gradient,
    mesh,
    per_cell,
    Q,
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

a_0 = Coefficient(V)  # acceleration at the end, had the step no motion [m/s2]
a_n = Coefficient(V)  # acceleration at the start [m/s2]
to_end = Coefficient(per_cell())  # of a: 1, or of a fluid 1 / (1 + alpha) [-]
v_0 = Coefficient(V)  # velocity, likewise [m/s]
r_0 = Coefficient(Q)  # rate of p, likewise [Pa/s]
c_a = Constant(mesh)  # [1/s2]
c_v = Constant(mesh)  # [1/s]
c_r = Constant(mesh)  # [1/s]
b = Constant(mesh)  # stiffness-proportional damping [s]


def bubble_mean(axisymmetric):
    """Increments, like the other forces on the bubble of layout `mean`."""
    r = x[0] if axisymmetric else 1
    u, _, u_b = split(ufl.split(w))
    _, _, v_b = split(TestFunctions(W))
    a = to_end * (a_0 + c_a * u)
    return rho_b * dot(a - memory * a_n + lam * a + c_a * u_b, v_b) * r * dx_bubble


def damping(axisymmetric):
    """Rayleigh's part in proportion to the elastic stiffness."""
    r = x[0] if axisymmetric else 1
    u, p, _ = split(ufl.split(w))
    v, _, _ = split(TestFunctions(W))
    h = gradient(v, r, axisymmetric)
    rate = strain(gradient(v_0 + c_v * u, r, axisymmetric))
    viscous = 2 * mu * inner(deviator(rate), strain(h))
    return b * (viscous - (r_0 + c_r * p) * divergence(h)) * r * dx


def tangent(R, axisymmetric):
    """Derivative by u, p and the bubble, also through the plastic flow."""
    r = x[0] if axisymmetric else 1
    du, dp, _ = split(TrialFunctions(W))
    dlam = dot(dlam_dh, gradient(du, r, axisymmetric)) + dlam_dp * dp
    return derivative(R, w, TrialFunction(W)) + derivative(R, lam, dlam)


def bubble_columns(R):
    """The tangent's last two columns."""
    u_b = TrialFunction(B)
    return derivative(R, w, as_vector((0, 0, 0, u_b[0], u_b[1])))


def operators(axisymmetric, name):
    """All forms for one symmetry, by their names."""
    mean, damped = bubble_mean(axisymmetric), damping(axisymmetric)
    made = {"R": mean, "J": tangent(mean, axisymmetric), "B": bubble_columns(mean)}
    made["R_damping"] = damped
    made["J_damping"] = derivative(damped, w, TrialFunction(W))
    return {f"{key}_{name}": form for key, form in made.items()}


# FFCx finds the forms by their names here: R_plane, R_damping_plane, ...
globals().update(operators(False, "plane"), **operators(True, "axi"))
forms = [form for key, form in globals().items() if key[:2] in ("R_", "J_", "B_")]
