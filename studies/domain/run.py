# SPDX-License-Identifier: LGPL-3.0-or-later
"""What does an exact part of a cell cost? Ours beside CGAL's exact overlay and
beside counting points, on the drawing of demos/logo_clip."""

import csv
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent)]
import common  # noqa: E402

DRAWING = common.ROOT / "demos" / "logo_clip" / "logo.svg"
TOLERANCE = "1e-4"  # from curve to chord [m]: 1968 points
NONE = 1e-17  # where the chart puts errors of none


def program():
    """The cases, built beside the solver."""
    return common.built(
        "domain_cases", "domain/program/domain_cases", "; it needs CGAL (libcgal-dev)"
    )


def measure():
    words = [program(), str(DRAWING), TOLERANCE]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"domain_cases ends with {done.returncode}: {done.stderr}")
    print(done.stderr.strip())
    rows = list(csv.DictReader(done.stdout.splitlines()))
    for row in rows:
        for key, value in row.items():
            if key != "method":
                row[key] = float(value) if "." in value or "e" in value else int(value)
    return rows


def draw(rows):
    fig, ax = common.figure(width=7.2, height=4.4)
    for i, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
        chosen = [row for row in rows if row["method"] == method]
        ax.plot(
            [row["us_per_cell"] for row in chosen],
            [max(row["worst_share"], NONE) for row in chosen],
            color=common.COLOURS[i],
            marker=common.MARKERS[i],
            label=method,
        )
    ax.set_xscale("log")
    ax.set_yscale("log")
    ticks = [1, 1e-4, 1e-8, 1e-12, 1e-16]
    ax.set_yticks([*ticks, NONE], [*(f"{t:g}" for t in ticks), "none"])
    ax.set_xlabel("processor time a cell [µs], 192 to 49 152 cells")
    ax.set_ylabel("worst error of a cell's share")
    ax.legend(loc="center right")
    common.save(fig, HERE)


def main():
    rows = measure()
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
