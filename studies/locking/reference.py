# SPDX-License-Identifier: LGPL-3.0-or-later
"""Cook's membrane by an element that is not MMALE's, for run.py's references.

Taylor-Hood triangles (P2 displacement, continuous P1 pressure), small strain,
plane strain, E = 1, load 1: s = 2 mu sym grad u, p = -lambda div u. Needs SciPy,
which MMALE's environment does not have; its answers are kept in run.py.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

CORNERS = np.array([[0, 0], [48, 44], [48, 60], [0, 44]], dtype=float)
# quadrature of degree 4 on the reference triangle
_A, _B = 0.445948490915965, 0.091576213509771
POINTS = [
    (a, a) if i == 0 else (a, 1 - 2 * a) if i == 1 else (1 - 2 * a, a)
    for a in (_A, _B)
    for i in range(3)
]
WEIGHTS = [0.111690794839005] * 3 + [0.054975871827661] * 3


def grid(n):
    """Vertices and middles of edges on a (2n + 1)^2 lattice, bilinear map."""
    s = np.linspace(0, 1, 2 * n + 1)
    xi, eta = np.meshgrid(s, s)
    shape = [(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta]
    x = sum(N[..., None] * c for N, c in zip(shape, CORNERS)).reshape(-1, 2)

    def at(i, j):
        return j * (2 * n + 1) + i

    cells = []
    for j in range(0, 2 * n, 2):
        for i in range(0, 2 * n, 2):
            a, b, c, d = at(i, j), at(i + 2, j), at(i + 2, j + 2), at(i, j + 2)
            m = at(i + 1, j + 1)
            cells.append([a, b, d, m, at(i, j + 1), at(i + 1, j)])
            cells.append([b, c, d, at(i + 1, j + 2), m, at(i + 2, j + 1)])
    return x, np.array(cells), at


def solve(n, nu):
    """Displacement v at (48, 52) and (48, 60)."""
    x, cells, at = grid(n)
    mu, lam = 1 / (2 * (1 + nu)), nu / ((1 + nu) * (1 - 2 * nu))
    a, b, c = (x[cells[:, i]] for i in range(3))
    J = np.stack([b - a, c - a], axis=2)
    det = np.linalg.det(J)
    inverse = np.linalg.inv(J)
    K = np.zeros((len(cells), 15, 15))
    for (r, s), weight in zip(POINTS, WEIGHTS):
        L = np.array([1 - r - s, r, s])
        dL = np.array([[-1, -1], [1, 0], [0, 1]], dtype=float)
        # vertices, then the middles opposite to them
        grad = [(4 * L[i] - 1) * dL[i] for i in range(3)]
        grad += [4 * (L[(i + 1) % 3] * dL[(i + 2) % 3]) for i in range(3)]
        for i in range(3):
            grad[3 + i] = grad[3 + i] + 4 * L[(i + 2) % 3] * dL[(i + 1) % 3]
        g = np.einsum("nd,edk->enk", np.array(grad), inverse)
        w = weight * det
        for i in range(2):
            for j in range(2):
                block = np.einsum("en,em,e->enm", g[..., j], g[..., i], w)
                if i == j:
                    block = block + np.einsum("enk,emk,e->enm", g, g, w)
                K[:, i:12:2, j:12:2] += mu * block
        for i in range(2):
            coupling = -np.einsum("en,m,e->enm", g[..., i], L, w)
            K[:, i:12:2, 12:] += coupling
            K[:, 12:, i:12:2] += coupling.transpose(0, 2, 1)
        K[:, 12:, 12:] -= np.einsum("n,m,e->enm", L, L, w) / lam
    nodes = len(x)
    dofs = np.empty((len(cells), 15), dtype=int)
    dofs[:, 0:12:2], dofs[:, 1:12:2] = 2 * cells, 2 * cells + 1
    dofs[:, 12:] = 2 * nodes + cells[:, :3]
    rows, columns = np.repeat(dofs, 15, axis=1), np.tile(dofs, (1, 15))
    A = sp.csc_matrix((K.ravel(), (rows.ravel(), columns.ravel())), (3 * nodes,) * 2)
    load = np.zeros(3 * nodes)
    for j in range(0, 2 * n, 2):  # Simpson on each loaded edge
        for k, share in ((j, 1 / 6), (j + 1, 4 / 6), (j + 2, 1 / 6)):
            load[2 * at(2 * n, k) + 1] += share / n
    left = np.array([at(0, j) for j in range(2 * n + 1)])
    pressure = np.unique(cells[:, :3])
    held = np.ones(3 * nodes, dtype=bool)
    held[: 2 * nodes] = False
    held[2 * nodes + pressure] = False
    held[2 * left] = held[2 * left + 1] = True
    free = np.flatnonzero(~held)
    answer = np.zeros(3 * nodes)
    answer[free] = splu(A[free][:, free]).solve(load[free])
    return answer[2 * at(2 * n, n) + 1], answer[2 * at(2 * n, 2 * n) + 1]


def main():
    for nu in (0.3, 1 / 3, 0.49, 0.4999, 0.499999):
        v = [solve(n, nu)[0] for n in (24, 48, 96)]
        ratio = (v[1] - v[0]) / (v[2] - v[1])
        limit = v[2] + (v[2] - v[1]) / (ratio - 1)
        print(f"{nu:.6f}", *(f"{value:.5f}" for value in v), f"limit {limit:.4f}")


if __name__ == "__main__":
    main()
