#!/usr/bin/env bash
# Slower checks than ./test has time for, some two hours on two cores: the paper's figures in full, pip install from bare
# sources, the site's links by linkchecker, clang-tidy on every source, imports by Blender, every check of the sanitizers,
# tests repeated in random order, whole scenes searched for penetration, a sweep of 10,000, one on Slurm, half an hour of
# fuzzing, the core compiled against libc++, and coverage (build/coverage/report).
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh test
tools/setup.sh nightly

echo "nightly: everything that ./test does"
./test

echo "nightly: the paper's figures, in full (build/validation)"
tools/setup.sh validation
/usr/bin/python3 validation/run.py

echo "nightly: pip install from a bare copy of the sources, nothing of it built"
rm -rf build/bare && mkdir -p build/bare/source && git archive HEAD | tar -x -C build/bare/source
/usr/bin/python3 -m venv --system-site-packages build/bare/venv
(time build/bare/venv/bin/pip install --no-index --no-build-isolation build/bare/source)
build/bare/venv/bin/python -c 'import wunderlich; print(wunderlich.equilibrium("moebius").summary["energy"]["normalized"])'

echo "nightly: the links of the site, by linkchecker"
linkchecker --no-warnings build/site/index.html

echo "nightly: clang-tidy on everything"
tools/tidy.sh

echo "nightly: Blender imports the clips and point caches of runs"
for scene in moebius paper-chain drape-cylinder; do
  build/release/wunderlich run "$scene" --quiet --formats vtp,glb,pc2 --out "build/blender/$scene" --set output.frames=20 \
    --set solver.duration=0.5
  blender --background --factory-startup --python-exit-code 1 --python tests/nightly/blender_reads.py -- "build/blender/$scene"
done

echo "nightly: the tests under every check of the sanitizers"
cmake --preset sanitize-all
cmake --build --preset sanitize-all
ctest --preset sanitize-all -j "$(nproc)"

echo "nightly: unit tests, 10 times in random order"
GTEST_SHUFFLE=1 ctest --preset release -j "$(nproc)" --schedule-random --repeat until-fail:10

echo "nightly: 100,000 random steps of the implicit method"
WUNDERLICH_SOAK_STEPS=100000 build/release/test_implicit --gtest_filter=Soak.Long

echo "nightly: 1000 random drops on solids"
WUNDERLICH_DROPS=1000 build/release/test_implicit --gtest_filter=Drops.Random

echo "nightly: nothing goes through anything, in whole scenes"
WUNDERLICH_WHOLE_SCENES=1 build/release/test_penetration

echo "nightly: a sweep of 10,000 ribbons, killed 20 times"
(cd tests/interface && WUNDERLICH_SWEEP_RUNS=10000 WUNDERLICH_SWEEP_KILLS=20 \
  WUNDERLICH_PROGRAM=../../build/release/wunderlich python3 -B test_sweep.py)

echo "nightly: a sweep on Slurm, an array of 8 shards on this machine"
tools/slurm_test.sh

echo "nightly: 30 minutes of fuzzing"
tools/fuzz.sh 1800

echo "nightly: the core with clang and libc++, as browsers will compile it"
cmake -S . -B build/libcxx -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-stdlib=libc++ \
  -DWUNDERLICH_APP=OFF -DWUNDERLICH_TESTS=OFF -DWUNDERLICH_BENCH=OFF -DWUNDERLICH_WARNINGS_AS_ERRORS=ON
cmake --build build/libcxx

echo "nightly: coverage"
cmake --preset coverage
cmake --build --preset coverage
ctest --preset coverage -j "$(nproc)"
mkdir -p build/coverage/report
gcovr --root . --filter src/ --exclude-throw-branches --html-details build/coverage/report/index.html --print-summary \
  build/coverage
