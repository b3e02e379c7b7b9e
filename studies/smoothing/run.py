# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which smoother gives the best cells for its time? Ours beside gmsh's optimisers
of plane meshes, from the same start meshes, all boundary nodes fixed."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import common  # noqa: E402
import meshes  # noqa: E402
from ours import Ours  # noqa: E402
from peer import Gmsh  # noqa: E402

SWEEPS = [1, 5, 20, 100, 400]
REPEATS = 3  # of what takes less than a second
GMSH = {"Laplace2D": 100, "Relocate2D": 400}  # method -> most iterations
OVER = "optimise, 1.5"  # name of optimise with over-relaxation


def piercing():
    """The mesh at z/B = 0.1 of a run that remaps every tenth step, as the material
    has taken it since the last remap but one step."""
    changes = {"remap.every": 10, "stage.0.duration": 0.099}
    last = common.run(common.with_keys(common.PIERCING, changes), fields=True).last
    x = last.points[:, :2].copy()
    turned = meshes.areas(x, last.cells)[:, None] < 0
    return x, np.where(turned, last.cells[:, ::-1], last.cells)


def measure(mesh, x, cells, ours, gmsh, rows):
    """All methods in turn, each sweep count from the start; least seconds."""
    gmsh_cases = [(m, n) for m, most in GMSH.items() for n in SWEEPS if n <= most]
    our_cases = [(m, n) for m in [*ours.names, OVER] for n in SWEEPS]
    times, after = {}, {}
    ours.load(x, cells)
    for _ in range(REPEATS):
        for method, n in gmsh_cases:
            if times.get((method, n), 0) < 1:
                gmsh.load(x, cells)
                seconds = gmsh.optimise(method, n)
                after[method, n] = gmsh.nodes()
                times[method, n] = min(seconds, times.get((method, n), np.inf))
        for method, n in our_cases:
            name, relaxation = ("optimise", 1.5) if method == OVER else (method, 1.0)
            after[method, n], seconds = ours.run(name, n, relaxation)
            times[method, n] = min(seconds, times.get((method, n), np.inf))
    start = meshes.radius_ratio(x, cells)
    rows.append(row(mesh, len(x), "start", 0, 0.0, start))
    for (method, n), seconds in times.items():
        q = meshes.radius_ratio(after[method, n], cells)
        rows.append(row(mesh, len(x), method, n, seconds, q))


def row(mesh, nodes, method, sweeps, seconds, q):
    return {
        "mesh": mesh,
        "nodes": nodes,
        "method": method,
        "sweeps": sweeps,
        "seconds": seconds,
        "nodes_per_s": sweeps * nodes / seconds if seconds else np.nan,
        "q_min": float(q.min()),
        "q_mean": float(q.mean()),
    }


def compare(rows):
    """Ours over the better of gmsh's, of all that left no cell inverted, and how
    long each takes to 0.99 of both best values."""
    for mesh in dict.fromkeys(r["mesh"] for r in rows):
        here = [r for r in rows if r["mesh"] == mesh and r["sweeps"]]
        peers = [r for r in here if r["method"] in GMSH and r["q_min"] > 0]
        best = {k: max(r[k] for r in peers) for k in ("q_min", "q_mean")}
        for method in dict.fromkeys(r["method"] for r in here):
            chosen = [r for r in here if r["method"] == method]
            good = [r for r in chosen if all(r[k] > 0.99 * best[k] for k in best)]
            times = [f"{1e3 * r['seconds']:.1f} ms" for r in good] or ["never"]
            at = next(r for r in chosen if r["sweeps"] == 100)
            a, b = (at[k] / best[k] for k in best)
            print(f"{mesh}, {method}: {a:.3f} {b:.3f} {times[0]}")


def draw(rows):
    names = list(dict.fromkeys(r["mesh"] for r in rows))
    fig, axes = common.figure(len(names), width=15, height=6.6, rows=2, sharex="col")
    methods = dict.fromkeys(r["method"] for r in rows if r["method"] != "start")
    for column, mesh in enumerate(names):
        for i, method in enumerate(methods):
            chosen = [r for r in rows if r["mesh"] == mesh and r["method"] == method]
            peer = method in GMSH
            look = {
                "color": ["#222222", "#888888"][i] if peer else common.COLOURS[i - 2],
                "marker": common.MARKERS[i],
                "linestyle": "--" if peer else "-",
                "label": f"gmsh {method}" if peer else method.replace("_", " "),
                "markersize": 4,
            }
            t = [1e3 * r["seconds"] for r in chosen]
            for line, key in enumerate(("q_min", "q_mean")):
                axes[line, column].plot(t, [r[key] for r in chosen], **look)
        start = next(r for r in rows if r["mesh"] == mesh and r["method"] == "start")
        for line, key in enumerate(("q_min", "q_mean")):
            ax = axes[line, column]
            ax.axhline(start[key], color="#bbbbbb", linewidth=0.8, zorder=0)
            ax.set_xscale("log")
            if column == 0:
                ax.set_ylabel(["worst", "mean"][line] + " radius ratio")
        low = min(0.0, min(r["q_min"] for r in rows if r["mesh"] == mesh))
        axes[0, column].set_ylim(max(low, -0.3) - 0.02, None)
        axes[0, column].set_title(f"{mesh}, {start['nodes']} nodes")
        axes[1, column].set_xlabel("processor time [ms]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    common.save(fig, HERE)


def main():
    starts = {
        "random": meshes.random(),
        "graded": meshes.graded(),
        "hill": meshes.hill(),
        "steep hill": meshes.hill(height=0.6, width=0.1),
        "piercing": piercing(),
    }
    ours, gmsh = Ours(), Gmsh()
    print("gmsh", gmsh.version())
    rows = []
    for mesh, (x, cells) in starts.items():
        measure(mesh, x, cells, ours, gmsh, rows)
    common.write_table(HERE, rows)
    compare(rows)
    draw(rows)


if __name__ == "__main__":
    main()
