# SPDX-License-Identifier: LGPL-3.0-or-later
"""Read with VTK what test_polygons wrote, as ParaView will."""

import sys
from pathlib import Path

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read(file):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    assert reader.GetErrorCode() == 0, file
    return reader.GetOutput()


folder = Path(sys.argv[1])
data = read(folder / "polygons.vtp")
third = 1 / 3
corners = [
    [(0, 0), (third, 0), (0, third)],
    [(1, 1), (1 + third, 1), (1 + third, 1.5), (1, 1.5)],
]
assert data.GetNumberOfCells() == 2
for i, expected in enumerate(corners):
    points = data.GetCell(i).GetPoints()
    found = [points.GetPoint(k) for k in range(points.GetNumberOfPoints())]
    assert found == [(*p, 0) for p in expected], found
arrays = data.GetCellData()
assert list(vtk_to_numpy(arrays.GetArray("cell"))) == [7, 123456789]
assert list(vtk_to_numpy(arrays.GetArray("share"))) == [0.1, 1e-300]
assert read(folder / "none.vtp").GetNumberOfCells() == 0
