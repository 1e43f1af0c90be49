#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the README's row of pictures, byte for byte: one layer of the test part `coupon --kind full`
# as it is wanted, as its plain masks print and as inverse ones do. Needs build/binderjet; a minute.
set -euo pipefail
cd "$(dirname "$0")/../.."
binderjet=$PWD/build/binderjet
pictures=$PWD/.github/pictures
cd "$(mktemp -d)"

"$binderjet" coupon --kind full -o coupon.stl -q
"$binderjet" slice coupon.stl -p z450 -o plain.bjob -q
"$binderjet" slice coupon.stl -p z450 --enhance inverse -o enhanced.bjob -q
"$binderjet" export plain.bjob --what target -o target -q
for masks in plain enhanced; do
  "$binderjet" export $masks.bjob --what printed -o $masks -q
  cp $masks/printed_000024.png "$pictures/$masks.png"
done
cp target/target_000048.png "$pictures/target.png"
