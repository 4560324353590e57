#!/usr/bin/env bash
# tools/format.sh formats every C++ file in place; with --check it only lists the files that differ.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(find src apps tests bench -name '*.cpp' -o -name '*.hpp' | sort)
if [ "${1:-}" = --check ]; then
  clang-format --dry-run --Werror "${files[@]}"
else
  clang-format -i "${files[@]}"
fi
