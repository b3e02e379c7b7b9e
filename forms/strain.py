# SPDX-License-Identifier: LGPL-3.0-or-later
"""Gradient of the displacement increment, in the middle of a cell and at points.

Evaluated on the mid-step geometry it is Hughes and Winget's increment
G = 2 (f - I)(f + I)^-1; its parts are (xx, xy, yx, yy, zz). The points of layout
`quadrature` feel the bubble, the middle of a cell does not.
"""

import numpy as np
from mini import W, bubble_value, gradient, points, split, x
from ufl import Coefficient
import ufl

w = Coefficient(W)
u, _, u_b = split(ufl.split(w))
centroid = np.array([[1 / 3, 1 / 3]])


def at_points(n, axisymmetric):
    """Nodes and bubble together."""
    r = x[0] if axisymmetric else 1
    bubble = gradient(u_b, r, axisymmetric, bubble_value(n))
    return gradient(u, r, axisymmetric) + bubble, points[n]


expressions = [
    (gradient(u, 1, False), centroid),
    (gradient(u, x[0], True), centroid),
    at_points(3, False),
    at_points(3, True),
    at_points(6, False),
    at_points(6, True),
]
