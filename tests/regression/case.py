# SPDX-License-Identifier: LGPL-3.0-or-later
"""What the scripts of cases share: SCRIPT PROGRAM DEMOS CASE.

Each case is a function of its script, its first line the sentence that it holds.
Cases NAME_np_N compare N processes with one. Needs the standard library only.
"""

import csv
import sys
import tempfile
from pathlib import Path

from common import finish, hold, ranked, run_case, summary

PROGRAM, DEMOS = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
WORK = Path(tempfile.mkdtemp(prefix="mmale_regression_"))  # folder of this case


def command(scene, *words, ranks=1):
    if not isinstance(scene, Path):
        scene = DEMOS / scene / "scene.toml"
    return ranked([str(PROGRAM), "run", str(scene), *words, "--quiet"], ranks)


def run(scene, *words, code=0, ranks=1, results="results"):
    """Run to the end; its folder and what it said."""
    words = [*words, "--results", str(WORK / results)]
    said = finish(command(scene, *words, ranks=ranks), code)
    return WORK / results, said


def curves(folder):
    with open(folder / "curves.csv", newline="") as stream:
        rows = list(csv.reader(stream))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def at(curve, name, x_name, x):
    """Linear interpolation where x_name first passes x."""
    xs, ys = curve[x_name], curve[name]
    i = next(i for i, value in enumerate(xs) if value >= x * (1 - 1e-12))
    if i == 0:
        return ys[0]
    t = (x - xs[i - 1]) / (xs[i] - xs[i - 1])
    return ys[i - 1] + t * (ys[i] - ys[i - 1])


def checks_hold(folder):
    checks = summary(folder)["checks"]
    for check in checks:
        hold(check["holds"], f"{folder.name}, reference.toml: {check['name']}")
    hold(len(checks) > 0, "reference.toml was looked at")


def conserved(folder):
    for entry in summary(folder)["ledger"]:
        change = entry["relative_change"]
        # round-off of some hundred sums over some thousand cells
        hold(abs(change) <= 1e-12, f"{entry['name']} is conserved: {change:.1e}")


def same_on(ranks, demo, words, columns):
    """columns: name -> absolute tolerance."""
    one, _ = run(demo, *words, results="np_1")
    many, _ = run(demo, *words, ranks=ranks, results=f"np_{ranks}")
    a, b = curves(one), curves(many)
    hold(a["time"] == b["time"], f"{len(a['time'])} steps on both")
    for name, tolerance in columns.items():
        apart = [abs(x - y) for x, y in zip(a[name], b[name])]
        near = all(d <= tolerance for d in apart)  # NaN is not
        hold(near, f"{name}: {max(apart):.1e}, allowed {tolerance:.0e}")


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def copy_of(demo, **changes):
    """A scene of its own with lines of a demo's changed: old=new."""
    text = (DEMOS / demo / "scene.toml").read_text()
    for old, new in changes.values():
        assert old in text, old
        text = text.replace(old, new, 1)
    folder = WORK / "scene"
    folder.mkdir()
    (folder / "scene.toml").write_text(text)
    return folder / "scene.toml"


def main(cases):
    """Run the case of the command line, one of the functions in `cases`."""
    run_case({**cases, "signal": cases.get("signal_")}, sys.argv[3], WORK)
