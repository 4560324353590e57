#!/usr/bin/env bash
# Installs what is missing on a Debian 12 machine: `tools/setup.sh run` for building and running the program,
# `tools/setup.sh test` for every check as well, `tools/setup.sh validation` for the figures of validation/run.py,
# `tools/setup.sh python` for the Python package, `tools/setup.sh web` for the page in the browser, `tools/setup.sh docs`
# for the pages as a site (`test` has all these, too), `tools/setup.sh nightly` for what tools/nightly.sh asks for beside.
# This file is the one list of what the project needs.
# Does nothing, and asks for no rights, when everything is there.
set -euo pipefail

# A line each: what to look for (a command, or a Debian package when it starts with "lib" or "python3-" or ends in
# "-dev"), the package that brings it, and who needs it, separated by commas.
needs='
g++                 g++                 run
cmake               cmake               run
ninja               ninja-build         run
libeigen3-dev       libeigen3-dev       run
libyaml-cpp-dev     libyaml-cpp-dev     run
nlohmann-json3-dev  nlohmann-json3-dev  run
libcli11-dev        libcli11-dev        run
libfmt-dev          libfmt-dev          run
libpng-dev          libpng-dev          run
libgtest-dev        libgtest-dev        run
libbenchmark-dev    libbenchmark-dev    run
node                nodejs              run
npm                 npm                 run
ca-certificates.crt ca-certificates     run
python3             python3             run
clang++             clang               test
libclang-rt-14-dev  libclang-rt-14-dev  test
clang-format        clang-format        test
clang-tidy          clang-tidy          test
admesh              admesh              test
python3-matplotlib  python3-matplotlib  validation,test
pybind11-dev        pybind11-dev        python,test
python3-dev         python3-dev         python,test
python3-numpy       python3-numpy       python,test
python3-pip         python3-pip         python,test
python3-venv        python3-venv        python,test
mypy                mypy                test
python3-jsonschema  python3-jsonschema  test
python3-yaml        python3-yaml        test
python3-vtk9        python3-vtk9        test
ffmpeg              ffmpeg              test
em++                emscripten          web,test
xz                  xz-utils            web,test
chromium            chromium            test
mkdocs              mkdocs              docs,test
libjs-katex         libjs-katex         docs,test
python3-pymdownx    python3-pymdownx    docs,test
mkdocs-material     mkdocs-material     docs,test
blender             blender             nightly
linkchecker         linkchecker         nightly
libc++-dev          libc++-dev          nightly
libc++abi-dev       libc++abi-dev       nightly
gcovr               gcovr               nightly
'

present() {
  case $1 in
    ca-certificates.crt) [ -s /etc/ssl/certs/ca-certificates.crt ] ;;
    lib*|python3-*|*-dev|mkdocs-material) dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed' ;;
    *) command -v "$1" >/dev/null ;;
  esac
}

missing() {
  local probe package group
  while read -r probe package group; do
    [ -n "$probe" ] || continue
    [[ ,$group, == *,run,* || ,$group, == *,$1,* ]] || continue
    present "$probe" || echo "$package"
  done <<<"$needs"
}

install() {
  if ! command -v apt-get >/dev/null; then
    echo "setup: this is not a Debian system; please install the equivalents of: $*" >&2
    exit 1
  fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root, or install: $*" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "setup: installing $*"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"
}

group=${1:-run}
case $group in
  run|web|test|validation|python|docs|nightly) ;;
  *) echo "usage: tools/setup.sh [run|web|test|validation|python|docs|nightly]" >&2; exit 2 ;;
esac
mapfile -t packages < <(missing "$group")
[ ${#packages[@]} -eq 0 ] || install "${packages[@]}"

[ "$group" != web ] && [ "$group" != test ] || tools/yaml_source.sh build/yaml-cpp

node_major=$(node --version | sed 's/^v\([0-9]*\).*/\1/')
if [ "$node_major" -lt 18 ]; then
  echo "setup: node $(node --version) is too old for the report page; 18 or later is needed" >&2
  exit 1
fi
