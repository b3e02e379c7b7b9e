# SPDX-License-Identifier: LGPL-3.0-or-later
"""Flow of pore water (METHOD.md, Water): the row of the nodal pore pressure p_w.

    ∫ r [ theta + stored ] + dt k/gamma_w ∇r . (∇p_w - rho_f (g - a))       = 0

with p_w, g, a at the end of the step, or weighted with those at its start.

theta is the skeleton's volume strain over the step, stored what water and grains
give way by, k/gamma_w the mobility; a is the skeleton's acceleration (u-p: the
water's own relative one is left out).

Storage is lumped, and so is that of the skeleton: theta sees the cell's mean of p_w,
a mass matrix of one point that lets nodes swing in short steps. With the skeleton's
uniaxial compliance c under a held total stress, and of a P1 function

    ∫ lumped - one point  =  ∫ ∇r . H ∇dp_w,   H = 1/3 sum (x_a - x)(x_a - x)^T,

c H is what a permeability would be that drains a cell's size at each change of load.
It moves water from node to node of a cell. Water that weight and inertia press upon
has a gradient of its own in no time, `share` of rho (g - a): that is no reason to
flow. With consistent storage, for comparison, c = 0 and `C` is added.
"""

from balance import (  # noqa: F401; FFCx finds coefficients by their names here
    dlam_dp,
    ds_dp,
    dt,
    dtheta_dh,
    dtheta_dp,
    g,
    g_n,
    grad_p,
    lam,
    ln_J,
    memory,
    mu_b,
    residual,
    rho,
    rho_b,
    s,
    theta,
    u_n,
    w,
    w_n,
)
from inertia import a_0, a_n, bubble_mean, c_a, to_end  # noqa: F401
from mini import Q, W, divergence, dx, gradient, mesh, per_cell, split, x
from ufl import (
    Coefficient,
    Constant,
    Measure,
    TestFunction,
    TrialFunction,
    TrialFunctions,
    derivative,
    dot,
    grad,
)
import ufl

dx_nodes = Measure(
    "dx",
    domain=mesh,
    subdomain_id=3,
    metadata={"quadrature_rule": "vertex", "quadrature_degree": 1},
)
dx_exact = Measure("dx", domain=mesh, subdomain_id=4, metadata={"quadrature_degree": 3})

p_w = Coefficient(Q)  # pore pressure at the end of the step [Pa]
p_w_n = Coefficient(Q)  # at its start
stored = Coefficient(Q)  # by water and grains, at the nodes [-]
dstored_dp = Coefficient(Q)  # [1/Pa]
compliance = Coefficient(per_cell())  # of the skeleton, uniaxial [1/Pa]
mobility = Coefficient(per_cell())  # k / gamma_w [m2/(Pa s)]
size = Coefficient(per_cell(2, 2))  # H [m2]
share = Coefficient(per_cell())  # of water in the stiffness of the whole [-]
radius = Coefficient(per_cell())  # of the middle of the cell; 1 in the plane
rho_f = Constant(mesh)  # density of the water [kg/m3]
end = Constant(mesh)  # weight of the end of the step in the flow [-]


def flow(axisymmetric):
    """Water that a node's surroundings cannot take: volume."""
    r = x[0] if axisymmetric else 1
    z = TestFunction(Q)
    u, _, _ = split(ufl.split(w))
    a_1 = a_0 + c_a * u
    a = end * a_1 + (1 - end) * a_n
    head = grad(end * p_w + (1 - end) * p_w_n)
    weight = rho_f * (end * g + (1 - end) * g_n - a)
    pressed = share * rho * ((g - a_1) - (g_n - a_n))
    jump = compliance * dot(size, grad(p_w - p_w_n) - pressed)
    return (
        z * theta * r * dx
        + z * stored * radius * dx_nodes
        + dot(grad(z), dt * mobility * (head - weight) + jump) * r * dx
    )


def by_pore_pressure(axisymmetric):
    """Derivative of the flow; theta falls with p' = p - p_w."""
    R, dp = flow(axisymmetric), TrialFunction(Q)
    return (
        derivative(R, p_w, dp)
        + derivative(R, stored, dstored_dp * dp)
        + derivative(R, theta, -dtheta_dp * dp)
    )


def by_nodes(axisymmetric):
    """Derivative of the flow by u and p; the bubble has no part in it."""
    r = x[0] if axisymmetric else 1
    R = flow(axisymmetric)
    du, dp, _ = split(TrialFunctions(W))
    dh = gradient(du, r, axisymmetric)
    # dtheta_dh is that of theta - ln J and its volume: ln J and its volume
    dtheta = dot(dtheta_dh, dh) + (1 + ln_J) * divergence(dh) + dtheta_dp * dp
    return derivative(R, w, TrialFunction(W)) + derivative(R, theta, dtheta)


def of_momentum(R):
    """Derivative of a mechanical residual by p_w, through the law's answers."""
    dp = TrialFunction(Q)
    return (
        derivative(R, s, -ds_dp * dp)
        + derivative(R, theta, -dtheta_dp * dp)
        + derivative(R, lam, -dlam_dp * dp)
    )


def of_bubble(R):
    """The same through the plastic flow alone."""
    return derivative(R, lam, -dlam_dp * TrialFunction(Q))


def consistent(axisymmetric):
    """What consistent storage has and lumped has not."""
    r = x[0] if axisymmetric else 1
    z = TestFunction(Q)
    return z * stored * r * dx_exact - z * stored * radius * dx_nodes


def consistent_slope(axisymmetric):
    """Its derivative."""
    R, dp = consistent(axisymmetric), TrialFunction(Q)
    return derivative(R, stored, dstored_dp * dp)


def operators(axisymmetric, name):
    """All forms for one symmetry, by their names."""
    made = {
        "R": flow(axisymmetric),
        "J": by_pore_pressure(axisymmetric),
        "U": by_nodes(axisymmetric),
        "M": of_momentum(residual(axisymmetric)),
        "B": of_bubble(bubble_mean(axisymmetric)),
        "R_consistent": consistent(axisymmetric),
        "J_consistent": consistent_slope(axisymmetric),
    }
    return {f"{key}_{name}": form for key, form in made.items()}


# FFCx finds the forms by their names here: R_plane, J_plane, ...
made = {**operators(False, "plane"), **operators(True, "axi")}
globals().update(made)
forms = list(made.values())
