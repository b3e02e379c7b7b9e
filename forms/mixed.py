# SPDX-License-Identifier: LGPL-3.0-or-later
"""Balance of cells that several materials share (METHOD.md, Mixed cells).

Void bears nothing: p and q count where the rest of the cell has its middle, and so
do weight and mass where the mass has its own. A free surface within a cell is then
where it is: a fluid at rest under p = rho g depth is in balance wherever its surface
cuts the cells. The bubble is that of a full cell: it holds ∇p to ρ (g - a) at nodes in
the void, of which a small piece of a body knows little.
"""

from balance import (  # noqa: F401; FFCx finds coefficients by their names here
    bubble_columns,
    dlam_dh,
    dlam_dp,
    ds_dh,
    ds_dp,
    dtheta_dh,
    dtheta_dp,
    dt,
    g,
    g_n,
    grad_p,
    lam,
    ln_J,
    memory,
    mu,
    mu_b,
    residual,
    rho,
    rho_b,
    s,
    tangent,
    theta,
    u_n,
    w,
    w_n,
)
from mini import per_cell
from ufl import Coefficient, dot, grad

fill = Coefficient(per_cell())  # share of the volume that bears load [-]
offset = Coefficient(per_cell(2))  # of its middle from the cell's [m]
mass_offset = Coefficient(per_cell(2))  # of the mass's [m]
mean_rho = Coefficient(per_cell())  # density of the whole cell [kg/m3]
kept = Coefficient(per_cell())  # 1, or next to 0 where nothing bears load [-]


def at(f):
    """A linear function in the middle of what bears load."""
    return f + dot(grad(f), offset)


def weight(v):
    """Work of the weight, in the middle of the mass."""
    return mean_rho * dot(g, v + dot(grad(v), mass_offset))


shared = (fill, at, weight, kept)
R_plane, J_plane, B_plane = (
    f(False, *shared) for f in (residual, tangent, bubble_columns)
)
R_axi, J_axi, B_axi = (f(True, *shared) for f in (residual, tangent, bubble_columns))
forms = [R_plane, J_plane, B_plane, R_axi, J_axi, B_axi]
