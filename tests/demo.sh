#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what the program needs, builds it, and does the main job on a test part that it makes
# itself: masks, a print by an emulated printer, and a page to look at.
set -euo pipefail
cd "$(dirname "$0")/.."
bash tests/build.sh program
out=build/demo
rm -rf "$out"
mkdir -p "$out"

set -x
build/binderjet coupon --kind full -o "$out/part.stl"
build/binderjet slice "$out/part.stl" -p z450 -o "$out/part.bjob"
build/binderjet score "$out/part.bjob" --target "$out/part.stl"
build/binderjet print "$out/part.bjob" --to "emulator:$out/printer"
build/binderjet export "$out/part.bjob" -o "$out/masks" --html "$out/part.html"
set +x

page=$PWD/$out/part.html
echo
echo "Masks, one PNG a layer: $out/masks    what the emulated printer made of them: $out/printer/1"
echo "Red is missing, blue too much: above what plain masks would print, below what ours do."
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open > /dev/null; then
  xdg-open "$page" > /dev/null 2>&1 &
fi
echo "file://$page"
