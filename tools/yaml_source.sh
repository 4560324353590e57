#!/usr/bin/env bash
# The source of yaml-cpp, unpacked to FOLDER: the page in the browser compiles the reader's parser itself.
# usage: tools/yaml_source.sh FOLDER. Debian's source package of the library that is installed, from this machine's mirror;
# apt's own settings stay as they are. Does nothing when it is there.
set -euo pipefail

folder=${1:?usage: tools/yaml_source.sh FOLDER}
[ ! -e "$folder/src/parser.cpp" ] || exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/lists/partial" "$work/source"
codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
# Mirrors of the release itself, known even where no package lists have been fetched.
sites=$(apt-get indextargets --no-release-info --format '$(RELEASE) $(SITE)' 'Created-By: Packages' 'Component: main' |
  sed -n "s/^$codename //p" | sort -u)
[ -n "$sites" ] || { echo "yaml_source: apt knows no mirror of $codename" >&2; exit 1; }
while read -r site; do echo "deb-src $site $codename main"; done <<<"$sites" >"$work/sources.list"
apt=(apt-get -qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=-
  -o Dir::State::lists="$work/lists" -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache=)
[ "$(id -u)" -ne 0 ] || apt+=(-o APT::Sandbox::User=root)
"${apt[@]}" update
(cd "$work/source" && "${apt[@]}" source --download-only yaml-cpp)
rm -rf "$folder"
mkdir -p "$folder"
tar -xf "$work"/source/yaml-cpp_*.orig.tar.* --strip-components=1 -C "$folder"
