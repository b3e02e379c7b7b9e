#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Pictures of a run, from the files in its folder.

    draw.py run FOLDER
        all pictures that FOLDER/pictures.json asks for
    draw.py sweep FOLDER RUN RUN ...
        each chart and each picture of a field with all the runs of a sweep
    draw.py compare FOLDER FOLDER ... -o PICTURE.png [--x NAME] [--y NAME]
            [--labels NAME ...]
        one curve of several runs in one chart, with the reference line

Reads curves.csv and the ASCII field files (.pvd, .pvtu, .vtu) of the run.
Needs numpy and matplotlib, nothing else.
"""

import argparse
import json
import sys
from pathlib import Path

import picture
from draw_charts import column, draw_chart, draw_panels, draw_together
from draw_domains import draw_domain
from draw_fields import draw_field, draw_fields
from draw_sheet import draw_sheet, draw_sheets
from picture import Trouble
from read_run import read_curves, read_plan


def run(folder):
    """All pictures of a run; those that fail do not stop the others."""
    plan = read_plan(folder)
    failed = []
    jobs = [(draw_chart, chart) for chart in plan["charts"]]
    jobs += [(draw_field, picture) for picture in plan["fields"]]
    jobs += [(draw_domain, domain) for domain in plan.get("domains", [])]
    jobs += [(draw_sheet, sheet) for sheet in plan.get("sheets", [])]
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


def draw_runs(plan, chart, runs, file):
    """A chart with the curves of several runs.

    runs: dict label -> curves of a run"""
    names = [n for n in chart["y"] if all(n in curves for curves in runs.values())]
    if not names:
        raise Trouble(f"no run has a curve of {', '.join(chart['y'])}")
    if chart.get("layout") == "panels":
        draw_panels(plan["title"], chart["x"], runs, names, file)
        return
    series = []
    for label, curves in runs.items():
        for name in names:
            x, y = column(curves, chart["x"], file), column(curves, name, file)
            full = label if len(names) == 1 else f"{label}, {name}"
            series.append((x, y, name, full))
    draw_together(plan, chart, series, file)


def sweep(folder, members):
    """All pictures of a sweep: what its runs have in common, drawn together."""
    # A run that failed at once has drawn nothing.
    members = [m for m in members if (m / "pictures.json").exists()]
    if not members:
        raise Trouble(f"{folder}: no run to draw")
    plan = read_plan(members[0])
    labels = run_labels(members)
    runs = {label: read_curves(m) for label, m in zip(labels, members)}
    failed = []
    for chart in plan["charts"]:
        if chart.get("layout") != "diagnostics":
            try:
                draw_runs(plan, chart, runs, folder / chart["file"])
            except Trouble as trouble:
                failed.append(f"{chart['file']}: {trouble}")
    jobs = [(draw_fields, what) for what in plan["fields"]]
    jobs += [(draw_sheets, what) for what in plan.get("sheets", [])]
    for job, what in jobs:
        try:
            job(dict(zip(labels, members)), plan, what, folder / what["file"])
        except Trouble as trouble:
            failed.append(f"{what['file']}: {trouble}")
    if failed:
        raise Trouble("; ".join(failed))


def compare(folders, output, x_name=None, y_name=None, labels=None):
    """One curve of several runs in one chart."""
    plan = read_plan(folders[0])
    chart = next((c for c in plan["charts"] if c["references"]), None)
    chart = chart or next(iter(plan["charts"]), None)
    if chart is None and (x_name is None or y_name is None):
        raise Trouble(f"{folders[0]}: no chart to go by; give --x and --y")
    x_name = x_name or chart["x"]
    y_name = y_name or chart["y"][0]
    for c in plan["charts"]:
        if c["x"] == x_name and c["y"][0] == y_name:
            chart = {**c, "y": [y_name], "layout": "together"}
            break
    else:
        chart = {"x": x_name, "y": [y_name], "references": []}
    runs = {
        label: read_curves(folder)
        for label, folder in zip(labels or run_labels(folders), folders)
    }
    for folder, curves in zip(folders, runs.values()):
        column(curves, x_name, folder / "curves.csv")
        column(curves, y_name, folder / "curves.csv")
    draw_runs(plan, chart, runs, output)


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
    many.add_argument("--labels", nargs="+", help="names of the runs, in order")
    all_of = verbs.add_parser("sweep", help="all pictures of a sweep")
    all_of.add_argument("folder", type=Path, help="where to write them")
    all_of.add_argument("runs", type=Path, nargs="+")
    options = parser.parse_args(arguments)
    with picture.plt.rc_context(picture.STYLE):
        try:
            if options.verb == "run":
                run(options.folder)
            elif options.verb == "sweep":
                sweep(options.folder, options.runs)
            else:
                compare(
                    options.folders,
                    options.output,
                    options.x,
                    options.y,
                    options.labels,
                )
        except Trouble as trouble:
            sys.exit(str(trouble))


if __name__ == "__main__":
    main()
