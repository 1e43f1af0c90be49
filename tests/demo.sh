#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds, and runs the main job on a model that the program makes itself.
set -euo pipefail
cd "$(dirname "$0")/.."
bash tests/build.sh program
out=build/demo
rm -rf "$out"
mkdir -p "$out"

set -x
build/binderjet coupon --kind golfball -o "$out/ball.stl"
build/binderjet slice "$out/ball.stl" --scale 0.4 -p z450 --enhance inverse -o "$out/ball.bjob"
build/binderjet export "$out/ball.bjob" -o "$out/masks"
build/binderjet simulate "$out/ball.bjob" -p z450 -o "$out/printed"
build/binderjet score "$out/ball.bjob" --target "$out/ball.stl"
build/binderjet print "$out/ball.bjob" --to "spool:$out/spool"
set +x

echo
echo "The masks that would be sent:     $out/masks/mask_000084.png and its neighbors"
echo "What the printer makes of them:   $out/printed/printed_000084.png"
echo "The job as a printer would get it: $out/spool/done"
