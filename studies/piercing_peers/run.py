# SPDX-License-Identifier: LGPL-3.0-or-later
"""Piercing beside CalculiX: error of the pressure and depth against CPU seconds.

With --draw the chart is drawn anew from results.csv. CalculiX is the program
`ccx` on the PATH, or the one that MMALE_CCX names; without it the study says so and
stops, leaving the table as it is.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.insert(0, str(HERE))
import calculix  # noqa: E402
import common  # noqa: E402

DEPTHS = [0.05, 0.10, 0.15, 0.20, 0.25]
TIME_LIMIT = 300  # of one run, of the processor [s]
PATIENCE = 1500  # and of the wall
TARGET = 0.5  # depth that CalculiX is asked for
CUTS = {
    "C3D20R": (10, 20),
    "C3D8R": (20, 40),
    "C3D8I": (20,),
    "C3D8": (20,),
}
REFINE = (1, 2, 4)
NEIGHBOURS = 5  # of the running mean that noise is measured against
TICKS = os.sysconf("SC_CLK_TCK")


def processor(pid):
    """Seconds of the processor of a process, user and system."""
    with open(f"/proc/{pid}/stat") as stream:
        words = stream.read().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / TICKS


def follow(words, folder, measure, environment):
    """Runs a program; its seconds of the processor as `measure()` grows.

    measure  no arguments -> the depth reached so far, from the run's own files
    return   whole seconds, [(depth, seconds)] as first seen, whether it was stopped
    """
    with open(folder / "log", "w") as log:
        process = subprocess.Popen(
            words, cwd=folder, stdout=log, stderr=subprocess.STDOUT, env=environment
        )
        begin = time.monotonic()
        seen, stopped, pid = [(0.0, 0.0)], False, 0
        while not pid:
            time.sleep(0.02)
            depth = measure()
            if depth > seen[-1][0]:
                seen.append((depth, processor(process.pid)))
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid or stopped:
                continue
            waited = time.monotonic() - begin
            if processor(process.pid) > TIME_LIMIT or waited > PATIENCE:
                process.kill()
                stopped = True
        process.returncode = os.waitstatus_to_exitcode(status)
    seconds = usage.ru_utime + usage.ru_stime
    depth = measure()
    if depth > seen[-1][0]:
        seen.append((depth, seconds))
    return seconds, seen, stopped


def noise(curve):
    """Scatter of the pressure beyond z/B = 0.05 about its running mean [c_u].

    Linear between 80 depths, so that fine increments do not hide it; tau_max of
    the metal, c_u = sigma_y / sqrt(3), is the measure of pressure.
    """
    z, p = np.array(curve).T
    if z[-1] < 0.1:
        return np.nan
    at = np.linspace(0.05, min(z[-1], 0.25), 80)
    value = np.interp(at, z, p) * np.sqrt(3)
    kernel = np.ones(NEIGHBOURS) / NEIGHBOURS
    half = NEIGHBOURS // 2
    mean = np.convolve(value, kernel, mode="valid")
    return float(np.std(value[half:-half] - mean))


def last_of_sta(file, depth):
    """Depth of the last converged increment in CalculiX's .sta file."""
    try:
        lines = file.read_text().splitlines()[2:]
    except OSError:
        return 0.0
    done = [w for w in map(str.split, lines) if len(w) == 7 and not w[2].endswith("U")]
    return float(done[-1][5]) * depth if done else 0.0


def run_calculix(program, element, n):
    with tempfile.TemporaryDirectory(prefix="mmale-study-") as folder:
        folder = Path(folder)
        text = calculix.deck(element, n, TARGET, 0.005)
        (folder / "block.inp").write_text(text)
        seconds, seen, stopped = follow(
            [program, "block"],
            folder,
            lambda: last_of_sta(folder / "block.sta", TARGET),
            os.environ | {"OMP_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1"},
        )
        data = (folder / "block.dat").read_text()
        log = (folder / "log").read_text()
    curve = [(0.0, 0.0)] + calculix.read_forces(data, n, TARGET)
    why = "time limit" if stopped else "completed"
    for sign in ("too many cutbacks", "increment size smaller than minimum"):
        if sign in log:
            why = sign
    return table_row(
        "CalculiX", f"{element} {n}/B", n * round(1.5 * n), *(seconds, seen, curve, why)
    )


def last_of_curves(file):
    """Depth of the last whole row of a run's curves.csv."""
    try:
        lines = file.read_text().split("\n")[:-1]
    except OSError:
        return 0.0
    if len(lines) < 2:
        return 0.0
    column = lines[0].split(",").index("z_B")
    return float(lines[-1].split(",")[column])


def run_ours(refine):
    demo = common.ROOT / "demos" / "piercing" / "scene.toml"
    with tempfile.TemporaryDirectory(prefix="mmale-study-") as folder:
        folder = Path(folder)
        words = [os.environ["MMALE_PROGRAM"], "run", str(demo), f"mesh.refine={refine}"]
        words += ["--results", str(folder / "out")]
        seconds, seen, stopped = follow(
            words,
            folder,
            lambda: last_of_curves(folder / "out" / "curves.csv"),
            os.environ | {"OMP_NUM_THREADS": "1", "MMALE_DRAW": os.devnull},
        )
        curves = common.read_curves(folder / "out")
        summary = json.loads((folder / "out" / "summary.json").read_text())
    curve = list(zip(curves["z_B"], curves["p_sy"]))
    why = "time limit" if stopped else summary["outcome"].split(":")[0]
    return table_row(
        "MMALE", f"refine {refine}", summary["cells"], seconds, seen, curve, why
    )


def table_row(code, mesh, elements, seconds, seen, curve, why):
    z, p = np.array(curve).T
    depth, cpu = np.array(seen).T
    out = {
        "code": code,
        "mesh": mesh,
        "elements": elements,
        "CPU s": seconds,
        "reached z/B": float(z[-1]),
        "end": why,
        "noise [c_u]": noise(curve),
    }
    for at in DEPTHS:
        there = z[-1] > at - 1e-6
        excess = 100 * (np.interp(at, z, p) / common.EXACT - 1)
        out[f"error at {at:.2f} [%]"] = float(excess) if there else np.nan
        out[f"CPU s to {at:.2f}"] = (
            float(np.interp(at, depth, cpu)) if there else np.nan
        )
    print(code, mesh, f"{seconds:.1f} s, to {z[-1]:.3f}: {why}", flush=True)
    return out


def draw(rows):
    fig, (left, right) = common.figure(2, width=11, height=4.8)
    for r in rows:
        ours = r["code"] == "MMALE"
        alike = [x for x in rows if x["code"] == r["code"]]
        number = alike.index(r)
        colour = common.COLOURS[0 if ours else 1 + number]
        look = {
            "color": colour,
            "marker": common.MARKERS[number],
            "linestyle": ["-", "--", ":"][number] if ours else "-",
            "linewidth": 2 if ours else 1,
            "label": f"{r['code']} {r['mesh']} ({r['elements']})",
        }
        errors = [(z, r[f"error at {z:.2f} [%]"]) for z in DEPTHS]
        errors = [(z, float(e)) for z, e in errors if e]
        if errors:
            left.plot(*zip(*errors), **look)
        if not float(r["reached z/B"]) > 0.25 - 1e-6 and errors:
            left.plot(*errors[-1], "x", color=colour, markersize=11)
        points = [(r[f"CPU s to {z:.2f}"], r[f"error at {z:.2f} [%]"]) for z in DEPTHS]
        points = [(float(x), float(y)) for x, y in points if x and y]
        if points:
            right.plot(*zip(*points), **look)
    left.set_xlabel("penetration $z/B$")
    left.set_ylabel(r"error of the pressure, over $(2+\pi)/\sqrt{3}$ [%]")
    left.set_title("A cross: it goes no further than the next depth", fontsize=10)
    left.set_ylim(0, 45)
    right.set_ylim(0, 45)
    right.set_xscale("log")
    right.set_xlabel("processor seconds to $z/B$ = 0.05, 0.10 ... 0.25")
    right.legend(fontsize=7.5)
    common.save(fig, HERE)


def main():
    if sys.argv[1:] == ["--draw"]:
        draw(common.read_table(HERE))
        return
    program = os.environ.get("MMALE_CCX") or shutil.which("ccx")
    if not program:
        sys.exit(
            "piercing_peers: no CalculiX: put its program ccx on the PATH or name it "
            "in MMALE_CCX (Debian 12: package calculix-ccx; Debian 13 has none)"
        )
    rows = [run_ours(refine) for refine in REFINE]
    rows += [run_calculix(program, e, n) for e, cuts in CUTS.items() for n in cuts]
    common.write_table(HERE, rows)
    draw(common.read_table(HERE))


if __name__ == "__main__":
    main()
