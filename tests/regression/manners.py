# SPDX-License-Identifier: LGPL-3.0-or-later
"""The program's manners: mistakes, sweeps, signals; see case.py."""

import csv
import shutil
import signal
import subprocess
import time

from case import DEMOS, WORK, command, conserved, copy_of, curves, main, run
from common import hold, summary


def exit_codes():
    """0 completed, 1 mistake, 2 failure, 3 stopped early, 4 a check fails."""
    scene = copy_of("cook_membrane")
    folder, _ = run(scene)
    hold(summary(folder)["outcome"] == "completed", "0: completed")
    run(scene, "material.membrane.nu=0.7", code=1)
    run(WORK / "no.toml", code=1)
    (WORK / "file").write_text("")
    _, said = run(scene, code=1, results="file/results")
    hold("file/results" in said, "1: results that cannot be written are named")
    reference = scene.parent / "reference.toml"
    reference.write_text('[v]\ncurve = "u"\ntake = "last"\nvalue = 1.0\nrtol = 0.1\n')
    _, said = run(scene, code=2)
    hold(
        '"u"' in said and "reference.toml:" in said, "2: a bad reference.toml is named"
    )
    reference.write_text('[v]\ncurve = "v"\ntake = "last"\nvalue = 1.0\nrtol = 0.1\n')
    folder, _ = run(scene, code=4)
    hold(not summary(folder)["checks"][0]["holds"], "4: the check that fails is told")
    run(scene, "material.membrane.E=2e9")
    print("holds: a changed scene is not checked against the reference")


def bad_scene():
    """All complaints at once, with file and line, and nothing is run."""
    changes = {"a": ("E = 1e9", "E = -1.0"), "b": ("diagonal =", "diagnal =")}
    scene = copy_of("cook_membrane", **changes)
    folder, said = run(scene, code=1)
    for words in ("scene.toml:", "did you mean 'diagonal'", "2 complaints"):
        hold(words in said, f"says {words}")
    hold(not folder.exists(), "no results")
    _, said = run(scene, code=1, ranks=2)
    hold(said.count("did you mean") == 1, "two ranks say it once")


def bad_mesh():
    """Mistakes in scene and mesh at once, on any number of ranks once."""
    folder = WORK / "scene"
    shutil.copytree(DEMOS / "thick_cylinder", folder)
    scene = folder / "scene.toml"
    text = scene.read_text()
    scene.write_text(text.replace("boundary.inner]", "boundary.iner]"))
    for ranks in (1, 2, 3):
        results, said = run(scene, "material.cylinder.nu=0.7", code=1, ranks=ranks)
        for words in (
            "iner: no such boundary, did you mean 'inner'? (known: inner, level",
            "nu: must be",
            "2 complaints",
        ):
            hold(said.count(words) == 1, f"{ranks} ranks say once: {words}")
        hold(not results.exists(), "no results")
    scene.write_text(
        text.replace("boundary.inner]\n", "boundary.inner]\nroller=true\n")
    )
    _, said = run(scene, code=1)
    hold("inner.roller: the boundary is slanted or curved" in said, "no such roller")
    scene.write_text(text.replace("ring.geo", "no.geo"))
    _, said = run(scene, code=1, ranks=2)
    hold(said.count("no.geo: no such file") == 1, "a missing file is told once")
    scene.write_text(text)
    geo = (folder / "ring.geo").read_text()
    (folder / "ring.geo").write_text(geo + "Recombine Surface{1};\n")
    _, said = run(scene, code=1, ranks=3)
    hold(said.count("ring.geo: quadrilaterals cannot be used") == 1, "quadrilaterals")
    (folder / "ring.geo").write_text(geo + "Mesh.ElementOrder = 2;\n")
    _, said = run(scene, code=1)
    hold("ring.geo: triangles of higher order" in said, "second order")
    (folder / "ring.geo").write_text(geo + "Plane Surface(2) = {7};\n")
    _, said = run(scene, code=1, ranks=2)
    hold(said.count("gmsh fails:") == 1, "what gmsh says is told")


def gmsh_remap():
    """ALE on a mesh with arcs: mass is kept, ranks agree, arcs keep their nodes."""
    folder = WORK / "scene"
    shutil.copytree(DEMOS / "thick_cylinder", folder)
    scene = folder / "scene.toml"
    text = scene.read_text()
    # 1 / 10 of E: the ring grows by some percent in ten steps
    text = text.replace("pressure = 1e-4 ", "pressure = {time=[0,1], value=[0,100]} ")
    text = text.replace("step = 1.0 ", "step = 0.1 ")
    text += '\n[remap]\nmode = "ale"\nevery = 1\nsurface = ["outer"]\n'
    scene.write_text(text)
    (folder / "reference.toml").unlink()
    words = ["mesh.refine=2"]
    one, _ = run(scene, *words, results="np_1")
    conserved(one)
    hold(summary(one)["remaps"] == 10, "a remap every step")
    lagrangian, _ = run(
        scene, *words, "remap.mode=lagrangian", "remap.surface=[]", results="lagrangian"
    )
    a, b = curves(one), curves(lagrangian)
    near = abs(a["u_a"][-1] / b["u_a"][-1] - 1)
    hold(near < 0.01, f"u(a) as without remap: {near:.1e}")
    for ranks in (2, 3):
        many, _ = run(scene, *words, ranks=ranks, results=f"np_{ranks}")
        apart = abs(curves(many)["u_a"][-1] / a["u_a"][-1] - 1)
        hold(apart < 1e-5, f"np = {ranks}: u(a) apart by {apart:.1e}")


def sweep():
    """A sweep ends in one table, a row a run, and in pictures with all runs."""
    words = ["mesh.refine=1,2", "diagonal"]
    folder, _ = run("cook_membrane", words[0], "mesh.diagonal=left,right")
    with open(folder / "sweep.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    hold(len(rows) == 4, "four rows")
    for row in rows:
        name = f"mesh.refine={row['mesh.refine']},mesh.diagonal={row['mesh.diagonal']}"
        hold(row["outcome"] == "completed", f"{name} completed")
        v = curves(folder / name)["v"][-1]
        hold(float(row["v"]) == v, f"its last v is in the table: {v:.6f}")
    # The other diagonal is much worse, says the table's source.
    hold(float(rows[0]["v"]) > float(rows[1]["v"]), "left is better than right")
    for name in ("curves", "pressure"):
        hold((folder / f"{name}.png").exists(), f"{name}.png of all runs")


def signal_():
    """USR1 ends a run after its step, its state saved."""
    folder = WORK / "results"
    words = ["mesh.refine=1", "--results", str(folder)]
    process = subprocess.Popen(command("piercing", *words), stdin=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        file = folder / "curves.csv"
        if file.exists() and file.read_text().count("\n") > 3:
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGUSR1)
    code = process.wait(60)
    hold(code == 3, f"exit code {code}")
    outcome = summary(folder)["outcome"]
    hold(outcome == "stopped by a signal", f"outcome: {outcome}")
    hold((folder / "checkpoint.h5").stat().st_size > 0, "checkpoint.h5 is written")
    hold(curves(folder)["z_B"][-1] < 0.25, "before the end")


if __name__ == "__main__":
    main(globals())
