# SPDX-License-Identifier: LGPL-3.0-or-later
"""Gradient of the displacement increment, in the middle of a cell and at points.

Evaluated on the mid-step geometry it is Hughes and Winget's increment
G = 2 (f - I)(f + I)^-1; its parts are (xx, xy, yx, yy, zz). The points of layout
`quadrature` feel the bubble, the middle of a cell does not.
"""

import numpy as np
from mini import W, gradient, points, split, x
from ufl import Coefficient
import ufl

w = Coefficient(W)
u, _, u_b = split(ufl.split(w))
centroid = np.array([[1 / 3, 1 / 3]])

expressions = [
    (gradient(u, 1, False), centroid),
    (gradient(u, x[0], True), centroid),
    (gradient(u + u_b, 1, False), points[3]),
    (gradient(u + u_b, x[0], True), points[3]),
    (gradient(u + u_b, 1, False), points[6]),
    (gradient(u + u_b, x[0], True), points[6]),
]
