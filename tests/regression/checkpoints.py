# SPDX-License-Identifier: LGPL-3.0-or-later
"""Stopping and resuming: checkpoints.py PROGRAM COMPARE DEMOS CASE.

Each case is a function below, its first line the sentence that it holds. Cases
NAME_np_N run on N processes. Needs the standard library only.
"""

import ctypes
import hashlib
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from common import finish, hold, ranked, summary

PROGRAM, COMPARE, DEMOS = (Path(word).resolve() for word in sys.argv[1:4])
WORK = Path()  # folder of this case

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


# --- going on -------------------------------------------------------------------


def resume_np(ranks):
    """A run that was stopped goes on as if it had not been."""
    path = scene()
    whole, _ = run(path, "whole", ranks=ranks)
    for count in (7, 66):  # in the first stage and in the second
        name = f"stopped_{count}"
        code, _ = stop(path, name, count, ranks=ranks)
        hold(code == 3, f"exit code {code}")
        folder = WORK / name
        hold(summary(folder)["outcome"] == "stopped by a signal", "says so")
        hold(count <= rows(folder) < rows(whole), f"after {rows(folder)} rows")
        run(path, name, "--resume", ranks=ranks)
        hold(summary(folder)["resumed"] == 1, "was resumed once")
        if ranks == 1:
            same(whole, folder)
        else:
            near(whole, folder)


def near(a, b):
    # Newton stops at 1e-8 of the forces; over 80 steps of plastic flow and of
    # smoothing this leaves less than a hundred times as much
    hold(rows(a) == rows(b), f"{rows(a)} rows in both")
    same_checkpoint(a, b, 1e-6)


WATER = """
[water]
drainage = "seepage"
porosity = 0.4
permeability = 1e-3
"""


def layouts():
    """Points with stresses of their own, inertia and pore water go on bit by bit."""
    path = scene()
    inertia = """
[stage.dynamics]
beta = 0.3025
gamma = 0.6
damping_mass = 1.0
damping_stiffness = 1e-4
"""
    drained = ["stage.push.boundary.surface.drained=true"]
    drained += ["stage.slow.boundary.surface.seepage_face=true"]
    drained += ["stage.slow.dynamics.damping_stiffness=0"]
    first, second = SCENE.split("[[stage]]")[1:]
    stage, rest = second.split("[remap]")
    shaking = "[[stage]]".join([SCENE.split("[[stage]]")[0], first, stage + inertia])
    for name, text, *words in (
        ("three", SCENE, "solver.layout=quadrature", "solver.points=3"),
        ("six", SCENE, "solver.layout=quadrature", "solver.points=6"),
        ("dynamic", shaking + "[remap]" + rest),
        ("both", shaking + "[remap]" + rest, "solver.layout=quadrature"),
        ("undrained", SCENE + WATER, "water.drainage=undrained"),
        ("seepage", shaking + "[remap]" + rest + WATER, *drained),
    ):
        path.write_text(text)
        whole, _ = run(path, name, *words)
        for count in (30, 66):
            stopped = f"{name}_stopped_{count}"
            hold(stop(path, stopped, count, *words)[0] == 3, "stopped")
            run(path, stopped, *words, "--resume")
            same(whole, WORK / stopped)


def other_ranks():
    """A run begun on one process goes on upon two, and the other way."""
    path = scene()
    whole, _ = run(path, "whole")
    for before, after in ((1, 2), (3, 1)):
        name = f"from_{before}_to_{after}"
        hold(stop(path, name, 20, ranks=before)[0] == 3, "stopped")
        run(path, name, "--resume", ranks=after)
        near(whole, WORK / name)


def piercing():
    """The piercing test, graded mesh and punch, goes on bit by bit."""
    words = ["mesh.refine=1", "stage.push.duration=0.1"]
    path = DEMOS / "piercing" / "scene.toml"
    whole, _ = run(path, "whole", *words)
    code, _ = stop(path, "stopped", 40, *words, by=signal.SIGTERM)
    hold(code == 3, "stopped by TERM")
    run(path, "stopped", *words, "--resume")
    same(whole, WORK / "stopped")


def sweep():
    """A sweep goes on: done members are skipped, later ones start."""
    path = scene()
    # the second is long enough to be stopped in its midst
    values = "stage.push.step=0.001,0.0001,0.0012"
    whole, _ = run(path, "whole", values)
    names = [f"stage.push.step={v}" for v in ("0.001", "0.0001", "0.0012")]
    process = subprocess.Popen(
        command(path, "stopped", values),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    while rows(WORK / "stopped" / names[1]) < 10 and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGUSR1)
    hold(process.wait(60) == 3, "stopped in the second member")
    hold(not (WORK / "stopped" / names[2]).exists(), "the third has not begun")
    first = (WORK / "stopped" / names[0] / "checkpoint.h5").stat().st_mtime_ns
    _, said = run(path, "stopped", values, "--resume")
    hold("is completed" in said, "the first is said to be completed")
    again = (WORK / "stopped" / names[0] / "checkpoint.h5").stat().st_mtime_ns
    hold(first == again, "and left alone")
    for name in names:
        same(whole / name, WORK / "stopped" / name)
    tables = [(f / "sweep.csv").read_text() for f in (whole, WORK / "stopped")]
    hold(tables[0] == tables[1], "sweep.csv is the same")


def longer():
    """A completed run says so; with a longer stage there is more to do."""
    path = scene()
    whole, _ = run(path, "whole")
    folder, _ = run(path, "short", "stage.slow.duration=0.01")
    _, said = run(path, "short", "stage.slow.duration=0.01", "--resume")
    hold("is completed" in said, f"says: {said.strip()}")
    run(path, "short", "--resume")
    hold(rows(folder) == rows(whole), f"{rows(folder)} rows in the end")
    # the end of the short run was an output of its own, met to the last digit
    words = [str(COMPARE), *(str(f / "checkpoint.h5") for f in (whole, folder))]
    said = subprocess.run([*words, "1e-9"], stdout=subprocess.PIPE, text=True).stdout
    differ = said.splitlines()[:-1]
    hold(differ == ["run/outputs is another number"], f"the same but: {differ}")


# --- what cannot go on -------------------------------------------------------------


def refusals():
    """What cannot be resumed is told: no, another, cut, foreign, old checkpoint."""
    path = scene()
    _, said = run(path, "none", "--resume", code=1)
    hold("no checkpoint" in said, f"none: {said.strip()}")
    folder, _ = run(path, "done", "stage.push.duration=0.01")
    file = folder / "checkpoint.h5"
    whole = file.read_bytes()
    changed = ["mesh.cells=[6,5]", "material.block.nu=0.2", "solver.tolerance=1e-9"]
    _, said = run(path, "done", *changed, "--resume", code=1)
    for key in ("mesh.cells", "material.block.nu"):
        hold(key in said, f"{key} is named")
    hold("solver.tolerance" not in said, "how hard it tries may change")
    hold(file.read_bytes() == whole, "and nothing is touched")
    for name, content, words in (
        ("cut", whole[: len(whole) // 2], "damaged"),
        ("foreign", b"t,x\n0,1\n" * 500, "is no checkpoint"),
        ("empty", b"", "is no checkpoint"),
    ):
        file.write_bytes(content)
        for ranks in (1, 2):
            _, said = run(path, "done", "--resume", code=1, ranks=ranks)
            hold(words in said and "checkpoint.h5" in said, f"{name}: {said.strip()}")
            hold("HDF5-DIAG" not in said, "in our words")
        hold(file.read_bytes() == content, "the file is left as it is")


def afresh():
    """Without --resume a run starts again, says so, and mixes nothing up."""
    path = scene()
    whole, _ = run(path, "whole")
    code, _ = stop(path, "again", 70, by=signal.SIGINT)
    hold(code == 3, "stopped by INT")
    folder, said = run(path, "again")
    hold("starts afresh" in said and said.count("\n") == 1, said.strip())
    hold(summary(folder)["resumed"] == 0, "was not resumed")
    same(whole, folder)
    _, said = run(path, "again")
    hold(said == "", "nothing is said of a run that was completed")


# --- crashes ----------------------------------------------------------------------


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


# --- through the launcher -------------------------------------------------------------


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


def main():
    global WORK
    case = sys.argv[4]
    WORK = Path(tempfile.mkdtemp(prefix="mmale_checkpoints_"))
    # pictures would take most of the time
    os.environ["MMALE_DRAW"] = str(WORK / "nothing.py")
    (WORK / "nothing.py").touch()
    try:
        if found := re.fullmatch(r"(\w+_np)_(\d)", case):
            globals()[found[1]](int(found[2]))
        else:
            globals()[case]()
    finally:
        shutil.rmtree(WORK, ignore_errors=True)


if __name__ == "__main__":
    main()
