#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-3.0-or-later
# Tests of the launcher of the tree in folder $1, each in its own sandbox
# (fakes.sh). Every test says a sentence; what it expects is written by hand.
# shellcheck disable=SC2016 # $ in single quotes is for the fakes to expand
set -u -o pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
# shellcheck source=tests/launcher/fakes.sh
source "$(dirname "${BASH_SOURCE[0]}")/fakes.sh"

# The launcher with arguments "$@" in the sandbox; nothing of the caller's
# environment reaches it. Only for subshells, which it becomes.
mmale()
{
  exec env -i --default-signal PATH="$bin" BIN="$bin" FAKE="$fake" HOME="$sandbox/home" \
    TMPDIR="$sandbox/tmp" MMALE_SYSTEM_FILES="$sandbox/files" "${settings[@]}" \
    "$project/mmale" "$@"
}

# Calls it, keeps what it says and its exit code.
call()
{
  out=$(cd "$project" && mmale "$@" 2>&1 < /dev/null)
  code=$?
}

begin()
{
  sentence=$1 settings=()
  new_sandbox
  stand_in
  echo "- $sentence"
}

wrong()
{
  failed=1
  printf 'FAILED: %s\n  %s\n  said (%s): %s\n' "$sentence" "$1" "${code:-}" "${out:-}"
}

expect_code() { [[ $code == "$1" ]] || wrong "exit code $code, not $1"; }
expect() { [[ $out == *"$1"* ]] || wrong "did not say: $1"; }
expect_one_line() { [[ $out != *$'\n'* ]] || wrong "more than one line"; }
expect_log() { grep -qF -- "$1" "$fake/log" || wrong "no call of: $1"; }
expect_no_log() { ! grep -qF -- "$1" "$fake/log" || wrong "a call of: $1"; }
expect_count()
{
  [[ $(awk -v s="$1" 'index($0, s) == 1' "$fake/log" | wc -l) == "$2" ]] \
    || wrong "not $2 calls of: $1"
}
roots() { find "$1" -maxdepth 1 -name 'debian13-*' ! -name '*.log' ! -name '*.users' | sort; }
expect_roots() { [[ $(roots "$1" | wc -l) == "$2" ]] || wrong "roots: $(roots "$1")"; }
cache() { echo "$sandbox/home/.cache/mmale"; }

# Waits up to 10 s for a file.
await()
{
  local i
  for ((i = 0; i < 200; i++)); do [[ -e $1 ]] && return; sleep 0.05; done
  wrong "never came: $1"
}

# --- words ---------------------------------------------------------------------

begin "--help names every verb and touches nothing"
call --help
expect_code 0
for word in demo run check element test study shell MMALE_CACHE; do expect "$word"; done
[[ ! -e $project/build ]] || wrong "made a build folder"

begin "an unknown verb is answered with the nearest"
call chek
expect_code 1
expect "no verb 'chek'; nearest: check;"
expect_one_line

begin "no verb at all prints the usage and fails"
call
expect_code 2
expect "usage:"

begin "an unknown demo is answered with the nearest and the list"
call demo cook_membran
expect_code 1
expect "no demo called 'cook_membran'; nearest: cook_membrane; all: cook_membrane piercing"
expect_one_line
[[ ! -e $project/build ]] || wrong "built before it looked at the name"

begin "an unknown study, and none, are answered with the list"
call study sped
expect_code 1
expect "no study called 'sped'; nearest: speed"
call study
expect_code 1
expect "name one of: speed"

begin "a scene that is not there, and a bad number of ranks, are refused"
call run nothing.toml
expect_code 1
expect "no scene file 'nothing.toml'"
call run demos/piercing/scene.toml -n two
expect_code 1
expect "-n wants a number of ranks, not 'two'"

# --- the four ways ---------------------------------------------------------------

begin "way 1: a DOLFINx that CMake finds is used, and found only once"
touch "$fake/native"
call demo mesh.size=0.1
expect_code 0
expect "program run demos/piercing/scene.toml mesh.size=0.1 commit=unknown threads=1"
call demo
expect_count "cmake -G Ninja" 1
expect_count "cmake --preset release" 1
expect_no_log bwrap
expect_no_log apt-get

begin "way 1: when DOLFINx has gone, another way is looked for"
touch "$fake/native"
call demo
rm "$fake/native"
call demo
expect_code 0
expect_log mmdebstrap
expect_count "cmake --preset release" 2

begin "way 2: apt is asked, as root, for what is missing of the list, by name"
echo 1:0.9.0-7 > "$fake/candidate"
echo "g++ installed" > "$fake/installed"
touch "$fake/brings.ninja-build"
call demo
expect_code 0
expect "installing with apt: ninja-build"
expect_log "apt_get -o DPkg::Lock::Timeout=600 install -y --no-install-recommends ninja-build"
expect_no_log mmdebstrap
expect_no_log sudo

begin "way 2: empty lists of apt are filled first"
echo 1:0.10.0-1 > "$fake/offer"
touch "$fake/brings.g++"
call demo
expect_code 0
expect_log "apt_get update"
expect_no_log mmdebstrap

begin "way 2: a user installs with sudo"
echo 1000 > "$fake/uid"
echo 1:0.9.0-7 > "$fake/candidate"
touch "$fake/brings.g++"
call demo
expect_code 0
expect_log "sudo apt-get update"
expect_log "sudo env DEBIAN_FRONTEND=noninteractive apt-get"

begin "way 2: without a network it says so"
echo 1:0.9.0-7 > "$fake/candidate"
touch "$fake/no-network"
call demo
expect_code 1
expect "no network"

begin "way 3: an old DOLFINx in apt is no offer; a private root is made once"
echo 1:0.5.2-2+b1 > "$fake/candidate"
call demo
expect_code 0
expect_log "mmdebstrap --mode=unshare --variant=apt"
expect_log "--include=g++,ninja-build trixie -"
expect_roots "$(cache)" 1
grep -q "'' SIGUSR1" "$fake/bwrap-ignores" || wrong "bubblewrap would die of USR1"
call demo
expect_code 0
expect_count "mmdebstrap --mode" 1
expect_count "cmake --preset release" 1

begin "way 3: project, scene, current and results folders are writable, / is not"
mkdir "$sandbox/scenes" "$sandbox/out"
touch "$sandbox/scenes/a.toml"
call run "$sandbox/scenes/a.toml" --results "$sandbox/out/run"
expect_code 0
for folder in "$project" "$sandbox/scenes" "$sandbox/out/run" "$(cache)/home"; do
  expect_log "--bind-try $folder $folder"
done
out=$(cd / && mmale shell -- true 2>&1)
expect_no_log "--bind-try / /"

begin "way 3: a missing tool is installed where root may"
for pair in mmdebstrap:mmdebstrap bubblewrap:bwrap uidmap:newuidmap; do
  mv "$bin/${pair#*:}" "$bin/away.${pair%:*}"
  echo "${pair#*:}" > "$fake/tool.${pair%:*}"
done
call demo
expect_code 0
expect "installing with apt: mmdebstrap bubblewrap uidmap"

for pair in mmdebstrap:mmdebstrap bubblewrap:bwrap uidmap:newuidmap; do
  begin "way 3: a missing ${pair#*:} is named where root may not help"
  echo 1000 > "$fake/uid"
  rm "$bin/${pair#*:}" "$bin/sudo"
  printf 'someone:100000:65536\n' | tee "$sandbox/files/etc/subuid" > "$sandbox/files/etc/subgid"
  call demo
  expect_code 1
  expect "ask root for: apt-get install ${pair%:*}"
done

begin "way 4: without apt the tools and the container are named"
rm "$bin/mmdebstrap" "$bin/apt_get" "$bin/apt-get" "$bin/apt-cache"
call demo
expect_code 1
expect "missing here: mmdebstrap"
expect "docker build"

begin "a user without subordinate ids is told the remedy"
echo 1000 > "$fake/uid"
call demo
expect_code 1
expect "usermod --add-subuids 100000-165535 --add-subgids 100000-165535 someone"
expect_no_log mmdebstrap

begin "Debian's missing key is told with its remedy"
rm "$sandbox"/files/usr/share/keyrings/*trixie*
call demo
expect_code 1
expect "debian-archive-keyring"
expect_no_log mmdebstrap

begin "a bubblewrap that may not make namespaces is told before the download"
touch "$fake/no-namespace"
call demo
expect_code 1
expect "bubblewrap may not make a namespace here"
expect_no_log mmdebstrap

# --- trouble on the way --------------------------------------------------------

begin "no folder for the cache: said in words, and no download"
touch "$sandbox/file"
settings=(HOME="$sandbox/file" MMALE_CACHE="$sandbox/file/cache")
call demo
expect_code 1
expect "cannot write $sandbox/file/cache"
expect "cannot write $sandbox/file/.cache/mmale"
expect "set MMALE_CACHE"
expect_no_log mmdebstrap

begin "a cache that cannot be written is passed over for the next"
touch "$sandbox/file"
settings=(MMALE_CACHE="$sandbox/file/cache" XDG_CACHE_HOME="$sandbox/xdg")
call demo
expect_code 0
expect_roots "$sandbox/xdg/mmale" 1

begin "a build goes on with its root when MMALE_CACHE is no longer set"
settings=(MMALE_CACHE="$sandbox/elsewhere")
call demo
settings=()
call demo
expect_code 0
expect_count "mmdebstrap --mode" 1

begin "no space in the cache, then none for making it, are told; then it works"
echo 0.5 > "$fake/candidate"
echo 1000 > "$fake/free"
call demo
expect_code 1
expect "no space: $(cache) has 1000 MB, a root takes 3500"
expect_one_line
echo 6000 > "$fake/free"
call demo
expect_code 1
expect "no space: making the root takes 4500 MB in /tmp or /var/tmp"
expect_no_log mmdebstrap
echo 8100 > "$fake/free"
call demo
expect_code 0

begin "no network is told; the next call recovers"
touch "$fake/no-network"
call demo
expect_code 1
expect "no network"
expect_roots "$(cache)" 0
rm "$fake/no-network"
call demo
expect_code 0
expect_roots "$(cache)" 1

begin "a set-up killed outright leaves only .part, which the next call clears"
echo 30 > "$fake/slow"
set -m
mmale demo > "$sandbox/said" 2>&1 &
set +m
for ((i = 0; i < 200; i++)); do grep -q '^mmdebstrap' "$fake/log" && break; sleep 0.05; done
first=$!
grep -lsaz "^FAKE=$fake" /proc/[0-9]*/environ | cut -d / -f 3 | while read -r pid; do
  kill -KILL "$pid" 2> /dev/null
done
wait "$first" 2> /dev/null
[[ $(roots "$(cache)") == *.part ]] || wrong "left: $(roots "$(cache)")"
touch "$(roots "$(cache)")/rubbish"
rm "$fake/slow"
call demo
expect_code 0
expect_roots "$(cache)" 1
[[ ! -e $(roots "$(cache)")/rubbish ]] || wrong "took over what was left"
[[ -z $(ls "$sandbox/tmp") ]] || wrong "left in the scratch folder: $(ls "$sandbox/tmp")"

for way in INT:130 TERM:143; do
  begin "a set-up stopped by ${way%:*} ends at once with ${way#*:} and leaves nothing"
  echo 30 > "$fake/slow"
  set -m
  mmale demo > "$sandbox/said" 2>&1 &
  set +m
  for ((i = 0; i < 200; i++)); do grep -q '^mmdebstrap' "$fake/log" && break; sleep 0.05; done
  kill -s "${way%:*}" $!
  wait $!
  code=$?
  out=$(cat "$sandbox/said")
  expect_code "${way#*:}"
  expect "interrupted; the next call begins again"
  expect_roots "$(cache)" 0
done

begin "two calls at once: one makes the root, the other waits and uses it"
echo 1 > "$fake/slow"
mmale demo > "$sandbox/one" 2>&1 &
mmale demo > "$sandbox/two" 2>&1 &
wait
out=$(cat "$sandbox/one" "$sandbox/two")
expect "waiting for another call"
expect_count "mmdebstrap --mode" 1
expect_count "program run" 2
expect_count "cmake --preset release" 1

begin "a changed package list makes a new root and removes the old one"
call demo
before=$(roots "$(cache)")
printf '# a comment more\n\n ninja-build\ng++ # other words\n' > "$project/packages.txt"
call demo
expect_count "mmdebstrap --mode" 1
echo cmake >> "$project/packages.txt"
call demo
expect_code 0
expect_roots "$(cache)" 1
[[ $(roots "$(cache)") != "$before" ]] || wrong "the root is the old one"
expect_count "cmake --preset release" 2

begin "the old root stays while another project, or a run, uses it"
call demo
before=$(roots "$(cache)")
mkdir "$sandbox/other"
touch "$sandbox/other/packages.txt"
echo "$sandbox/other" >> "$before.users"
echo cmake >> "$project/packages.txt"
call demo
expect_roots "$(cache)" 2
rm -r "$sandbox/other"
echo bison >> "$project/packages.txt"
flock -s "$before" sleep 30 &
lock=$!
call demo
expect_roots "$(cache)" 2
[[ -d $before ]] || wrong "removed the root under a run"
kill "$lock"

begin "a project folder that cannot be written is told"
touch "$fake/native"
touch "$project/build"
call demo
expect_code 1
expect "cannot write $project/build"
expect_one_line

# --- the build --------------------------------------------------------------------

begin "a build that fails shows the end of its log; the next call recovers"
touch "$fake/break-build"
call demo
expect_code 1
expect "cell.cpp: error: wrong"
expect "the build failed; the whole log: $project/build/release.log"
rm "$fake/break-build"
call demo
expect_code 0

begin "a preset has its own build; libraries that changed start it afresh"
settings=(MMALE_PRESET=dev)
call demo
expect_code 0
[[ -x $project/build/dev/cpp/mmale ]] || wrong "no build/dev"
touch "$project/build/dev/old"
echo "root elsewhere" > "$project/build/dev.environment"
call demo
[[ ! -e $project/build/dev/old ]] || wrong "mixed two builds"

begin "a moved project starts afresh"
call demo
mv "$project" "$sandbox/moved"
project=$sandbox/moved
call demo
expect_code 0
expect_count "cmake --preset release" 2

# --- verbs ------------------------------------------------------------------------

begin "the program's exit code is the launcher's"
touch "$fake/fail"
call demo
expect_code 4

begin "test leaves out what is slow, --all does not"
call test
expect_code 0
expect "--output-on-failure -j2 -LE slow"
call test --all
[[ $out != *"-LE slow"* ]] || wrong "left out slow tests"
call test al
expect_code 1
expect "unknown argument 'al'"

begin "element reaches the program, and its results are writable"
touch "$sandbox/tests.toml"
call element "$sandbox/tests.toml" path.0.eps_a=0.1 --results "$sandbox/out dir"
expect_code 0
expect "program element $sandbox/tests.toml path.0.eps_a=0.1 --results $sandbox/out dir"
expect_log "--bind-try $sandbox/out dir $sandbox/out dir"
call element "$sandbox/tests.toml" --results="$sandbox/other"
expect_log "--bind-try $sandbox/other $sandbox/other"
call element --keys
expect "program element --keys"
call element nothing.toml
expect_code 1
expect "no test file 'nothing.toml'"
call element
expect_code 1
expect "name a test file"
call elemnt
expect "nearest: element;"

begin "check, study and shell reach program, script and command"
call check demos/piercing/scene.toml
expect "program check demos/piercing/scene.toml"
call study speed quick
expect "study studies/speed/run.py quick with mmale"
call shell -- bash -c 'echo "$MPLBACKEND $OMPI_MCA_btl"'
expect "Agg self,sm"
out=$(echo piped | mmale shell -- cat 2>&1)
expect piped

begin "a demo's own arguments are added unless the user changes keys"
printf '# a sweep\nmesh.refine=1,2  # two meshes\n' > "$project/demos/piercing/arguments"
call demo
expect "program run demos/piercing/scene.toml mesh.refine=1,2 commit"
call demo piercing --results="$sandbox/a b"
expect "program run demos/piercing/scene.toml mesh.refine=1,2 --results=$sandbox/a b commit"
call demo piercing mesh.size=0.1
expect "program run demos/piercing/scene.toml mesh.size=0.1 commit"
call demo cook_membrane
expect "program run demos/cook_membrane/scene.toml commit"

begin "-n starts ranks"
call demo piercing -n 3 a.b=1
expect_code 0
expect_count "program run demos/piercing/scene.toml a.b=1" 3
expect_log "mpirun -n 3 --oversubscribe"

begin "--resume goes to the program, of a demo too"
call demo cook_membrane --resume -n 2
expect_code 0
expect_count "program run demos/cook_membrane/scene.toml --resume" 2

# --- signals ----------------------------------------------------------------------

# A run of "$@" gets signal $1, alone or with its group ($2), and must save its
# state $4 times before the launcher leaves with $3.
stopped()
{
  local target
  touch "$fake/hold"
  set -m
  (cd "$project" && mmale "${@:5}") > "$sandbox/said" 2>&1 &
  set +m
  await "$fake/started"
  sleep 0.3
  target=$!
  [[ $2 == group ]] && target=-$target
  kill -s "$1" -- "$target"
  wait "${target#-}"
  code=$? out=$(cat "$sandbox/said")
  expect_code "$3"
  [[ $(grep -c saved "$fake/saved" 2> /dev/null) == "$4" ]] || wrong "states saved: not $4"
}

for target in alone group; do
  for way in INT:130 TERM:143 HUP:129; do
    begin "${way%:*} to the launcher ($target): the state is saved, the code is ${way#*:}"
    stopped "${way%:*}" "$target" "${way#*:}" 1 demo
    expect "saving the state"
  done
done

begin "through mpirun every rank saves its state"
stopped TERM group 143 2 demo -n 2
begin "a native run saves its state too"
touch "$fake/native"
stopped INT group 130 1 demo

begin "a second signal stops a program that does not end"
sed -i 's/sleep 0.5; echo saved.*exit 0/:/' "$sandbox/program"
touch "$fake/hold"
set -m
mmale demo > "$sandbox/said" 2>&1 &
set +m
await "$fake/started"
kill -INT $!
sleep 0.3
kill -INT $!
wait $!
code=$? out=$(cat "$sandbox/said")
expect_code 130

begin "a signal stops tests at once"
printf '#!/bin/bash\ntouch "$FAKE/started"\nsleep 60\n' > "$bin/ctest"
set -m
mmale test > "$sandbox/said" 2>&1 &
set +m
await "$fake/started"
seconds=$SECONDS
kill -TERM $!
wait $!
code=$? out=$(cat "$sandbox/said")
expect_code 143
((SECONDS - seconds < 10)) || wrong "took $((SECONDS - seconds)) s"

((failed)) || echo "all held"
exit "$failed"
