# SPDX-License-Identifier: LGPL-3.0-or-later
"""gmsh's optimisers of plane triangle meshes, through the C functions of the
library that the gmsh program itself uses. Only the study loads it."""

import ctypes
import glob
import time

import numpy as np

_double = ctypes.POINTER(ctypes.c_double)
_size = ctypes.POINTER(ctypes.c_size_t)
_int = ctypes.POINTER(ctypes.c_int)


def _library():
    """libgmsh as Debian and the wheel name it, None where there is none."""
    names = ["libgmsh.so"] + [
        name
        for folder in ("/usr/lib/*", "/usr/local/lib", "/opt/*/lib")
        for name in sorted(glob.glob(f"{folder}/libgmsh.so*"), reverse=True)
    ]
    for name in names:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    return None


class Gmsh:
    """One gmsh session with one mesh; every boundary node is a point of the
    geometry, so that the boundary is fixed as gmsh does it."""

    def __init__(self):
        self.lib = _library()
        if self.lib is None:
            raise RuntimeError("libgmsh was not found; it comes with gmsh")
        self._call("Initialize", 0, None, 0, 0)
        self._call("OptionSetNumber", b"General.Terminal", ctypes.c_double(0))
        self._call("OptionSetNumber", b"Mesh.Renumber", ctypes.c_double(0))

    def version(self):
        out = ctypes.c_char_p()
        self._call("OptionGetString", b"General.Version", ctypes.byref(out))
        return out.value.decode()

    def _call(self, name, *arguments):
        error = ctypes.c_int()
        out = getattr(self.lib, "gmsh" + name)(*arguments, ctypes.byref(error))
        if error.value:
            raise RuntimeError(f"gmsh{name}: error {error.value}")
        return out

    def load(self, x, cells):
        """A mesh in the plane.

        x      nodes, shape (n, 2)
        cells  counter-clockwise, shape (m, 3)
        """
        self._call("Clear")
        self._call("ModelAdd", b"mesh")
        loops = boundary_loops(cells)
        d = ctypes.c_double
        curves = []
        for loop in loops:
            for i in loop:
                self._call(
                    "ModelGeoAddPoint", d(x[i, 0]), d(x[i, 1]), d(0), d(0), int(i) + 1
                )
            lines = [
                self._call("ModelGeoAddLine", int(a) + 1, int(b) + 1, -1)
                for a, b in zip(loop, np.roll(loop, -1))
            ]
            array = (ctypes.c_int * len(lines))(*lines)
            curves.append(
                self._call(
                    "ModelGeoAddCurveLoop", array, ctypes.c_size_t(len(lines)), -1, 0
                )
            )
        array = (ctypes.c_int * len(curves))(*curves)
        surface = self._call(
            "ModelGeoAddPlaneSurface", array, ctypes.c_size_t(len(curves)), -1
        )
        self._call("ModelGeoSynchronize")
        outer = np.zeros(len(x), bool)
        outer[np.concatenate(loops)] = True
        for i in np.flatnonzero(outer):
            self._nodes(0, i, x, [i])
        self.inner = np.flatnonzero(~outer)
        self._nodes(2, surface - 1, x, self.inner)
        tags = np.ascontiguousarray(cells.ravel() + 1, dtype=np.uint64)
        self._call(
            "ModelMeshAddElementsByType",
            surface,
            2,
            None,
            ctypes.c_size_t(0),
            tags.ctypes.data_as(_size),
            ctypes.c_size_t(len(tags)),
        )
        self.x = x.copy()
        self.surface = surface

    def _nodes(self, dim, entity, x, which):
        """Add nodes to an entity, in the plane with their parameters."""
        which = np.asarray(which)
        xyz = np.zeros((len(which), 3))
        xyz[:, :2] = x[which]
        tags = np.ascontiguousarray(which + 1, dtype=np.uint64)
        parameters, number = None, ctypes.c_size_t(0)
        if dim == 2:
            parameters = _double()
            self._call(
                "ModelGetParametrization",
                2,
                int(entity) + 1,
                xyz.ctypes.data_as(_double),
                ctypes.c_size_t(xyz.size),
                ctypes.byref(parameters),
                ctypes.byref(number),
            )
        self._call(
            "ModelMeshAddNodes",
            dim,
            int(entity) + 1,
            tags.ctypes.data_as(_size),
            ctypes.c_size_t(len(tags)),
            xyz.ctypes.data_as(_double),
            ctypes.c_size_t(xyz.size),
            parameters,
            number,
        )
        if parameters is not None:
            self.lib.gmshFree(parameters)

    def optimise(self, method, iterations):
        """One call of an optimiser; the processor's seconds."""
        begin = time.process_time()
        self._call(
            "ModelMeshOptimize",
            method.encode(),
            0,
            int(iterations),
            None,
            ctypes.c_size_t(0),
        )
        return time.process_time() - begin

    def nodes(self):
        """Where the nodes are, shape (n, 2)."""
        tags, xyz, parameters = _size(), _double(), _double()
        sizes = [ctypes.c_size_t() for _ in range(3)]
        self._call(
            "ModelMeshGetNodes",
            ctypes.byref(tags),
            ctypes.byref(sizes[0]),
            ctypes.byref(xyz),
            ctypes.byref(sizes[1]),
            ctypes.byref(parameters),
            ctypes.byref(sizes[2]),
            2,
            self.surface,
            0,
            0,
        )
        n = sizes[0].value
        out = self.x.copy()
        at = np.ctypeslib.as_array(tags, (n,)).astype(int) - 1
        out[at] = np.ctypeslib.as_array(xyz, (n, 3))[:, :2]
        for pointer in (tags, xyz, parameters):
            self.lib.gmshFree(pointer)
        return out


def boundary_loops(cells):
    """Closed rows of boundary nodes, the body on the left."""
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    known = {(int(a), int(b)) for a, b in edges}
    after = {a: b for a, b in known if (b, a) not in known}
    loops = []
    while after:
        first = next(iter(after))
        loop = [first]
        while (node := after.pop(loop[-1])) != first:
            loop.append(node)
        loops.append(np.array(loop))
    return loops
