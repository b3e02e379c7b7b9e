# SPDX-License-Identifier: LGPL-3.0-or-later
"""Stopping and resuming through the launcher; see block.py."""

import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from block import DEMOS, PROGRAM, SCENE, WORK, main, rows
from common import hold


def project(environment):
    """A copy of the launcher whose build is done: its program is ours."""
    here = WORK / "project"
    source = DEMOS.parent
    build = here / "build" / "release"
    (build / "cpp").mkdir(parents=True)
    shutil.copytree(source / "cmake" / "launcher", here / "cmake" / "launcher")
    for name in ("mmale", "packages.txt", "CMakePresets.json"):
        shutil.copy2(source / name, here / name)
    shutil.copy2(PROGRAM, build / "cpp" / "mmale")
    (build / "build.ninja").write_text("")
    (here / "build" / "release.environment").write_text(environment(here) + "\n")
    (here / "scene").mkdir()
    (here / "scene" / "block.toml").write_text(SCENE)
    return here


def stopped_by_launcher(here, settings, ranks):
    """INT and TERM, to the launcher alone and to its group."""
    variables = {**os.environ, **settings, "OMPI_MCA_btl": "self,sm"}
    words = [str(here / "mmale"), "run", "scene/block.toml", "--quiet"]
    words += ["stage.push.step=0.0001"]  # long enough to be stopped in its midst
    words += ["-n", str(ranks)] if ranks > 1 else []
    options = dict(cwd=here, env=variables, stdin=subprocess.DEVNULL)

    def call(*more):
        done = subprocess.run(
            [*words, *more],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            **options,
        )
        hold(done.returncode == 0, f"{' '.join(more)}: {done.stdout.strip()[:300]}")

    call("--results", "whole")
    whole = (here / "whole" / "curves.csv").read_text()
    end = rows(here / "whole")
    for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
        both = (os.kill, os.killpg)
        # two processes on few cores are slow to start: one of each
        one = both[:1] if number == signal.SIGINT else both[1:]
        for send in both if ranks == 1 else one:
            name = f"{number.name}_{send.__name__}"
            process = subprocess.Popen(
                [*words, "--results", name],
                start_new_session=True,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                **options,
            )
            deadline = time.monotonic() + 60
            while rows(here / name) < 10 and time.monotonic() < deadline:
                time.sleep(0.005)
            send(process.pid, number)
            ended = process.wait(60)
            hold(ended == code, f"{name}: exit code {ended}")
            hold(rows(here / name) < end, f"after {rows(here / name)} rows")
            call("--results", name, "--resume")
            if ranks == 1:
                text = (here / name / "curves.csv").read_text()
                hold(text == whole, "resumed bit by bit")
            hold(rows(here / name) == end, "resumed to the end")


def launcher_np(ranks):
    """Signals through the launcher save the run; the launcher resumes it."""
    here = project(lambda _: "native, for a test")
    stopped_by_launcher(here, {"MMALE_INSIDE": "native, for a test"}, ranks)


def launcher_root_np(ranks):
    """The same inside a root entered by bubblewrap, where that is possible.

    MMALE_TEST_ROOT names the root; without it the system is its own.
    """
    source = Path(os.environ.get("MMALE_TEST_ROOT", "/"))
    bwrap = shutil.which("bwrap")
    possible = bwrap and subprocess.run(
        [bwrap, "--dev-bind", "/", "/", "true"], stderr=subprocess.DEVNULL
    )
    if not possible or possible.returncode != 0:
        print("skipped: bubblewrap makes no namespace here")
        sys.exit(77)

    def environment(here):
        lines = (here / "packages.txt").read_text().splitlines()
        names = {re.sub(r"\s", "", line.split("#")[0]) for line in lines} - {""}
        text = "".join(f"{name}\n" for name in sorted(names))
        key = hashlib.sha256(text.encode()).hexdigest()[:12]
        root = WORK / "cache" / f"debian13-{key}"
        root.mkdir(parents=True)
        for name in ("usr", "etc", "var"):
            (root / name).symlink_to(source / name)
        return f"root {root} {here}"

    here = project(environment)
    stopped_by_launcher(here, {"MMALE_CACHE": str(WORK / "cache")}, ranks)


if __name__ == "__main__":
    main(globals())
