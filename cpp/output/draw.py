#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Pictures of a run, from the files in its folder.

    draw.py run FOLDER
        all pictures that FOLDER/pictures.json asks for
    draw.py compare FOLDER FOLDER ... -o PICTURE.png [--x NAME] [--y NAME]
        one curve of several runs in one chart, with the reference line

Reads curves.csv and the ASCII field files (.pvd, .pvtu, .vtu) of the run.
Needs numpy and matplotlib, nothing else.
"""

import argparse
import json
import sys
from pathlib import Path

import picture
from draw_charts import column, draw_chart, draw_together
from draw_fields import draw_field
from picture import Trouble
from read_run import read_curves, read_plan


def run(folder):
    """All pictures of a run; those that fail do not stop the others."""
    plan = read_plan(folder)
    failed = []
    jobs = [(draw_chart, chart) for chart in plan["charts"]]
    jobs += [(draw_field, picture) for picture in plan["fields"]]
    for job, what in jobs:
        try:
            job(folder, plan, what)
        except Trouble as trouble:
            failed.append(f"{what['file']}: {trouble}")
    if failed:
        raise Trouble("; ".join(failed))


def flatten(scene, path=""):
    """Leaves of a scene by their dotted keys."""
    if isinstance(scene, dict):
        pairs = [(f"{path}.{k}" if path else k, v) for k, v in scene.items()]
    elif isinstance(scene, list) and any(isinstance(v, (dict, list)) for v in scene):
        pairs = [(f"{path}[{i}]", v) for i, v in enumerate(scene)]
    else:
        return {path: scene}
    out = {}
    for key, value in pairs:
        out.update(flatten(value, key))
    return out


def run_labels(folders):
    """What tells the runs apart: the keys in which their scenes differ."""
    scenes = []
    for folder in folders:
        try:
            summary = json.loads((folder / "summary.json").read_text())
            scenes.append(flatten(summary.get("scene", {})))
        except (OSError, json.JSONDecodeError):
            return [folder.name for folder in folders]
    keys = dict.fromkeys(key for scene in scenes for key in scene)
    differ = [k for k in keys if len({json.dumps(s.get(k)) for s in scenes}) > 1]
    differ = [k for k in differ if k != "title"]
    if not 0 < len(differ) <= 3:
        return [folder.name for folder in folders]

    def show(value):
        return f"{value:g}" if isinstance(value, float) else str(value)

    return [", ".join(f"{k} = {show(s[k])}" for k in differ if k in s) for s in scenes]


def compare(folders, output, x_name=None, y_name=None):
    """One curve of several runs in one chart."""
    plan = read_plan(folders[0])
    chart = next((c for c in plan["charts"] if c["references"]), None)
    chart = chart or next(iter(plan["charts"]), None)
    if chart is None and (x_name is None or y_name is None):
        raise Trouble(f"{folders[0]}: no chart to go by; give --x and --y")
    x_name = x_name or chart["x"]
    y_name = y_name or chart["y"][0]
    references = []
    for c in plan["charts"]:
        if c["x"] == x_name and c["y"][0] == y_name:
            references = c["references"]
    series = []
    for folder, label in zip(folders, run_labels(folders)):
        curves = read_curves(folder)
        where = folder / "curves.csv"
        x, y = column(curves, x_name, where), column(curves, y_name, where)
        series.append((x, y, y_name, label))
    draw_together(plan["title"], x_name, series, references, output)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    one = verbs.add_parser("run", help="all pictures of a run")
    one.add_argument("folder", type=Path)
    many = verbs.add_parser("compare", help="a curve of several runs")
    many.add_argument("folders", type=Path, nargs="+")
    many.add_argument("-o", "--output", type=Path, required=True)
    many.add_argument("--x", help="name of the abscissa")
    many.add_argument("--y", help="name of the curve")
    options = parser.parse_args(arguments)
    with picture.plt.rc_context(picture.STYLE):
        try:
            if options.verb == "run":
                run(options.folder)
            else:
                compare(options.folders, options.output, options.x, options.y)
        except Trouble as trouble:
            sys.exit(str(trouble))


if __name__ == "__main__":
    main()
