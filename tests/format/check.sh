#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-3.0-or-later
# Is the source in folder $1 formatted? Names what is not; an absent tool is a
# failure, not a pass.
cd "$1" || exit 1
failed=0
said=$(mktemp)
trap 'rm -f "$said"' EXIT

# The files of the tree whose names end in one of the arguments.
sources()
{
  local ending pattern=()
  for ending; do pattern+=(-o -name "*.$ending"); done
  find . \( -name build -o -name 'build-*' -o -name results -o -name '.?*' \) -prune \
    -o -type f \( "${pattern[@]:1}" \) -print0
}

# Runs "${@:2}" on the files that end in one of the words of $1; the start of
# what it says is enough to find them.
check()
{
  local files endings
  read -ra endings <<< "$1"
  mapfile -d '' files < <(sources "${endings[@]}")
  ((${#files[@]})) || return
  echo "${*:2}: ${#files[@]} files"
  "${@:2}" "${files[@]}" > "$said" 2>&1 && return
  failed=1
  head -n 40 "$said"
}

check "cpp h" clang-format --dry-run --Werror
check "py" black --quiet --check --diff
check "py" flake8 --max-line-length 88 --extend-ignore E203
exit "$failed"
