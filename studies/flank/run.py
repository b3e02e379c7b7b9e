# SPDX-License-Identifier: LGPL-3.0-or-later
"""Piercing past z/B = 0.05: what does the punch's flank do to the pressure?"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import common  # noqa: E402

FLANKS = {
    "released": None,
    "smooth": {"wall": {"x": 0.5, "grip": "smooth"}},
    "rough": {"wall": {"x": 0.5, "grip": "rough", "velocity_y": -1.0}},
}
MESHES = [(0.1, 0.025), (0.05, 0.0125)]
DEPTHS = [0.05, 0.10, 0.15, 0.20, 0.25]


def scene(flank, mesh):
    return common.with_keys(
        common.PIERCING,
        {
            "mesh.size": mesh[0],
            "mesh.grading.size": mesh[1],
            "stage.0.duration": 0.25,
            "stage.0.step_min": 0.001 / 256,
            "stage.0.boundary.surface": FLANKS[flank],
        },
    )


def drag(z):
    """Shear strength along a flank of length 2z, over b = B/2 and sigma_y.

    2z: the billet beside the punch is as broad as the punch, and rises by z.
    """
    return 4 * np.asarray(z) / np.sqrt(3)


def flank_share(run):
    """Pressure of what the flank bears, over sigma_y; none if released."""
    c = run.curves
    return 0.0 - c.get("surface.reaction_y", 0 * c["z_B"]) / (0.5 * 20e3)


def flank_share_at(run, z):
    x = run.curves["z_B"]
    return float(np.interp(z, x, flank_share(run))) if x[-1] > z - 1e-9 else np.nan


def total(run):
    """Pressure of all that the punch feels, its flank too, over sigma_y."""
    return run.curves["p_sy"] + flank_share(run)


def total_at(run, z):
    x = run.curves["z_B"]
    return float(np.interp(z, x, total(run))) if x[-1] > z - 1e-9 else np.nan


def draw(runs):
    fig, (left, right) = common.figure(2, width=11.4, height=5)
    colours = dict(zip(FLANKS, common.COLOURS))
    z = np.linspace(0, 0.25, 251)
    for mesh, dash in zip(MESHES, ("--", "-")):
        for flank in ("released", "smooth"):
            run = runs[flank, mesh]
            left.plot(
                run.curves["z_B"],
                total(run),
                color=colours[flank],
                linestyle=dash,
                label=f"{flank}, edge {mesh[1]} B at the corner",
            )
        rough, smooth = runs["rough", mesh], runs["smooth", mesh]
        parts = {
            "on the flank": flank_share(rough),
            "more than smooth on the face": rough.curves["p_sy"]
            - np.interp(
                rough.curves["z_B"], smooth.curves["z_B"], smooth.curves["p_sy"]
            ),
        }
        for (text, value), colour in zip(parts.items(), common.COLOURS[2:]):
            right.plot(
                rough.curves["z_B"],
                value,
                color=colour,
                linestyle=dash,
                label=f"{text}, edge {mesh[1]} B",
            )
    coarse, fine = (runs["smooth", mesh].curves for mesh in MESHES)
    p = np.interp(DEPTHS, fine["z_B"], fine["p_sy"])
    limit = 2 * p - np.interp(DEPTHS, coarse["z_B"], coarse["p_sy"])
    left.plot(
        DEPTHS,
        limit,
        "o",
        color=colours["smooth"],
        markerfacecolor="white",
        label="smooth, both meshes extrapolated (error ~ h)",
    )
    right.plot(z, drag(z), color="black", linewidth=0.9, dashes=(1.5, 1.5))
    right.text(0.252, drag(0.25), r"$4z/\sqrt{3}B$", va="center")
    left.axhline(common.EXACT, color="black", linewidth=1, dashes=(6, 3))
    left.text(0.252, common.EXACT, "2.9685", va="center", fontsize=8.5)
    left.set_ylim(2.9, 3.35)
    left.set_ylabel(r"whole force on the punch, $F/b\sigma_y$")
    left.set_title("Flank released or smooth", fontsize=10)
    right.set_ylabel(r"$\Delta F/b\sigma_y$")
    right.set_title("What a rough flank adds; dotted: drag along 2z", fontsize=10)
    for ax in (left, right):
        ax.set_xlim(0, 0.25)
        ax.set_xlabel("penetration $z/B$")
        ax.legend(fontsize=8.5, loc="upper left")
    common.save(fig, HERE)


def main():
    cases = {(f, m): scene(f, m) for m in MESHES for f in FLANKS}
    runs = common.run_all(cases)
    common.write_table(
        HERE,
        [
            {"flank": flank, "edge": mesh[0], "edge at corner": mesh[1]}
            | {f"F/b sigma_y at {z}": total_at(run, z) for z in DEPTHS}
            | {f"of it flank's at {z}": flank_share_at(run, z) for z in DEPTHS}
            | {
                "noise": noise(run),
                "seconds": run.seconds,
                "rejected_steps": run.summary["rejected_steps"],
                "reached z/B": run.reached,
                "outcome": run.outcome.split(":")[0],
            }
            for (flank, mesh), run in runs.items()
        ],
    )
    draw(runs)


def noise(run):
    """RMS of F/(b sigma_y) about its mean over z +- 0.01 B, past 0.05."""
    z = np.arange(0.05, run.reached - 0.01, 0.001)
    if len(z) < 5:
        return np.nan
    p = np.interp(z, run.curves["z_B"], total(run))
    near = [
        np.interp(z + d, run.curves["z_B"], total(run))
        for d in np.linspace(-0.01, 0.01, 11)
    ]
    return float(np.sqrt(np.mean((p - np.mean(near, axis=0)) ** 2)))


if __name__ == "__main__":
    main()
