# SPDX-License-Identifier: LGPL-3.0-or-later
"""Drawings laid over meshes, held to exact arithmetic; see case.py."""

import math
import os
import shutil
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

import exact_clip
from case import DEMOS, WORK, checks_hold, conserved, curves, main, run
from common import hold

COARSE = ["mesh.cells=[18,12]", "domain.logo.tolerance=1e-4"]


def logo_clip():
    """Parts of cells are the exact ones; the whole is found again in them."""
    folder, _ = run("logo_clip")
    checks_hold(folder)
    conserved(folder)
    for name in ("logo.png", "logo.vtp", "logo.txt", "fields.pvd"):
        hold((folder / name).exists(), f"{name} is there")
    folder, _ = run("logo_clip", *COARSE, results="coarse")
    rings = exact_clip.read_rings(folder / "logo.txt")
    worst = [0.0, 0.0]
    total, mixed = Fraction(0), 0
    for corners, share, centre in exact_clip.read_cells(folder, "logo"):
        part, cell = exact_clip.part(rings, corners)
        total += part[0]
        true_share = part[0] / cell[0]
        worst[0] = max(worst[0], float(abs(true_share - Fraction(share))))
        if 0 < share < 1:
            mixed += 1
            for k in range(2):
                off = abs(part[1 + k] / part[0] - Fraction(centre[k]))
                worst[1] = max(worst[1], float(off) * share)
    # Files hold 16 digits: places of 3 m to 4e-16 m, in cells of 0.17 m.
    hold(worst[0] < 2e-14, f"shares of cells: off by {worst[0]:.1e} at most")
    hold(worst[1] < 4e-15, f"share times centroid: by {worst[1]:.1e} m")
    hold(mixed == curves(folder)["logo.mixed"][-1] > 200, f"{mixed} mixed cells")
    # The cells as read leave gaps of their last digits.
    hold(abs(total / exact_clip.whole(rings)[0] - 1) < 1e-14, "exact parts too")
    polygons = polygon_areas(folder / "logo.vtp")
    areas = [area for _, area in polygons]
    volume = curves(folder)["logo.volume"][-1]
    hold(abs(sum(areas) / volume - 1) < 1e-13, f"{len(areas)} polygons fill it")
    hold(min(areas) > 0, "and each runs counter-clockwise")
    # The same drawing half outside of the mesh: what is missing is told.
    half, _ = run("logo_clip", "domain.logo.at=[1.6,0.06]", results="half")
    c = {name: column[-1] for name, column in curves(half).items()}
    inside = sum(
        share * float(exact_clip.moments(exact_clip.exact(corners))[0])
        for corners, share, _ in exact_clip.read_cells(half, "logo")
    )
    hold(abs(c["logo.volume"] - inside) < 1e-13, "volume in the mesh")
    gap = c["logo.volume"] + c["logo.outside"] - 2.8782204768343105
    hold(abs(gap) < 1e-13 and c["logo.outside"] > 1, "and outside of it")


def polygon_areas(file):
    """(cell, area) of each polygon of a .vtp."""
    piece = ElementTree.parse(file).getroot().find("./PolyData/Piece")
    points, connectivity, offsets = [
        [float(x) for x in array.text.split()]
        for array in (*piece.find("Points"), *piece.find("Polys"))
    ]
    numbers = next(a for a in piece.find("CellData") if a.get("Name") == "cell")
    out, begin = [], 0
    for end, number in zip(map(int, offsets), numbers.text.split()):
        ring = [
            (points[3 * int(n)], points[3 * int(n) + 1])
            for n in connectivity[begin:end]
        ]
        area = float(exact_clip.moments(exact_clip.exact(ring))[0])
        out.append((int(number), area))
        begin = end
    return out


def logo_clip_np(ranks):
    """Domains on several processes: the same numbers and polygons."""
    one, _ = run("logo_clip", results="np_1")
    many, _ = run("logo_clip", ranks=ranks, results=f"np_{ranks}")
    a, b = curves(one), curves(many)
    for name in a:
        apart = abs(a[name][-1] - b[name][-1])
        # sums in another order
        hold(apart < 2e-15 * max(1, abs(a[name][-1])), f"{name}: apart by {apart:.1e}")
    hold(b["logo.mixed"] == a["logo.mixed"], "as many mixed cells")
    checks_hold(many)
    texts = [(folder / "logo.txt").read_text() for folder in (one, many)]
    hold(texts[0] == texts[1], "the same outline")
    words = ["symmetry=axisymmetric", *COARSE]
    turned = [
        run("logo_clip", *words, ranks=n, results=f"r_{n}")[0] for n in (1, ranks)
    ]
    for folder in turned:
        conserved(folder)
    areas = [{}, {}]
    for folder, area in zip(turned, areas):
        for cell, a_piece in polygon_areas(folder / "logo.vtp"):
            area[cell] = area.get(cell, 0) + a_piece
    hold(list(areas[0]) == list(areas[1]), "polygons of the same cells, in order")
    worst = max(abs(areas[0][c] - areas[1][c]) for c in areas[0])
    hold(worst < 1e-15, f"their areas apart by {worst:.1e}")
    volumes = [curves(folder)["logo.volume"][-1] for folder in turned]
    # Pappus: the area times the way of its centroid, on the finer outline
    whole = 2 * math.pi * a["logo.volume"][-1] * a["logo.centroid_x"][-1]
    hold(abs(volumes[0] / whole - 1) < 1e-4, f"about the axis: {volumes[0]:.6f} m3")
    hold(abs(volumes[1] / volumes[0] - 1) < 1e-14, "on all ranks")


def bad_domain():
    """Mistakes in a domain's file have its name and line, once on any ranks."""
    folder = WORK / "scene"
    shutil.copytree(DEMOS / "logo_clip", folder)
    scene = folder / "scene.toml"
    (folder / "cross.txt").write_text("0 0\n1 1\n# here\n1 0\n0 1\n")
    (folder / "short.txt").write_text("0 0\n1 0\n1 1\n\n# here\n.1 .1\n.2 .2\n")
    (folder / "reference.toml").unlink()
    for ranks in (1, 3):
        words = ["domain.logo.file=short.txt", "mesh.cels=[3,3]"]
        results, said = run(scene, *words, code=1, ranks=ranks)
        for wanted in (
            "short.txt:6: ring 2: has 2 points; a ring needs 3 that differ",
            "did you mean 'cells'",
            "2 complaints",
        ):
            hold(said.count(wanted) == 1, f"{ranks} ranks say once: {wanted}")
        hold(not results.exists(), "no results")
    cross = "domain.logo.file=cross.txt"
    if os.environ.get("MMALE_CGAL"):
        # Two triangles tip to tip, a quarter of a unit of 1 cm each.
        area = curves(run(scene, cross, ranks=2)[0])["logo.volume"][-1]
        hold(abs(area / 5e-5 - 1) < 1e-14, f"crossing rings are cleaned: {area} m2")
        shutil.rmtree(results)
    else:
        _, said = run(scene, cross, code=1)
        at = "cross.txt:1: ring 1: the ring crosses itself near (0.065, 0.065)"
        hold(at in said, "crossing rings are told")
        hold("domain.logo.file: its rings cross: unite" in said, "with the remedy")
    _, said = run(scene, "domain.logo.file=no.svg", code=1)
    hold("no.svg: no such file" in said, "a missing file is named")
    (folder / "bad.svg").write_text("<svg>\n<path d='M0 0L1 0\n1 x'/></svg>")
    _, said = run(scene, "domain.logo.file=bad.svg", code=1)
    hold("bad.svg:3: path data: a number is expected" in said, "path data too")
    _, said = run(scene, "domain.logo.at=[7,0]", code=1)
    hold("lies outside the mesh, which is (0, 0) to (3, 2)" in said, "far away")
    _, said = run(scene, "--resume", code=1)
    hold("there is no checkpoint" in said, "nothing to resume")


if __name__ == "__main__":
    main(globals())
