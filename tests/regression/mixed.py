# SPDX-License-Identifier: LGPL-3.0-or-later
"""Demos of several materials in shared cells; see case.py."""

from case import DEMOS, WORK, checks_hold, curves, main, run, same_on
from common import hold


def dam_break():
    """A column of water falls, between the fronts of other codes."""
    folder, _ = run("dam_break")
    checks_hold(folder)


def short(name, **changes):
    """The first steps of the dam break, some words of its scene changed."""
    text = (DEMOS / "dam_break" / "scene.toml").read_text()
    text = text.partition("[output.picture")[0]
    for old, new in {"duration = 0.18": "duration = 0.025", **changes}.items():
        assert old in text, old
        text = text.replace(old, new)
    scene = WORK / f"{name}.toml"
    scene.write_text(text)
    return scene


def dam_break_renamed():
    """Materials have no order: under other names the same to the last bit."""
    one, _ = run(short("one"), results="one")
    names = {"material.water": "material.zwater", '"water"': '"zwater"'}
    other, _ = run(short("other", **names), results="other")
    for name in ("front", "kinetic"):
        hold(curves(one)[name] == curves(other)[name], f"{name} is the same")


def dam_break_np(ranks):
    """Before cells cross a threshold, the same on any number of processes."""
    coarse = {"cells = [60, 25]": "cells = [30, 12]"}
    same_on(ranks, short("np", **coarse), [], {"front": 1e-9, "kinetic": 1e-9})


if __name__ == "__main__":
    main(globals())
