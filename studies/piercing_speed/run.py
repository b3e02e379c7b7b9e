# SPDX-License-Identifier: LGPL-3.0-or-later
"""Which choices of the Lagrangian step are fast, and what do they cost?

With --draw the chart is drawn anew from results.csv.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

PATIENT = {"solver.max_iterations": 60}
CONTINUUM = {"solver.tangent": "continuum"}
CHOICES = {
    "default": {},
    "no plastic bubble": {"solver.plastic_bubble": False},
    "no geometric stiffness": {"solver.geometric_stiffness": False},
    "no line search": {"solver.line_search": False},
    "factorise every 2nd": {"solver.lag_jacobian": 2},
    "factorise every 2nd, 60 it": {"solver.lag_jacobian": 2} | PATIENT,
    "factorise every 3rd": {"solver.lag_jacobian": 3},
    "factorise every 3rd, 60 it": {"solver.lag_jacobian": 3} | PATIENT,
    "continuum tangent": CONTINUUM,
    "continuum tangent, 60 it": CONTINUUM | PATIENT,
    "step 0.0005": {"stage.0.step": 0.0005},
    "step 0.002": {"stage.0.step": 0.002},
    "step 0.002, no line search": {
        "stage.0.step": 0.002,
        "solver.line_search": False,
    },
}
# A run that cannot go on at a 32nd of the default step is given up.
FLOOR = {"stage.0.step_min": 0.001 / 32}
Z = 0.05


def draw(rows):
    fig, (left, right) = common.figure(
        2, width=10.2, height=4.8, sharey=True, width_ratios=[1.4, 1]
    )
    rows = rows[::-1]
    names = [r["choice"] for r in rows]
    seconds = [float(r["seconds"]) for r in rows]
    top = max(seconds)
    for y, (row, time) in enumerate(zip(rows, seconds)):
        whole = row["outcome"] == "completed"
        colour = common.COLOURS[1 if row["choice"] == "default" else 0]
        look = {"color": colour} if whole else {"facecolor": "white", "hatch": "////"}
        left.barh(y, time, height=0.65, edgecolor=colour, **look)
        text = f"{row['newton_iterations']} it, {row['rejected_steps']} rej."
        if not whole:
            text += f", stops at {float(row['reached z/B']):.3f}"
        left.text(time + 0.02 * top, y, text, va="center", fontsize=8.5)
        if row["excess [%]"] not in ("", float("nan")):
            excess = float(row["excess [%]"])
            right.plot(
                excess,
                y,
                "o",
                color=colour,
                markersize=6,
                markerfacecolor=colour if whole else "white",
            )
            right.annotate(
                f"{excess:.2f}",
                (excess, y),
                (7, 0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
            )
    left.set_yticks(range(len(names)), names)
    left.set_xlim(0, 1.3 * top)
    left.set_xlabel("processor time to $z/B = 0.06$ [s]")
    left.set_title("Cost (hatched: stops early)", fontsize=10)
    right.margins(x=0.15)
    right.set_xlabel(r"excess over $(2+\pi)/\sqrt{3}$ at $z/B = 0.05$ [%]")
    right.set_title("Error", fontsize=10)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        draw(common.read_table(HERE))
        return
    scenes = {
        name: common.with_keys(common.PIERCING, FLOOR | keys)
        for name, keys in CHOICES.items()
    }
    runs = common.run_all(scenes, repeats=3)
    rows = [
        {
            "choice": name,
            "seconds": run.seconds,
            "newton_iterations": run.summary["newton_iterations"],
            "steps": run.summary["steps"],
            "rejected_steps": run.summary["rejected_steps"],
            "p_sy at z/B 0.05": run.at(Z),
            "excess [%]": run.excess(Z),
            "reached z/B": run.reached,
            "outcome": run.outcome.split(":")[0],
        }
        for name, run in runs.items()
    ]
    common.write_table(HERE, rows)
    draw(common.read_table(HERE))


if __name__ == "__main__":
    main()
