# SPDX-License-Identifier: LGPL-3.0-or-later
"""What the scripts of this folder share: start the program, look, and say so."""

import json
import re
import shutil
import subprocess
import sys


def ranked(command, ranks):
    """The command on so many processes."""
    start = ["mpirun", "-n", str(ranks), "--oversubscribe", "--bind-to", "none"]
    return [*(start if ranks > 1 else []), *command]


def finish(command, code, **options):
    """Run to the end, which is to be `code`; what it said."""
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        **options,
    )
    if done.returncode != code:
        sys.exit(f"exit code {done.returncode}, not {code}:\n{done.stdout}")
    return done.stdout


def hold(condition, what):
    print(("holds: " if condition else "FAILS: ") + what, flush=True)
    if not condition:
        sys.exit(1)


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def run_case(cases, case, work):
    """A case, one of the functions in `cases`; its folder goes at the end."""
    try:
        if found := re.fullmatch(r"(\w+_np)_(\d)", case):
            cases[found[1]](int(found[2]))
        else:
            cases[case]()
    finally:
        shutil.rmtree(work, ignore_errors=True)
