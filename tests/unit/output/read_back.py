# SPDX-License-Identifier: LGPL-3.0-or-later
"""Read with VTK what test_fields wrote, as ParaView will, and compare it with
the formulae that test_fields states."""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import (
    vtkXMLPUnstructuredGridReader,
    vtkXMLUnstructuredGridReader,
)


def read(file):
    parallel = file.suffix == ".pvtu"
    reader = (
        vtkXMLPUnstructuredGridReader() if parallel else vtkXMLUnstructuredGridReader()
    )
    reader.SetFileName(str(file))
    reader.Update()
    assert reader.GetErrorCode() == 0, file
    return reader.GetOutput()


def arrays(data):
    return {
        data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
        for i in range(data.GetNumberOfArrays())
    }


def ghost(data):
    """Mask of the entries that another piece owns."""
    kind = data.GetGhostArray()
    return np.zeros(0, bool) if kind is None else vtk_to_numpy(kind) != 0


def check(grid, t):
    x = vtk_to_numpy(grid.GetPoints().GetData())
    nodal = arrays(grid.GetPointData())
    cell = arrays(grid.GetCellData())
    assert {"p", "velocity"} <= nodal.keys(), nodal.keys()
    assert {"density", "stress"} <= cell.keys(), cell.keys()

    # The motion turns the right edge x = 2 (y in 0..1) to y - 0.4 t.
    assert np.isclose(x[:, 1].min(), -0.4 * t)
    assert np.isclose(x[:, 0].max(), 2 + 0.2 * t)
    assert np.all(x[:, 2] == 0)
    # test_fields took the places of t = 0.
    v = nodal["velocity"]
    start = x - t * v
    np.testing.assert_allclose(nodal["p"], 3 + start[:, 0] + t, rtol=1e-12)
    np.testing.assert_allclose(v[:, 1], -0.2 * start[:, 0], atol=1e-14)
    np.testing.assert_allclose(v[:, 0], 0.1 * start[:, 0] * start[:, 1], atol=1e-14)

    corners = np.array(
        [
            [grid.GetCell(c).GetPointId(i) for i in range(3)]
            for c in range(grid.GetNumberOfCells())
        ]
    )
    middle = start[corners].mean(axis=1)
    np.testing.assert_allclose(
        cell["density"], middle[:, 0] + 10 * middle[:, 1], rtol=1e-12
    )
    mx, my = middle[:, 0], middle[:, 1]
    zero = np.zeros_like(mx)
    tensor = np.column_stack(
        [mx, mx * my, zero, mx * my, my, zero, zero, zero, t + zero]
    )
    np.testing.assert_allclose(cell["stress"], tensor, atol=1e-13)

    # Cells counted once fill the moved body, whose sides stay straight: the
    # integral of the Jacobian 1 + 0.1 t y + 0.02 t^2 x over [0, 2] x [0, 1].
    own = ~ghost(grid.GetCellData()) if grid.GetCellGhostArray() else slice(None)
    a, b, c = (x[corners[own][:, i]] for i in range(3))
    area = (
        0.5
        * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()
    )
    exact = 2 + 0.1 * t + 0.04 * t**2
    return area, exact


def main(folder):
    root = ElementTree.parse(folder / "fields.pvd").getroot()
    sets = root.findall("./Collection/DataSet")
    assert [float(s.get("timestep")) for s in sets] == [0.0, 0.5, 1.0]
    for s in sets:
        t = float(s.get("timestep"))
        area, exact = check(read(folder / s.get("file")), t)
        print(f"t = {t}: area {area:.6f}, body {exact:.6f}")
        assert np.isclose(area, exact, rtol=1e-12)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
