#!/usr/bin/env bash
# clang-tidy with zero findings allowed. Without arguments every source of the library and the program; --fast, for
# ./test, leaves out the files that are mostly Eigen and the slow path analyser, starts no file after three minutes and
# names those it left out.
set -euo pipefail
cd "$(dirname "$0")/.."
folders=(src apps)
options=()
seconds=86400
if [ "${1:-}" = --fast ]; then
  folders=(apps src/wunderlich/scene src/wunderlich/io)
  options=(--checks='-clang-analyzer-*')
  seconds=180
fi
cmake --preset tidy >/dev/null
mapfile -t files < <(find "${folders[@]}" -name '*.cpp' | sort)
echo "tidy: ${#files[@]} files"

look() {
  local file=$1
  shift
  if [ "$(date +%s)" -ge "$deadline" ]; then echo "tidy: no time left for $file"; return; fi
  clang-tidy -p build/tidy --quiet --warnings-as-errors='*' "$@" "$file" 2> >(grep -v 'warnings generated' >&2)
}
export -f look
export deadline=$(($(date +%s) + seconds))
printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -I '{}' bash -c 'look "$@"' look '{}' "${options[@]}"
