# SPDX-License-Identifier: LGPL-3.0-or-later
"""Stopping and resuming, and what cannot be resumed; see block.py."""

import signal
import subprocess
import time

from block import (
    COMPARE,
    DEMOS,
    SCENE,
    WORK,
    command,
    main,
    near,
    rows,
    run,
    same,
    scene,
    stop,
)
from common import hold, summary


def resume_np(ranks):
    """A run that was stopped goes on as if it had not been."""
    path = scene()
    whole, _ = run(path, "whole", ranks=ranks)
    for count in (7, 66):  # in the first stage and in the second
        name = f"stopped_{count}"
        code, _ = stop(path, name, count, ranks=ranks)
        hold(code == 3, f"exit code {code}")
        folder = WORK / name
        hold(summary(folder)["outcome"] == "stopped by a signal", "says so")
        hold(count <= rows(folder) < rows(whole), f"after {rows(folder)} rows")
        run(path, name, "--resume", ranks=ranks)
        hold(summary(folder)["resumed"] == 1, "was resumed once")
        if ranks == 1:
            same(whole, folder)
        else:
            near(whole, folder)


WATER = """
[water]
drainage = "seepage"
porosity = 0.4
permeability = 1e-3
"""


def layouts():
    """Points with stresses of their own, inertia and pore water go on bit by bit."""
    path = scene()
    inertia = """
[stage.dynamics]
beta = 0.3025
gamma = 0.6
damping_mass = 1.0
damping_stiffness = 1e-4
"""
    drained = ["stage.push.boundary.surface.drained=true"]
    drained += ["stage.slow.boundary.surface.seepage_face=true"]
    drained += ["stage.slow.dynamics.damping_stiffness=0"]
    first, second = SCENE.split("[[stage]]")[1:]
    stage, rest = second.split("[remap]")
    shaking = "[[stage]]".join([SCENE.split("[[stage]]")[0], first, stage + inertia])
    for name, text, *words in (
        ("three", SCENE, "solver.layout=quadrature", "solver.points=3"),
        ("six", SCENE, "solver.layout=quadrature", "solver.points=6"),
        ("dynamic", shaking + "[remap]" + rest),
        ("both", shaking + "[remap]" + rest, "solver.layout=quadrature"),
        ("undrained", SCENE + WATER, "water.drainage=undrained"),
        ("seepage", shaking + "[remap]" + rest + WATER, *drained),
    ):
        path.write_text(text)
        whole, _ = run(path, name, *words)
        for count in (30, 66):
            stopped = f"{name}_stopped_{count}"
            hold(stop(path, stopped, count, *words)[0] == 3, "stopped")
            run(path, stopped, *words, "--resume")
            same(whole, WORK / stopped)


def other_ranks():
    """A run begun on one process goes on upon two, and the other way."""
    path = scene()
    whole, _ = run(path, "whole")
    for before, after in ((1, 2), (3, 1)):
        name = f"from_{before}_to_{after}"
        hold(stop(path, name, 20, ranks=before)[0] == 3, "stopped")
        run(path, name, "--resume", ranks=after)
        near(whole, WORK / name)


def piercing():
    """The piercing test, graded mesh and punch, goes on bit by bit."""
    words = ["mesh.refine=1", "stage.push.duration=0.1"]
    path = DEMOS / "piercing" / "scene.toml"
    whole, _ = run(path, "whole", *words)
    code, _ = stop(path, "stopped", 40, *words, by=signal.SIGTERM)
    hold(code == 3, "stopped by TERM")
    run(path, "stopped", *words, "--resume")
    same(whole, WORK / "stopped")


def sweep():
    """A sweep goes on: done members are skipped, later ones start."""
    path = scene()
    # the second is long enough to be stopped in its midst
    values = "stage.push.step=0.001,0.0001,0.0012"
    whole, _ = run(path, "whole", values)
    names = [f"stage.push.step={v}" for v in ("0.001", "0.0001", "0.0012")]
    process = subprocess.Popen(
        command(path, "stopped", values),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    while rows(WORK / "stopped" / names[1]) < 10 and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGUSR1)
    hold(process.wait(60) == 3, "stopped in the second member")
    hold(not (WORK / "stopped" / names[2]).exists(), "the third has not begun")
    first = (WORK / "stopped" / names[0] / "checkpoint.h5").stat().st_mtime_ns
    _, said = run(path, "stopped", values, "--resume")
    hold("is completed" in said, "the first is said to be completed")
    again = (WORK / "stopped" / names[0] / "checkpoint.h5").stat().st_mtime_ns
    hold(first == again, "and left alone")
    for name in names:
        same(whole / name, WORK / "stopped" / name)
    tables = [(f / "sweep.csv").read_text() for f in (whole, WORK / "stopped")]
    hold(tables[0] == tables[1], "sweep.csv is the same")


def longer():
    """A completed run says so; with a longer stage there is more to do."""
    path = scene()
    whole, _ = run(path, "whole")
    folder, _ = run(path, "short", "stage.slow.duration=0.01")
    _, said = run(path, "short", "stage.slow.duration=0.01", "--resume")
    hold("is completed" in said, f"says: {said.strip()}")
    run(path, "short", "--resume")
    hold(rows(folder) == rows(whole), f"{rows(folder)} rows in the end")
    # the end of the short run was an output of its own, met to the last digit
    words = [str(COMPARE), *(str(f / "checkpoint.h5") for f in (whole, folder))]
    said = subprocess.run([*words, "1e-9"], stdout=subprocess.PIPE, text=True).stdout
    differ = said.splitlines()[:-1]
    hold(differ == ["run/outputs is another number"], f"the same but: {differ}")


def refusals():
    """What cannot be resumed is told: no, another, cut, foreign, old checkpoint."""
    path = scene()
    _, said = run(path, "none", "--resume", code=1)
    hold("no checkpoint" in said, f"none: {said.strip()}")
    folder, _ = run(path, "done", "stage.push.duration=0.01")
    file = folder / "checkpoint.h5"
    whole = file.read_bytes()
    changed = ["mesh.cells=[6,5]", "material.block.nu=0.2", "solver.tolerance=1e-9"]
    _, said = run(path, "done", *changed, "--resume", code=1)
    for key in ("mesh.cells", "material.block.nu"):
        hold(key in said, f"{key} is named")
    hold("solver.tolerance" not in said, "how hard it tries may change")
    hold(file.read_bytes() == whole, "and nothing is touched")
    for name, content, words in (
        ("cut", whole[: len(whole) // 2], "damaged"),
        ("foreign", b"t,x\n0,1\n" * 500, "is no checkpoint"),
        ("empty", b"", "is no checkpoint"),
    ):
        file.write_bytes(content)
        for ranks in (1, 2):
            _, said = run(path, "done", "--resume", code=1, ranks=ranks)
            hold(words in said and "checkpoint.h5" in said, f"{name}: {said.strip()}")
            hold("HDF5-DIAG" not in said, "in our words")
        hold(file.read_bytes() == content, "the file is left as it is")


def afresh():
    """Without --resume a run starts again, says so, and mixes nothing up."""
    path = scene()
    whole, _ = run(path, "whole")
    code, _ = stop(path, "again", 70, by=signal.SIGINT)
    hold(code == 3, "stopped by INT")
    folder, said = run(path, "again")
    hold("starts afresh" in said and said.count("\n") == 1, said.strip())
    hold(summary(folder)["resumed"] == 0, "was not resumed")
    same(whole, folder)
    _, said = run(path, "again")
    hold(said == "", "nothing is said of a run that was completed")


if __name__ == "__main__":
    main(globals())
