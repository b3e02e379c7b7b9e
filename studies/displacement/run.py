# SPDX-License-Identifier: LGPL-3.0-or-later
"""How far may nodes move in one remap, and what does moving a few of them cost?

With --draw the chart is drawn anew from results.csv.
"""

import importlib.util
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

spec = importlib.util.spec_from_file_location("cyclic", HERE.parent / "cyclic/run.py")
cyclic = importlib.util.module_from_spec(spec)
spec.loader.exec_module(cyclic)

SCHEMES = ["donor_cell", "limited_linear", "linear"]
WAYS = {
    ("swept", "inf"): ("swept, one step", ":"),
    ("swept", "0.999"): ("swept, sub-cycles", "-"),
    ("overlay", "0.999"): ("overlay", "--"),
}
COLUMNS = [
    "scheme",
    "method",
    "largest loss",
    "cells moved",
    "seconds",
    "error",
    "out of bounds",
    "mass error",
    "sub-cycles",
    "outcome",
]
LOCAL = ["kind", "cells", "per cent", "seconds"]


def draw(rows):
    border = [row for row in rows if row["kind"] == "border"]
    local = [row for row in rows if row["kind"] != "border"]
    fig, (left, middle, right) = common.figure(3, width=13, height=4.4)
    for i, scheme in enumerate(SCHEMES):
        for (method, loss), (label, style) in WAYS.items():
            chosen = [
                row
                for row in border
                if (row["scheme"], row["method"], row["largest loss"])
                == (scheme, method, loss)
            ]
            look = {
                "color": common.COLOURS[i],
                "marker": common.MARKERS[i],
                "markersize": 4.5,
                "linestyle": style,
                "label": f"{scheme.replace('_', ' ')}, {label}",
            }
            x = [float(row["cells moved"]) for row in chosen]
            beyond = [float(row["out of bounds"]) for row in chosen]
            left.plot(x, [min(max(b, 1e-17), 1e3) for b in beyond], **look)
            error = [float(row["error"]) for row in chosen]
            middle.plot(x, [min(e, 10) for e in error], **look)
    left.set(yscale="log", ylim=(1e-18, 1e4))
    left.set_ylabel("farthest out of [0, 1]; 1000 and more at the top")
    left.set_title("Bounds", fontsize=10)
    left.legend(fontsize=7.5, loc="center right")
    middle.set(yscale="log", ylim=(1e-2, 15))
    middle.set_ylabel("L1 error, relative; 10 and more at the top")
    middle.set_title("A shock, 20 times away and home", fontsize=10)
    for ax in (left, middle):
        ax.set_xlabel("largest displacement [sides of a square]")
    whole = max(float(row["seconds"]) for row in local)
    for i, kind in enumerate(dict.fromkeys(row["kind"] for row in local)):
        chosen = [row for row in local if row["kind"] == kind]
        right.plot(
            [float(row["per cent"]) for row in chosen],
            [100 * float(row["seconds"]) / whole for row in chosen],
            color=common.COLOURS[i],
            marker=common.MARKERS[i],
            label=kind,
        )
    ends = [0.005, 100]
    right.plot(ends, ends, color="black", linewidth=1, dashes=(6, 3), label="equal")
    right.set(xscale="log", yscale="log")
    right.set_xlabel("cells that change [%]")
    right.set_ylabel("time [% of that for all]")
    right.set_title("131 072 triangles, limited linear", fontsize=10)
    right.legend(fontsize=8.5)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        return draw(common.read_table(HERE))
    program = cyclic.program()
    keys = list(dict.fromkeys(["kind", *COLUMNS, *LOCAL]))
    rows = []
    for scheme in SCHEMES:
        for method, loss in WAYS:
            words = [program, "border", scheme, method, loss]
            rows += [{"kind": "border"} | row for row in cyclic.cases(words, COLUMNS)]
    rows += cyclic.cases([program, "local"], LOCAL)
    rows = [{key: row.get(key, "") for key in keys} for row in rows]
    common.write_table(HERE, rows)
    draw(rows)


if __name__ == "__main__":
    main()
