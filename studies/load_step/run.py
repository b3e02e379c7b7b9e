# SPDX-License-Identifier: LGPL-3.0-or-later
"""How large may a load step be? Newton's basin under the punch."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

DEPTH = 0.05
STEPS = [0.0005, 0.001, 0.002, 0.005, 0.01, 0.025, 0.05]
FLOOR = 0.0005 / 16  # one for all, so that all are given up alike
CHOICES = {
    "consistent, line search": {},
    "consistent, full steps": {"solver.line_search": False},
    "continuum, line search": {"solver.tangent": "continuum"},
    "continuum, full steps": {
        "solver.tangent": "continuum",
        "solver.line_search": False,
    },
}

COARSE, FINE = (0.1, 0.025), (0.05, 0.0125)  # edge in the bulk, at the corner [B]
# the continuum tangent takes its time: coarse mesh only
CASES = [(COARSE, name) for name in CHOICES]
CASES += [(FINE, name) for name in CHOICES if name.startswith("consistent")]


def scene(mesh, keys, step):
    mesh = {"mesh.size": mesh[0], "mesh.grading.size": mesh[1]}
    stage = {
        "stage.0.duration": DEPTH,
        "stage.0.step": step,
        "stage.0.step_max": step,
        "stage.0.step_min": FLOOR,
    }
    return common.with_keys(common.PIERCING, mesh | stage | keys)


def share(run):
    s = run.summary
    return s["rejected_steps"] / (s["rejected_steps"] + s["steps"])


def draw(runs):
    fig, axes = common.figure(2, rows=2, width=10.2, height=6.6, sharex=True)
    panels = [
        ("rejected share of all steps tried [%]", lambda r: 100 * share(r)),
        ("Newton iterations of the run", lambda r: r.summary["newton_iterations"]),
        ("reached $z/B$", lambda r: r.reached),
        (r"$p/\sigma_y$ at the end, if reached", lambda r: r.at(DEPTH)),
    ]
    for ax, (label, value) in zip(axes.flat, panels):
        for mesh, name in CASES:
            i = list(CHOICES).index(name)
            coarse = mesh == COARSE
            ax.plot(
                STEPS,
                [value(runs[mesh, name, step]) for step in STEPS],
                color=common.COLOURS[i],
                marker=common.MARKERS[i],
                markersize=7 - i,
                markerfacecolor=None if coarse else "white",
                linewidth=2.6 - 0.6 * i if coarse else 1.2,
                linestyle="-" if coarse else "--",
                label=f"{name}, corner {mesh[1]} B",
            )
        ax.set_ylabel(label)
        ax.set_xscale("log")
    axes[0, 1].set_yscale("log")
    axes[1, 0].set_ylim(0, 1.1 * DEPTH)
    for ax in axes[1]:
        ax.set_xlabel("load step $\\Delta z/B$ asked for")
        ax.set_xticks(STEPS, [f"{s:g}" for s in STEPS])
        ax.minorticks_off()
    axes[0, 0].legend(fontsize=7.5)
    common.save(fig, HERE)


def main():
    cases = {
        (mesh, name, step): scene(mesh, CHOICES[name], step)
        for step in STEPS
        for mesh, name in CASES
    }
    runs = common.run_all(cases)
    common.write_table(
        HERE,
        [
            {
                "edge at corner": mesh[1],
                "choice": name,
                "load step": step,
                "steps": run.summary["steps"],
                "rejected_steps": run.summary["rejected_steps"],
                "rejected [%]": 100 * share(run),
                "newton_iterations": run.summary["newton_iterations"],
                "reached z/B": run.reached,
                "p_sy at 0.05": run.at(DEPTH),
                "seconds": run.seconds,
                "outcome": run.outcome.split(":")[0],
            }
            for (mesh, name, step), run in runs.items()
        ],
    )
    draw(runs)


if __name__ == "__main__":
    main()
