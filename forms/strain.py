# SPDX-License-Identifier: LGPL-3.0-or-later
"""Gradient of the displacement increment in the middle of a cell.

Evaluated on the mid-step geometry it is Hughes and Winget's increment
G = 2 (f - I)(f + I)^-1; its parts are (xx, xy, yx, yy, zz).
"""

import numpy as np
from mini import W, gradient, split, x
from ufl import Coefficient
import ufl

w = Coefficient(W)
u, _, _ = split(ufl.split(w))
centroid = np.array([[1 / 3, 1 / 3]])

expressions = [
    (gradient(u, 1, False), centroid),
    (gradient(u, x[0], True), centroid),
]
