#!/usr/bin/env bash
# tools/fuzz.sh [SECONDS]: feeds mutated scenes to the scene reader under sanitizers. The corpus grows in
# build/fuzz/corpus; an input that breaks the reader is left in build/fuzz/ and named in the output.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
cmake --preset sanitize >/dev/null
cmake --build --preset sanitize --target fuzz_scene
mkdir -p build/fuzz/corpus
build/sanitize/fuzz_scene -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
  -dict=tests/fuzz/scene.dict \
  -artifact_prefix=build/fuzz/ build/fuzz/corpus scenes tests/fuzz/seeds tests/scene/crashers
