#!/usr/bin/env bash
# The page that runs the simulator in a browser, in build/web/page: `tools/web.sh build` makes it,
# `tools/web.sh serve [--port N]` serves it on this machine as well.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
port=8000
what=${1:-}
case $what in build|serve) shift ;; *) usage ;; esac
while [ $# -gt 0 ]; do
  case $1 in
    --port) [ $# -gt 1 ] || usage; port=$2; shift 2 ;;
    --port=*) port=${1#--port=}; shift ;;
    *) usage ;;
  esac
done
if ! [[ $port =~ ^[0-9]{1,5}$ ]] || [ "$((10#$port))" -gt 65535 ]; then
  echo "web: --port: \`$port\` is no port; must be a whole number from 0 to 65535" >&2
  exit 2
fi

tools/setup.sh web
mkdir -p build
export NODE_PATH=/usr/share/nodejs  # where Debian's emscripten finds its own packages, whatever node is installed
echo "web: building (first time: some minutes; log in build/web.log)"
if ! { cmake --preset web && cmake --build --preset web; } >build/web.log 2>&1; then
  tail -n 40 build/web.log >&2
  echo "web: the build failed; the whole log is build/web.log" >&2
  exit 1
fi
[ "$what" = serve ] || exit 0
echo "The page, until Ctrl-C:"
exec python3 web/app/serve.py build/web/page "$((10#$port))"
