#!/usr/bin/env bash
# tools/format.sh formats every C++ file in place; with --check it only lists the files that differ.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(find src apps bindings tests bench -name '*.cpp' -o -name '*.hpp' | sort)
if [ "${1:-}" != --check ]; then
  clang-format -i "${files[@]}"
  exit
fi
status=0
for file in "${files[@]}"; do
  clang-format "$file" | cmp --quiet - "$file" || { echo "$file: not formatted; run tools/format.sh"; status=1; }
done
exit $status
