# SPDX-License-Identifier: LGPL-3.0-or-later
# shellcheck shell=bash
# Where the libraries come from; read by ../../mmale, whose `here`, `uid`,
# `preset`, `writable`, `say`, `die` and `supervise` it uses.
#
# choose_environment takes the first way that works:
#   1. CMake finds DOLFINx: build with it.
#   2. apt offers it: install what packages.txt names.
#   3. A private Debian 13 root in the cache, entered by bubblewrap.
#   4. One message that says what to do.
# It sets `way` (native or root), `root`, and `environment`, one line that
# changes whenever a build made before is of no use any more.

readonly min_dolfinx=0.9
readonly root_mb=3500 scratch_mb=4500 # a root, and the room to make it in
readonly container="or use the container: docker build -t mmale . (see README.md)"
# The tests put other system files here.
readonly system=${MMALE_SYSTEM_FILES:-}

packages() { sed 's/#.*//; s/[[:space:]]//g; /^$/d' "$here/packages.txt" | sort -u; }

choose_environment()
{
  local hash kind='' known=''
  hash=$(packages | sha256sum)
  hash=${hash:0:12}
  read -r kind known 2> /dev/null < "$here/build/$preset.environment"
  if [[ -n ${MMALE_INSIDE:-} ]]; then # called from within the root
    way=native environment=$MMALE_INSIDE
    return
  fi
  if [[ $kind == native && -e ${known##* } && $known == "$hash $here "* ]]; then
    way=native environment="native $known"
    return
  fi
  way=root
  root=${known% "$here"}
  if [[ $kind == root && $root == */debian13-$hash && -d $root/usr ]] && have bwrap; then
    cache=${root%/*} environment="root $root $here"
    return
  fi
  if native "$hash"; then return; fi
  find_root "$hash" || make_root "$hash"
  environment="root $root $here"
  need_tools bwrap
  register
}

# Ways 1 and 2. A DOLFINx that is Debian's own is completed by apt.
native()
{
  local config missing
  config=$(native_dolfinx) || config=
  if [[ -n $config && $config != /usr/lib/*-linux-gnu/* ]] || { [[ -z $config ]] && ! apt_offers; }; then
    missing=()
  else
    mapfile -t missing < <(missing_packages)
  fi
  if ((${#missing[@]})); then
    if ! can_be_root; then
      say "Debian has all libraries; root may install them: apt-get install ${missing[*]}"
      return 1
    fi
    apt_install "${missing[@]}"
    config=$(native_dolfinx) || die "CMake does not find the DOLFINx that apt installed"
  fi
  [[ -n $config ]] || return 1
  way=native environment="native $1 $here $config"
}

# Prints the configuration file of a DOLFINx that CMake finds.
native_dolfinx()
{
  local folder found
  have cmake && have ninja || return 1
  folder=$(mktemp -d) || die "cannot write a temporary folder"
  cat > "$folder/CMakeLists.txt" << END
cmake_minimum_required(VERSION 3.25)
project(probe LANGUAGES C CXX)
find_package(DOLFINX $min_dolfinx REQUIRED CONFIG)
file(WRITE "$folder/found" "\${DOLFINX_CONFIG}")
END
  cmake -G Ninja -S "$folder" -B "$folder/build" > /dev/null 2>&1
  found=$(cat "$folder/found" 2> /dev/null)
  rm -rf "$folder"
  [[ -n $found ]] && printf '%s\n' "$found"
}

# --- apt -------------------------------------------------------------------

as_root() { if [[ $uid == 0 ]]; then "$@"; else sudo "$@"; fi; }

can_be_root()
{
  [[ $uid == 0 ]] || { have sudo && { sudo -n true 2> /dev/null || [[ -t 0 ]]; }; }
}

apt_candidate()
{
  apt-cache policy libdolfinx-dev 2> /dev/null | sed -n 's/^ *Candidate: //p'
}

# Debian's revision and epoch play no part in the comparison.
apt_offers()
{
  local version
  have apt-cache && have dpkg || return 1
  version=$(apt_candidate)
  if [[ -z $version ]] && can_be_root; then # no lists yet
    say "asking apt what it offers"
    as_root apt-get update -qq > /dev/null 2>&1
    version=$(apt_candidate)
  fi
  [[ -n $version ]] && dpkg --compare-versions "${version#*:}" ge "$min_dolfinx"
}

missing_packages()
{
  comm -23 <(packages) <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2> /dev/null \
    | sed -n 's/ installed$//p' | sort -u)
}

apt_install()
{
  local log=$here/build/apt.log
  say "installing with apt: $* (log: $log)"
  if as_root apt-get update -qq > "$log" 2>&1 \
    && as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 \
      install -y --no-install-recommends "$@" >> "$log" 2>&1; then
    return
  fi
  explain "$log" "apt could not install $*"
}

# Ends with the cause that a log of apt or mmdebstrap shows; $2 is the event.
explain()
{
  local no_network='Could not resolve|Temporary failure resolving|Could not connect'
  no_network+='|Unable to connect|Connection timed out|Network is unreachable'
  grep -qE "$no_network" "$1" \
    && die "$2: no network, Debian's server cannot be reached; call again when it can (log: $1)"
  grep -q 'NO_PUBKEY' "$1" \
    && die "$2: Debian's trixie key is missing; install or upgrade debian-archive-keyring (log: $1)"
  grep -q 'No space left' "$1" && die "$2: no space left (log: $1)"
  tail -n 15 "$1" >&2
  die "$2; the whole log: $1"
}

# --- the private root --------------------------------------------------------

# The folders that may hold the cache, the wished one first.
caches()
{
  printf '%s\n' ${MMALE_CACHE:+"$MMALE_CACHE"} \
    ${XDG_CACHE_HOME:+"$XDG_CACHE_HOME/mmale"} ${HOME:+"$HOME/.cache/mmale"}
}

# Sets `root` and `cache` where a root for this package list stands.
find_root()
{
  while IFS= read -r cache; do
    cache=$(realpath -m "$cache")
    root=$cache/debian13-$1
    [[ -d $root/usr ]] && return
  done < <(caches)
  return 1
}

writable_cache()
{
  while IFS= read -r cache; do
    cache=$(realpath -m "$cache")
    mkdir -p "$cache" 2> /dev/null && { : > "$cache/lock"; } 2> /dev/null && return
    say "cannot write $cache"
  done < <(caches)
  die "no folder to keep the libraries in: set MMALE_CACHE to one with $root_mb MB"
}

# Each tool with its Debian package; missing ones are installed or named.
need_tools()
{
  local tool missing=()
  local -A package=([mmdebstrap]=mmdebstrap [bwrap]=bubblewrap [newuidmap]=uidmap)
  for tool; do have "$tool" || missing+=("${package[$tool]}"); done
  ((${#missing[@]})) || return
  have apt-get || die "missing here: ${missing[*]}; install them with the system's package manager, $container"
  can_be_root || die "missing here: ${missing[*]}; ask root for: apt-get install ${missing[*]}; $container"
  apt_install "${missing[@]}"
}

free_mb() { df -Pm "$1" 2> /dev/null | awk 'NR == 2 { print $4 }'; }
device() { df -P "$1" 2> /dev/null | awk 'NR == 2 { print $6 }'; }

# Sets `scratch`: a folder to make the root in; checks the space there and in
# the cache, together where both are on one device.
find_space()
{
  local folder room
  room=$(free_mb "$cache")
  ((${room:-0} >= root_mb)) \
    || die "no space: $cache has ${room:-0} MB, a root takes $root_mb; free some or set MMALE_CACHE"
  for folder in ${TMPDIR:+"$TMPDIR"} /tmp /var/tmp; do
    [[ -d $folder && -w $folder ]] || continue
    room=$(free_mb "$folder")
    [[ $(device "$folder") == "$(device "$cache")" ]] && ((room -= root_mb))
    ((${room:-0} >= scratch_mb)) || continue
    scratch=$(realpath "$folder")/mmale-set-up-$uid-$(cksum <<< "$cache" | cut -d ' ' -f 1)
    return
  done
  die "no space: making the root takes $scratch_mb MB in /tmp or /var/tmp (beside $root_mb MB in $cache); free some or set TMPDIR"
}

# What can be said before 3 GB come over the network.
check_set_up()
{
  local user keys=$system/usr/share/keyrings
  need_tools mmdebstrap bwrap newuidmap
  user=$(id -un)
  if [[ $uid != 0 ]] && ! { grep -qE "^($user|$uid):" "$system/etc/subuid" \
    && grep -qE "^($user|$uid):" "$system/etc/subgid"; } 2> /dev/null; then
    die "$user has no range of subordinate ids; ask root for: usermod --add-subuids 100000-165535 --add-subgids 100000-165535 $user"
  fi
  [[ -e $keys/debian-archive-keyring.gpg && -e $keys/debian-archive-trixie-automatic.gpg ]] \
    || die "Debian's trixie key is missing; install or upgrade debian-archive-keyring (2023.3+deb12u2 or later)"
  bwrap --ro-bind / / true 2> /dev/null \
    || die "bubblewrap may not make a namespace here (a container, or AppArmor's kernel.apparmor_restrict_unprivileged_userns); allow it, $container"
}

# Whatever an earlier call left in the scratch folder; for a user parts of it
# belong to the subordinate ids.
clear_scratch()
{
  [[ -e $scratch ]] || return 0
  rm -rf "$scratch" 2> /dev/null || unshare --map-root-user --map-auto rm -rf "$scratch" \
    || die "cannot remove $scratch, left by an earlier call"
}

fill_root()
{
  TMPDIR=$scratch mmdebstrap --mode=unshare --variant=apt \
    --keyring="$system/usr/share/keyrings/debian-archive-keyring.gpg" --include="$(packages | paste -sd,)" trixie - \
    2> >(tee "$log" | progress "making a private Debian 13" '^I: (.*)') \
    | tar -x --no-same-owner --exclude='./dev/*' -C "$part" \
    && find "$part" -xdev -type f -perm /6000 -exec chmod ug-s {} +
}

make_root()
{
  local scratch part log
  writable_cache
  root=$cache/debian13-$1 part=$root.part log=$root.log
  lock "$cache/lock" "making a private Debian 13"
  [[ -d $root/usr ]] && return
  check_set_up
  rm -rf "$cache"/debian13-*.part
  find_space
  clear_scratch
  mkdir -p "$part" "$scratch" || die "cannot write $part and $scratch"
  say "making a private Debian 13 in $cache (about 4 minutes, 3 GB, once)"
  # shellcheck disable=SC2064
  trap "rm -rf '$part'" EXIT
  supervise TERM fill_root || explain "$log" "making the private Debian 13 failed"
  mv -T "$part" "$root" || die "cannot write $root"
  trap - EXIT
  clear_scratch
  remove_old_roots
  exec 9>&-
}

# A root knows the projects that use it (several may share a cache); those
# that no project uses any more go, unless a run still stands on one.
register()
{
  grep -qxF "$here" "$root.users" 2> /dev/null || printf '%s\n' "$here" >> "$root.users"
} 2> /dev/null

remove_old_roots()
{
  local old user
  for old in "$cache"/debian13-*; do
    [[ -d $old && $old != "$root" && $old != *.part ]] || continue
    while IFS= read -r user; do
      [[ $user != "$here" && -e $user/packages.txt ]] && continue 2
    done < <(cat "$old.users" 2> /dev/null)
    (flock -n 7) 7< "$old" && rm -rf "$old" "$old.users" "$old.log"
  done
}

# --- entering ----------------------------------------------------------------

# What programs find in both ways: one thread a rank, pictures without a
# screen, ranks on one machine, the commit that results name.
set_variables()
{
  MMALE_COMMIT=$(git -C "$here" describe --always --dirty --abbrev=12 --exclude='*' 2> /dev/null)
  export MMALE_COMMIT=${MMALE_COMMIT:-unknown} MPLBACKEND=Agg
  export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} OMPI_MCA_btl=${OMPI_MCA_btl:-self,sm}
  [[ $uid == 0 ]] && export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
}

# Becomes "$@", beside the libraries, in the current folder.
inside()
{
  set_variables
  [[ $way == native ]] && exec "$@"
  local name folder home=$cache/home options=()
  mkdir -p "$home" 2> /dev/null && [[ -w $home ]] || home=/tmp
  for name in $(compgen -e); do
    case $name in
      TERM | COLUMNS | LINES | LC_ALL | NINJA_STATUS) ;;
      MMALE_* | MPL* | OMP_* | OMPI_* | PRTE_* | PMIX_* | PETSC_* | CTEST_*) ;;
      *) continue ;;
    esac
    options+=(--setenv "$name" "${!name}")
  done
  options+=(--setenv PATH /usr/sbin:/usr/bin --setenv HOME "$home"
    --setenv MPLCONFIGDIR "$home/.config/matplotlib" --setenv MMALE_INSIDE "$environment")
  [[ $home == /tmp ]] || writable+=("$home")
  for folder in "${writable[@]}"; do
    mkdir -p "$folder" 2> /dev/null
    folder=$(realpath -m "$folder")
    case $folder/ in
      / | // | /proc/* | /sys/* | /dev/* | /etc/* | /bin/* | /sbin/* | /lib*/*) continue ;;
      /usr/local/*) ;;
      /usr/*) continue ;;
    esac
    options+=(--bind-try "$folder" "$folder")
  done
  # The lock on the root's folder keeps it from being removed under a run.
  exec 8< "$root" && flock -s 8
  # bubblewrap would die at once of these; the program has them back, and the
  # launcher sends what it wants it to see.
  trap '' INT TERM HUP USR1
  exec bwrap --ro-bind "$root/usr" /usr --ro-bind "$root/etc" /etc \
    --tmpfs /var --ro-bind-try "$root/var/lib/dpkg" /var/lib/dpkg \
    --symlink usr/bin /bin --symlink usr/sbin /sbin \
    --symlink usr/lib /lib --symlink usr/lib64 /lib64 \
    --ro-bind /sys /sys --dev-bind /dev /dev --proc /proc \
    --perms 1777 --tmpfs /tmp --tmpfs /usr/local --clearenv "${options[@]}" \
    --chdir "$(pwd -P)" -- env --default-signal=INT,TERM,HUP,USR1 "$@"
}
