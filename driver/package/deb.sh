#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the Debian package, whose dependencies are what the program links: deb.sh [BUILD]
set -euo pipefail
paths=()
for path in "$@"; do paths+=("$(realpath -m "$path")"); done
set -- "${paths[@]}"
cd "$(dirname "$0")/../.."
build=${1:-build}
if [ ! -x "$build/binderjet" ] || [ ! -e "$build/manual/binderjet.1" ]; then
  bash tests/build.sh package "$build"
fi
(cd "$build" && cpack -G DEB)
