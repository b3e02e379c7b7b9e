# SPDX-License-Identifier: LGPL-3.0-or-later
"""Runs that are killed, and places that cannot be written; see block.py."""

import ctypes
import os
import random
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

from block import WORK, command, main, near, run, same, scene, stop
from common import hold


def killed(times, seed):
    """After kill -9 at any moment the last whole checkpoint serves."""
    path = scene()
    begun = time.monotonic()
    whole, _ = run(path, "whole")
    length = time.monotonic() - begun
    print(f"seed {seed}, a run takes {length:.2f} s", flush=True)
    chance = random.Random(seed)
    often = "output.checkpoint_every=1e-9"  # at each step: most kills hit a write
    left = times
    completed = 0
    while left > 0:
        shutil.rmtree(WORK / "killed", ignore_errors=True)
        resume = []
        while left > 0:
            process = subprocess.Popen(
                command(path, "killed", often, *resume),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            try:
                said, _ = process.communicate(timeout=chance.uniform(0, 1.3 * length))
                if process.returncode != 0:
                    sys.exit(f"exit code {process.returncode}: {said}")
                break  # it was completed before
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                left -= 1
            there = (WORK / "killed" / "checkpoint.h5").exists()
            resume = ["--resume"] if there else []
        run(path, "killed", often, *resume)
        completed += 1
        same(whole, WORK / "killed")
    hold(completed > 0, f"{times} kills, {completed} runs came to the same end")


def killed_20():
    killed(20, random.randrange(10**6))


def killed_100():
    killed(100, random.randrange(10**6))


def limited(size):
    """For a process that may not write more than so many bytes to a file."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def too_large():
    """A checkpoint that may not grow leaves the older one as it was."""
    path = scene()
    hold(stop(path, "full", 30)[0] == 3, "stopped")
    folder = WORK / "full"
    # fields and curves are smaller than that, the checkpoint is larger
    refused(path, "full", "File too large", preexec_fn=limited(60000))
    run(path, "full", "--resume")
    whole, _ = run(path, "whole")
    same(whole, folder)


def refused(path, name, words, ranks=1, **options):
    """The next checkpoint cannot be written; the last one stays."""
    folder = WORK / name
    older = (folder / "checkpoint.h5").read_bytes()
    often = "output.checkpoint_every=1e-9"
    _, said = run(path, name, often, "--resume", code=2, ranks=ranks, **options)
    hold(f"checkpoint.h5: {words}" in said, f"says: {said.strip()[:200]}")
    hold("HDF5" not in said, "in our words")
    hold((folder / "checkpoint.h5").read_bytes() == older, "the older one is whole")
    hold(not list(folder.glob("*.part")), "no half file is left")


def mount(folder, size):
    """A disk of its own for this process and its children; or skip."""
    libc = ctypes.CDLL(None, use_errno=True)
    user, group = os.geteuid(), os.getegid()
    new_mounts, new_user = 0x20000, 0x10000000
    folder.mkdir()
    error = ""
    if libc.unshare(new_user | new_mounts) != 0:
        error = os.strerror(ctypes.get_errno())
    else:
        Path("/proc/self/setgroups").write_text("deny")
        Path("/proc/self/uid_map").write_text(f"0 {user} 1")
        Path("/proc/self/gid_map").write_text(f"0 {group} 1")
        options = f"size={size}".encode()
        if libc.mount(b"none", str(folder).encode(), b"tmpfs", 0, options) != 0:
            error = os.strerror(ctypes.get_errno())
    if error:
        print(f"skipped, no disk can be mounted here: {error}")
        sys.exit(77)


def full_disk_np(ranks):
    """On a full disk no half file is left, the older checkpoint serves."""
    disk = WORK / "disk"
    mount(disk, 4 << 20)
    path = scene()
    hold(stop(path, "disk/run", 30, ranks=ranks)[0] == 3, "stopped")
    room = os.statvfs(disk)
    fill = disk / "fill"
    # enough for curves and fields, not for the checkpoint
    fill.write_bytes(bytes(room.f_bavail * room.f_bsize - 120000))
    refused(path, "disk/run", "No space left on device", ranks=ranks)
    fill.unlink()
    run(path, "disk/run", "--resume", ranks=ranks)
    whole, _ = run(path, "whole", ranks=ranks)
    same(whole, disk / "run") if ranks == 1 else near(whole, disk / "run")


def blocked_np(ranks):
    """A place that turns unwritable ends the run, in words, with code 2."""
    path = scene()
    # a folder in its place works for root too, who may write everywhere
    place = WORK / "blocked" / "checkpoint.h5.part"
    code, said = stop(path, "blocked", 20, ranks=ranks, before=place.mkdir)
    hold(code == 2, f"exit code {code}")
    hold("checkpoint.h5: Is a directory" in said, f"says: {said.strip()[:200]}")
    hold(not (WORK / "blocked" / "checkpoint.h5").exists(), "no checkpoint")


if __name__ == "__main__":
    main(globals())
