#!/usr/bin/env bash
# clang-tidy with zero findings allowed. Without arguments every source of the library and the program, about a quarter
# of an hour; --fast leaves out the files that are mostly Eigen and the slow path analyser, about two minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
folders=(src apps)
options=()
if [ "${1:-}" = --fast ]; then
  folders=(src/wunderlich/base src/wunderlich/scene src/wunderlich/io apps)
  options=(--checks='-clang-analyzer-*')
fi
cmake --preset tidy >/dev/null
mapfile -t files < <(find "${folders[@]}" -name '*.cpp' | sort)
echo "tidy: ${#files[@]} files"
# The count of suppressed warnings in system headers is noise.
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet --warnings-as-errors='*' "${options[@]}" \
    2> >(grep -v 'warnings generated' >&2)
