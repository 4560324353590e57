#!/usr/bin/env bash
# clang-tidy with zero findings allowed. Without arguments every check on every source of the library and the program.
# --fast, for ./test: the program and io/ only, which hold little Eigen, and without the path analyser, bugprone-* and
# misc-*, which take two thirds of the time; always the same files and checks, so that a pass means the same each time.
set -euo pipefail
cd "$(dirname "$0")/.."
folders=(src apps)
options=()
if [ "${1:-}" = --fast ]; then
  folders=(apps src/wunderlich/io)
  options=(--checks='-clang-analyzer-*,-bugprone-*,-misc-*')
fi
cmake --preset tidy >/dev/null
mapfile -t files < <(find "${folders[@]}" -name '*.cpp' | sort)
echo "tidy: ${#files[@]} files"

look() {
  clang-tidy -p build/tidy --quiet --warnings-as-errors='*' "$@" 2> >(grep -v 'warnings generated' >&2)
}
export -f look
printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -I '{}' bash -c 'look "$@"' look "${options[@]}" '{}'
