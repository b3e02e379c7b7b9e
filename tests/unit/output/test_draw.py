# SPDX-License-Identifier: LGPL-3.0-or-later
"""draw.py on runs made up here: a block pushed in by a punch."""

import contextlib
import io
import json
import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "cpp" / "output"))
import draw  # noqa: E402
import draw_charts  # noqa: E402
import draw_domains  # noqa: E402
import draw_fields  # noqa: E402
import draw_sheet  # noqa: E402
import read_run  # noqa: E402


def block(n, t):
    """A billet of 1 x 1.5, its nodes moved as under a punch, and fields."""
    m = n * 3 // 2
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1.5, m + 1))
    start = np.stack([x.ravel(), y.ravel()], axis=1)
    i = np.arange(n * m) // n * (n + 1) + np.arange(n * m) % n
    cells = np.concatenate(
        [
            np.stack([i, i + 1, i + n + 2], axis=1),
            np.stack([i, i + n + 2, i + n + 1], axis=1),
        ]
    )
    depth = np.exp(2 * (start[:, 1] - 1.5))
    side = np.tanh(8 * (start[:, 0] - 0.5))
    v = np.stack([0.6 * np.sin(np.pi * start[:, 0]) * (1 - depth) * depth, side], 1)
    v[:, 1] *= depth * start[:, 1]
    points = start + 0.6 * t * v
    middle = start[cells].mean(axis=1)
    far = np.hypot(middle[:, 0] - 0.5, middle[:, 1] - 1.5)
    stress = np.zeros((len(cells), 9))
    stress[:, 1] = stress[:, 3] = 2.0  # pure shear: von Mises 2 sqrt(3)
    return (
        points,
        cells,
        {"p": 1e3 * start[:, 0], "velocity": np.pad(v, ((0, 0), (0, 1)))},
        {"plastic_strain": t * 8 * np.exp(-4 * far), "stress": stress},
    )


def array(name, values, kind="Float64"):
    values = np.asarray(values)
    width = values.shape[1] if values.ndim > 1 else 1
    text = " ".join(f"{v:.17g}" for v in values.ravel())
    named = f' Name="{name}"' if name else ""
    wide = f' NumberOfComponents="{width}"' if width > 1 else ""
    return f'<DataArray type="{kind}"{named} format="ascii"{wide}>{text}</DataArray>'


def write_vtu(file, points, cells, nodal, cell, ids, ghost):
    parts = [
        "<Points>",
        array(None, np.pad(points, ((0, 0), (0, 1)))),
        "</Points><Cells>",
        array("connectivity", cells, "Int32"),
        array("offsets", 3 * np.arange(1, len(cells) + 1), "Int32"),
        array("types", np.full(len(cells), 5), "Int8"),
        "</Cells><CellData>",
        array("vtkGhostType", ghost, "UInt8"),
        *[array(*pair) for pair in cell.items()],
        "</CellData><PointData>",
        array("vtkOriginalPointIds", ids, "Int64"),
        *[array(*pair) for pair in nodal.items()],
        "</PointData>",
    ]
    file.write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
        f"<Piece>{''.join(parts)}</Piece></UnstructuredGrid></VTKFile>"
    )


def write_output(folder, k, t, pieces, n=10):
    """One output, cut into overlapping pieces at x = 0.5."""
    points, cells, nodal, cell = block(n, t)
    if pieces == 1:
        ids = np.arange(len(points))
        file = folder / f"fields{k:06}.vtu"
        write_vtu(file, points, cells, nodal, cell, ids, np.zeros(len(cells)))
        return file.name
    left = points[cells][:, :, 0].mean(axis=1) < 0.5
    names = []
    for r, own in enumerate((left, ~left)):
        near = np.isin(cells, cells[own]).any(axis=1)  # a layer of ghosts
        ids, local = np.unique(cells[near], return_inverse=True)
        name = f"fields_p{r}_{k:06}.vtu"
        write_vtu(
            folder / name,
            points[ids],
            local.reshape(-1, 3),
            {key: v[ids] for key, v in nodal.items()},
            {key: v[near] for key, v in cell.items()},
            ids,
            (~own[near]).astype(int),
        )
        names.append(name)
    file = folder / f"fields{k:06}.pvtu"
    sources = "".join(f'<Piece Source="{name}" />' for name in names)
    file.write_text(f"<VTKFile><PUnstructuredGrid>{sources}</PUnstructuredGrid>")
    file.write_text(file.read_text() + "</VTKFile>")
    return file.name


def write_run(folder, pieces=1, size=0.05, n=10):
    folder.mkdir(parents=True, exist_ok=True)
    sets = ""
    for k, t in enumerate((0.0, 0.1, 0.25)):
        name = write_output(folder, k, t, pieces, n)
        sets += f'<DataSet timestep="{t}" part="0" file="{name}" />'
    (folder / "fields.pvd").write_text(
        f"<VTKFile><Collection>{sets}</Collection></VTKFile>"
    )
    z = np.linspace(0, 0.25, 101)
    p = 2.9685 * (1 + size) * np.tanh(z / 0.012)
    rows = ["time,z_B,p_sy,p_sy_eff,reaction_y,clipped,gap"]
    rows += [
        f"{float(a)!r},{float(a)!r},{float(b)!r},{float(b) / (1 + size)!r},"
        f"{-2e4 * float(b)!r},0,nan"
        for a, b in zip(z, p)
    ]
    (folder / "curves.csv").write_text("\n".join(rows) + "\n")
    scene = {"title": f"x {size}", "mesh": {"size": size, "shape": "rectangle"}}
    (folder / "summary.json").write_text(json.dumps({"scene": scene}))
    line = {"value": 2.9685, "label": "(2+pi)/sqrt(3), Prandtl"}
    known = {"x": "z_B", "at": 0.05, "y": "p_sy", "value": 2.9685}
    plan = {
        "title": "Piercing of a J2 billet",
        "axisymmetric": False,
        "curves": "curves.csv",
        "charts": [
            {
                "file": "p_sy_over_z_B.png",
                "x": "z_B",
                "y": ["p_sy", "p_sy_eff"],
                "references": [line],
                "points": [known],
            },
            {
                "file": "curves.png",
                "x": "time",
                "y": ["reaction_y", "z_B", "p_sy"],
                "references": [],
                "layout": "panels",
            },
            {
                "file": "diagnostics.png",
                "x": "time",
                "y": ["reaction_y", "clipped", "gap"],
                "references": [],
                "layout": "diagnostics",
            },
        ],
        "field_file": "fields.pvd",
        "fields": [
            picture("mesh.png", "", arrows="velocity", time=0.25),
            picture("strain.png", "plastic_strain"),
            picture("pressure.png", "p", unit="Pa", mesh=False, time=0.12),
            picture("flow.png", "plastic_strain", arrows="velocity", mesh=False),
            picture("hill.png", "plastic_strain", surface=True, start=True),
        ],
    }
    (folder / "pictures.json").write_text(json.dumps(plan))
    return folder


def write_domain(folder):
    """Two cells; a domain holds one and three quarters of the other."""
    folder.mkdir()
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    share = {"half": np.array([1.0, 0.75])}
    cells = np.array([[0, 1, 2], [0, 2, 3]])
    write_vtu(folder / "f.vtu", points, cells, {}, share, np.arange(4), [0, 0])
    (folder / "fields.pvd").write_text(
        '<VTKFile><DataSet timestep="0" file="f.vtu" /></VTKFile>'
    )
    (folder / "half.txt").write_text("0 0\n1 0\n1 1\n0 1\n\n.1 .2\n.1 .3\n.2 .2\n")
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    corners += [[0, 0, 0], [0.5, 0.5, 0], [1, 0.5, 0], [0, 0.5, 0]]
    (folder / "half.vtp").write_text(
        f"<VTKFile><PolyData><Piece><Points>{array(None, corners)}</Points><Polys>"
        f"{array('connectivity', np.arange(7), 'Int64')}"
        f"{array('offsets', [3, 7], 'Int64')}</Polys><CellData>"
        f"{array('share', [1.0, 0.75])}</CellData></Piece></PolyData></VTKFile>"
    )
    domain = {"file": "half.png", "name": "half"}
    domain |= {"outline": "half.txt", "pieces": "half.vtp"}
    plan = {"title": "Half", "axisymmetric": True, "curves": "curves.csv"}
    plan |= {"charts": [], "fields": [], "field_file": "fields.pvd"}
    (folder / "pictures.json").write_text(json.dumps(plan | {"domains": [domain]}))
    return folder


PICTURES = "p_sy_over_z_B curves diagnostics mesh strain pressure flow hill".split()


def picture(file, field, mesh=True, arrows=None, time=None, unit="", **more):
    return {
        **more,
        "file": file,
        "field": field,
        "unit": unit,
        "mesh": mesh,
        "arrows": arrows,
        "time": time,
    }


def png_size(file):
    """Breadth and height in pixels, from the header of a PNG."""
    head = file.read_bytes()[:24]
    assert head.startswith(b"\x89PNG\r\n"), file
    return struct.unpack(">II", head[16:24])


def called(*arguments):
    """Exit message of draw.py, None if it was content."""
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            draw.main([str(a) for a in arguments])
    except SystemExit as stop:
        return str(stop.code)
    return None


class Draw(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def test_all_pictures_of_a_run_are_drawn(self):
        for pieces in (1, 2):
            run = write_run(self.folder / str(pieces), pieces)
            self.assertIsNone(called("run", run))
            for name in PICTURES:
                breadth, height = png_size(run / f"{name}.png")
                self.assertGreater(min(breadth, height), 400, name)
            self.assertEqual(list(run.glob("*.part")), [])

    def test_known_points_are_those_of_the_chart(self):
        known = [
            {"x": x, "at": at, "y": y, "value": value}
            for x, at, y, value in (
                ("z", 1, "p", 5),
                ("time", 2, "p", 6),
                ("z", 3, "q", 7),
                ("z", 4, "u", 8),
            )
        ]
        chart = {"x": "z", "y": ["p", "u"], "points": known}
        self.assertEqual(draw_charts.known_points(chart), ([1, 4], [5, 8]))

    def test_pieces_are_joined_without_their_ghosts(self):
        write_output(self.folder, 0, 0.1, 1)
        write_output(self.folder, 0, 0.1, 2)
        one = read_run.read_grid(self.folder / "fields000000.vtu", 0.1)
        two = read_run.read_grid(self.folder / "fields000000.pvtu", 0.1)
        self.assertEqual(len(one.points), 11 * 16)
        self.assertEqual(len(one.cells), 2 * 10 * 15)
        np.testing.assert_array_equal(one.points, two.points)
        np.testing.assert_array_equal(one.nodal["p"], two.nodal["p"])

        def sorted_cells(grid):
            key = np.sort(grid.cells, axis=1)
            order = np.lexsort(key.T)
            return key[order], grid.cell["plastic_strain"][order]

        for a, b in zip(sorted_cells(one), sorted_cells(two)):
            np.testing.assert_array_equal(a, b)
        # 4 sides: 10 + 10 + 15 + 15 edges; a joint would add to them.
        self.assertEqual(len(draw_fields.border(two.cells)), 50)

    def test_the_nearest_output_is_shown(self):
        pvd = write_run(self.folder) / "fields.pvd"
        for asked, got in ((None, 0.25), (0.0, 0.0), (0.12, 0.1), (9.0, 0.25)):
            self.assertEqual(read_run.nearest_output(pvd, asked)[0], got)

    def test_arrows_lie_inside_and_carry_the_field(self):
        write_output(self.folder, 0, 0.0, 1)
        grid = read_run.read_grid(self.folder / "fields000000.vtu", 0.0)
        linear = grid.points @ np.array([[1.0, 3.0], [2.0, -1.0]])
        at, v = draw_fields.sample(grid, linear, 0.1)
        self.assertEqual(len(at), 10 * 15)  # 9 or 10 by 15 of side 0.1
        np.testing.assert_allclose(
            v, at @ np.array([[1.0, 3.0], [2.0, -1.0]]), atol=1e-14
        )

    def test_a_tensor_is_shown_by_its_von_mises_stress(self):
        write_output(self.folder, 0, 0.0, 1)
        grid = read_run.read_grid(self.folder / "fields000000.vtu", 0.0)
        values, nodal, label = draw_fields.scalar(grid, "stress")
        np.testing.assert_allclose(values, 2 * np.sqrt(3))
        self.assertFalse(nodal)
        self.assertEqual(label, "von Mises stress")

    def test_one_hot_cell_does_not_take_all_colours(self):
        values = np.linspace(0, 1, 1000)
        self.assertEqual(draw_fields.colour_range(values), (0, 1, "neither"))
        values[500] = 100
        low, high, extend = draw_fields.colour_range(values)
        self.assertEqual(extend, "max")
        self.assertLess(high, 1.01)
        low, high, _ = draw_fields.colour_range(np.full(10, 3.0))
        self.assertLess(low, 3)
        self.assertGreater(high, 3)

    def test_runs_are_laid_into_one_chart(self):
        sizes = (0.1, 0.05, 0.025)
        runs = [write_run(self.folder / str(h), size=h) for h in sizes]
        output = self.folder / "all.png"
        self.assertIsNone(called("compare", *runs, "-o", output))
        self.assertGreater(png_size(output)[0], 800)
        self.assertEqual(
            draw.run_labels(runs),
            ["mesh.size = 0.1", "mesh.size = 0.05", "mesh.size = 0.025"],
        )

    def test_a_sweep_is_drawn_run_beside_run(self):
        sizes = (0.1, 0.05)
        runs = [write_run(self.folder / f"h={h}", size=h) for h in sizes]
        died = self.folder / "h=0"  # before it had anything to show
        died.mkdir()
        self.assertIsNone(called("run", runs[0]))
        self.assertIsNone(called("sweep", self.folder, *runs, died))
        drawn = {file.name for file in self.folder.glob("*.png")}
        one = {file.name for file in runs[0].glob("*.png")}
        self.assertEqual(drawn, one - {"diagnostics.png"})
        for name, more in (("strain", 1.3), ("hill", 1.3)):
            breadth = png_size(runs[0] / f"{name}.png")[0]
            self.assertGreater(png_size(self.folder / f"{name}.png")[0], more * breadth)

    def test_diagnostics_leave_out_what_tells_nothing(self):
        curves = {
            "a": np.array([0.0, 1.0]),
            "zero": np.zeros(2),
            "nan": np.full(2, np.nan),
            "late": np.array([np.nan, 2.0]),
        }
        names = ["nan", "late", "zero", "a", "absent"]
        self.assertEqual(draw_charts.telling(curves, names), ["late", "a"])

    def test_cell_values_go_to_nodes_by_area(self):
        grid = read_run.Grid(
            0.0,
            np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]),
            np.array([[0, 1, 2], [0, 2, 3]]),
            {},
            {},
        )  # areas 1 and 1/2
        np.testing.assert_allclose(
            draw_fields.at_nodes(grid, np.array([3.0, 6.0])), [4, 3, 4, 6]
        )

    def test_what_cannot_be_drawn_is_told_and_the_rest_drawn(self):
        run = write_run(self.folder)
        plan = json.loads((run / "pictures.json").read_text())
        plan["fields"][0] = picture("mesh.png", "plastic_stain")
        plan["charts"][1]["y"] = ["load"]
        (run / "pictures.json").write_text(json.dumps(plan))
        words = called("run", run)
        self.assertIn('mesh.png: no field "plastic_stain"', words)
        self.assertIn("plastic_strain", words)
        self.assertIn('curves.png: curves.csv: no curve "load"', words)
        self.assertTrue((run / "strain.png").exists())
        self.assertFalse((run / "mesh.png").exists())

    def test_missing_and_broken_files_are_named(self):
        self.assertIn("pictures.json", called("run", self.folder))
        run = write_run(self.folder)
        (run / "fields000002.vtu").write_text("<VTKFile><Unstr")
        self.assertIn("fields000002.vtu", called("run", run))
        (run / "curves.csv").write_text("time,z_B\n0\n")
        self.assertIn("curves.csv", called("run", run))

    def test_a_domain_is_drawn_beside_its_pieces(self):
        folder = write_domain(self.folder / "domain")
        self.assertIsNone(called("run", folder))
        self.assertGreater(png_size(folder / "half.png")[0], 1000)
        rings = read_run.read_rings(folder / "half.txt")
        self.assertEqual([len(r) for r in rings], [4, 3])
        pieces = read_run.read_polygons(folder / "half.vtp")
        self.assertEqual([len(p) for p in pieces.polygons], [3, 4])
        self.assertEqual(list(pieces.data["share"]), [1.0, 0.75])
        self.assertEqual(pieces.polygons[1][2].tolist(), [1.0, 0.5])
        (folder / "half.txt").write_text("0 0\n1 x\n")
        self.assertIn("half.txt", called("run", folder))
        (folder / "half.vtp").unlink()
        (folder / "half.txt").write_text("0 0\n1 0\n1 1\n")
        self.assertIn("half.vtp", called("run", folder))

    def test_neighbours_have_colours_of_their_own(self):
        _, cells, _, _ = block(6, 0)
        chosen = range(0, len(cells), 2)
        colour = draw_domains.neighbours_apart(cells, chosen)
        for c in chosen:
            for d in chosen:
                if c < d and len(set(cells[c]) & set(cells[d])) == 2:
                    self.assertNotEqual(colour[c], colour[d])
        self.assertGreater(len(set(colour.values())), 4)

    def test_known_points_lie_in_the_panels_of_their_columns(self):
        sheet = {
            "points": [
                {"x": "eps_a", "at": 0.01, "y": "q", "value": 5},
                {"x": "cycle", "at": 0.25, "y": "q", "value": 7},
                {"x": "cycle", "at": 0.25, "y": "p", "value": 9},
            ]
        }

        def points(x, y):
            found = draw_sheet.known_points(sheet, {"x": x, "y": y})
            return [tuple(p) for p in found.T]

        self.assertEqual(points("eps_a", "q"), [(0.01, 5)])
        self.assertEqual(points("cycle", "p"), [(0.25, 9)])
        self.assertEqual(points("p", "q"), [(9, 7)])  # both known in one place
        self.assertEqual(points("p", "tau"), [])

    def test_stresses_are_shown_in_units_that_can_be_read(self):
        def axis(name, values):
            return draw_sheet.axis(name, {"": {name: np.array(values)}})

        self.assertEqual(axis("q", [0, -2e5]), ("$q$ [kPa]", 1e-3))
        self.assertEqual(axis("q", [0, -2e8]), ("$q$ [MPa]", 1e-6))
        self.assertEqual(axis("state_1", [3.0]), ("state_1", 1))

    def test_formulae_are_printed_as_such(self):
        self.assertEqual(draw_charts.pretty("(2+pi)/sqrt(3)"), "(2+π)/√3")
        self.assertEqual(draw_charts.pretty("piercing, 2pi"), "piercing, 2π")


if __name__ == "__main__":
    unittest.main()
