# SPDX-License-Identifier: LGPL-3.0-or-later
"""Runs of block.toml that are stopped: SCRIPT PROGRAM COMPARE DEMOS CASE.

Each case is a function of its script, its first line the sentence that it holds.
Cases NAME_np_N run on N processes. Needs the standard library only.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from common import finish, hold, ranked, run_case

PROGRAM, COMPARE, DEMOS = (Path(word).resolve() for word in sys.argv[1:4])
WORK = Path(tempfile.mkdtemp(prefix="mmale_checkpoints_"))  # folder of this case

SCENE = Path(__file__).with_name("block.toml").read_text()


def scene():
    path = WORK / "scene" / "block.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(SCENE)
    return path


def command(path, results, *words, ranks=1):
    words = [*words, "--results", str(WORK / results), "--quiet"]
    return ranked([str(PROGRAM), "run", str(path), *words], ranks)


def run(path, results, *words, code=0, ranks=1, **options):
    """Run to the end; its folder and what it said."""
    said = finish(command(path, results, *words, ranks=ranks), code, **options)
    return WORK / results, said


def rows(folder):
    file = folder / "curves.csv"
    return file.read_text().count("\n") - 1 if file.exists() else 0


def same_checkpoint(a, b, tolerance=0.0):
    words = [str(COMPARE), *(str(f / "checkpoint.h5") for f in (a, b))]
    words += [str(tolerance)] if tolerance else []
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    hold(done.returncode == 0, f"{b.name} against {a.name}: {done.stdout.strip()}")


def same(a, b):
    """Bit by bit: curves, the last checkpoint, the lines; the same outputs."""
    texts = [(f / "curves.csv").read_text() for f in (a, b)]
    hold(texts[0] == texts[1], f"curves of {b.name} are those of {a.name}")
    same_checkpoint(a, b)
    for line in sorted((a / "lines").glob("*.csv")):
        other = b / "lines" / line.name
        hold(other.read_text() == line.read_text(), f"{line.name} is the same")
    whole_series(a, b)


def outputs(folder):
    """Time and text of all pieces of each output."""
    text = (folder / "fields.pvd").read_text()
    found = re.findall(r'timestep="([^"]+)"[^>]*file="([^"]+)"', text)
    out = []
    for t, name in found:
        pieces = re.findall(r'Source="([^"]+)"', (folder / name).read_text())
        out.append((float(t), [(folder / p).read_text() for p in pieces]))
    return out


def whole_series(a, b):
    x, y = outputs(a), outputs(b)
    hold([t for t, _ in x] == [t for t, _ in y], f"{len(x)} outputs in both series")
    hold(x == y, "with the same fields")
    named = sum(len(pieces) + 1 for _, pieces in y)
    files = len(list(b.glob("fields*vtu")))
    hold(files == named, f"{files} field files and no other")


def start_and_wait(path, results, count, *words, ranks=1):
    """A run in the background that has made so many steps."""
    process = subprocess.Popen(
        command(path, results, *words, ranks=ranks),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    deadline = time.monotonic() + 120
    while rows(WORK / results) < count and process.poll() is None:
        if time.monotonic() > deadline:
            process.kill()
            sys.exit("the run does not get on")
        time.sleep(0.001)
    return process


def stop(path, results, count, *words, ranks=1, by=signal.SIGUSR1, before=None):
    """Stop a run after so many steps by a signal; its exit code and what it said.

    A signal that comes after the last step finds nothing to stop: then again.
    mpirun forwards USR1 alone unharmed.
    """
    for _ in range(20):
        shutil.rmtree(WORK / results, ignore_errors=True)
        process = start_and_wait(path, results, count, *words, ranks=ranks)
        if before:
            before()
        process.send_signal(by)
        said, _ = process.communicate(timeout=60)
        if process.returncode not in (0, -by, 128 + by):
            break
    return process.returncode, said


def near(a, b):
    # Newton stops at 1e-8 of the forces; over 80 steps of plastic flow and of
    # smoothing this leaves less than a hundred times as much
    hold(rows(a) == rows(b), f"{rows(a)} rows in both")
    same_checkpoint(a, b, 1e-6)


def main(cases):
    """Run the case of the command line, one of the functions in `cases`."""
    # pictures would take most of the time
    os.environ["MMALE_DRAW"] = str(WORK / "nothing.py")
    (WORK / "nothing.py").touch()
    run_case(cases, sys.argv[4], WORK)
