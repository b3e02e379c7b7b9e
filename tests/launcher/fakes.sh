# SPDX-License-Identifier: LGPL-3.0-or-later
# shellcheck shell=bash disable=SC2016,SC2153,SC2154
# A sandbox for the launcher: a copy of it with one demo and one study, and a
# PATH that holds plain tools of the system and fakes of all those that would
# change something. What the fakes do hangs on files in $fake:
#
#   native        the configuration file of a DOLFINx that CMake finds
#   candidate     the version of libdolfinx-dev that apt offers
#   installed     the packages that dpkg-query names
#   no-network    mmdebstrap fails as without a network (apt-get too)
#   no-namespace  bubblewrap may not make a namespace
#   break-build   ninja fails
#   slow          seconds that mmdebstrap takes
#   free          megabytes that df reports for every folder
#   hold          the program waits until it is gone
#   log           gets one line for each call of a fake

# shellcheck disable=SC2034
new_sandbox()
{
  sandbox=$(mktemp -d "$work/XXXXXX")
  fake=$sandbox/fake project="$sandbox/my project" bin=$sandbox/bin
  mkdir -p "$fake" "$bin" "$project/cmake" "$project/demos/piercing" "$sandbox/home" \
    "$project/demos/cook_membrane" "$project/studies/speed" \
    "$sandbox/files/etc" "$sandbox/files/usr/share/keyrings" "$sandbox/tmp"
  cp "$source/mmale" "$project/"
  cp -r "$source/cmake/launcher" "$project/cmake/"
  printf '# list\ng++   # compiler\nninja-build\n' > "$project/packages.txt"
  echo '{}' > "$project/CMakePresets.json"
  touch "$project/demos/piercing/scene.toml" "$project/demos/cook_membrane/scene.toml" \
    "$project/studies/speed/run.py"
  touch "$sandbox/files/usr/share/keyrings/debian-archive-keyring.gpg" \
    "$sandbox/files/usr/share/keyrings/debian-archive-trixie-automatic.gpg"
  echo 90000 > "$fake/free"
  touch "$fake/log" "$fake/installed"
  plain_tools
  local name
  for name in "${fakes[@]}"; do
    { echo '#!/bin/bash'; declare -f "fake_$name"
      printf 'echo "%s $*" >> "$FAKE/log"\nfake_%s "$@"\n' "$name" "$name"; } > "$bin/$name"
    chmod +x "$bin/$name"
    [[ $name == *_* ]] && ln -s "$name" "$bin/${name/_/-}"
  done
}

fakes=(cmake ninja ctest bwrap mmdebstrap newuidmap apt_cache apt_get dpkg dpkg_query sudo id df
  mpirun python3)

plain_tools()
{
  local tool
  for tool in awk basename bash cat chmod cksum comm cp cut dirname env find flock grep head \
    mkdir mktemp mv nproc paste readlink realpath rm sed sha256sum sleep sort tail tar tee touch; do
    ln -s "$(type -P "$tool")" "$bin/$tool"
  done
}

# A package's tools appear when apt installs it.
fake_apt_get()
{
  local package
  [[ -e $FAKE/no-network && $* == *install* ]] && { echo "E: Could not resolve 'server'" >&2; exit 100; }
  [[ $* == *update* ]] && { [[ -e $FAKE/offer ]] && mv "$FAKE/offer" "$FAKE/candidate"; return 0; }
  for package; do
    echo "$package installed" >> "$FAKE/installed"
    [[ -e $FAKE/brings.$package ]] && mv "$FAKE/brings.$package" "$FAKE/native"
    [[ -e $BIN/away.$package ]] && mv "$BIN/away.$package" "$BIN/$(cat "$FAKE/tool.$package")"
  done
  return 0
}

fake_apt_cache() { [[ -e $FAKE/candidate ]] && echo "  Candidate: $(cat "$FAKE/candidate")"; }
fake_dpkg_query() { cat "$FAKE/installed"; }
fake_dpkg() { [[ $(printf '%s\n%s\n' "$2" "$4" | sort -V | head -n 1) == "$4" ]]; }
fake_newuidmap() { :; }
fake_python3() { echo "study $* with ${MMALE_PROGRAM##*/}"; }
fake_ctest() { echo "ctest $*"; }
fake_id() { if [[ $1 == -u ]]; then cat "$FAKE/uid" 2> /dev/null || echo 0; else echo someone; fi; }
fake_df() { printf 'Filesystem\nnone 1 1 %s 1%% /\n' "$(cat "$FAKE/free")"; }

fake_sudo()
{
  [[ -e $FAKE/no-sudo ]] && return 1
  [[ $1 == -n ]] && shift
  "$@"
}

fake_cmake()
{
  if [[ $* == *--preset* ]]; then
    mkdir -p "build/$2" && touch "build/$2/build.ninja"
  elif [[ -e $FAKE/native ]]; then
    while [[ $1 != -S ]]; do shift; done
    echo "$FAKE/native" > "$2/found"
  else
    return 1
  fi
}

# Builds the program once; counts as the real one, and knows when it is done.
fake_ninja()
{
  local program=$2/cpp/mmale
  [[ -e $FAKE/break-build ]] && { echo "[1/2] FAILED: cell.o"; echo "cell.cpp: error: wrong"; return 1; }
  [[ -e $program ]] && { echo "ninja: no work to do."; return 0; }
  mkdir -p "$2/cpp"
  printf '[1/2] Building\n[2/2] Linking\n'
  cp "$FAKE/../program" "$program"
}

fake_bwrap()
{
  [[ $* == *" / / true" ]] && { [[ ! -e $FAKE/no-namespace ]]; exit; }
  trap > "$FAKE/bwrap-ignores"
  while [[ $1 != -- ]]; do shift; done
  shift
  PATH=$BIN "$@"
  exit
}

fake_mmdebstrap()
{
  local tree
  echo "I: running apt-get update" >&2
  sleep "$(cat "$FAKE/slow" 2> /dev/null || echo 0)"
  [[ -e $FAKE/no-network ]] && { echo "E: Could not resolve 'server'" >&2; exit 1; }
  tree=$(mktemp -d)
  mkdir -p "$tree/usr/bin" "$tree/etc"
  tar -c -C "$tree" .
  rm -rf "$tree"
  echo "mmdebstrap ends" >> "$FAKE/log"
}

# As Open MPI's: dies of TERM and INT with its ranks, forwards USR1.
fake_mpirun()
{
  local ranks=$2 pids=() i
  shift 5
  trap 'kill -USR1 "${pids[@]}"' USR1
  trap 'kill -KILL "${pids[@]}"; exit 1' INT TERM
  for ((i = 0; i < ranks; i++)); do "$@" & pids+=($!); done
  for i in "${pids[@]}"; do while kill -0 "$i" 2> /dev/null; do wait "$i"; done; done
}

# What stands in for the solver: saves its state half a second after USR1.
stand_in()
{
  cat > "$sandbox/program" << 'END'
#!/bin/bash
echo "program $* commit=$MMALE_COMMIT threads=$OMP_NUM_THREADS" | tee -a "$FAKE/log"
trap 'sleep 0.5; echo saved >> "$FAKE/saved"; exit 0' USR1
touch "$FAKE/started"
while [[ -e $FAKE/hold ]]; do sleep 0.05; done
[[ ! -e $FAKE/fail ]] || exit 4
END
  chmod +x "$sandbox/program"
}
