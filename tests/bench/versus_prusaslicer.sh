#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# binderjet against PrusaSlicer's SLA export: the same mesh, the same pixels, in turn, five times
# (or as often as ROUNDS says). Prints the median and the range of binderjet's share of the peer's
# wall time; both write one picture for each layer. Installs the peer if it is absent.
#   versus_prusaslicer.sh [MODEL [SCALE]]      default: a golf ball of 190 mm, and the gargoyle
set -euo pipefail
cd "$(dirname "$0")/../.."
rounds=${ROUNDS:-5}
binderjet=$PWD/build/binderjet
data=${BINDERJET_DATA:-../shared/data}
[ -x "$binderjet" ] || bash tests/build.sh

if ! command -v prusa-slicer > /dev/null; then
  as_root=""
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  $as_root apt-get update -qq
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends prusa-slicer
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The Z450's bed, pixels and layers; no supports, no corrections.
cat > "$work/z450.ini" << 'INI'
printer_technology = SLA
display_width = 203.2
display_height = 254
display_pixels_x = 2400
display_pixels_y = 4500
bed_shape = 0x0,203.2x0,203.2x254,0x254
max_print_height = 204
layer_height = 0.102
initial_layer_height = 0.102
supports_enable = 0
pad_enable = 0
faded_layers = 3
slice_closing_radius = 0
relative_correction = 1,1
INI

seconds() {  # seconds COMMAND...: its wall time
  local start=$EPOCHREALTIME
  "$@" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  awk "BEGIN { print $EPOCHREALTIME - $start }"
}
peer() {  # peer MODEL SCALE
  prusa-slicer --export-sla --load "$work/z450.ini" --scale "$2" -o "$work/peer.sl1" "$1"
}
ours() {  # ours MODEL SCALE ENHANCE
  "$binderjet" slice "$1" --scale "$2" -p z450 --enhance "$3" -o "$work/job.bjob" -q
  "$binderjet" export "$work/job.bjob" -o "$work/stack" -q
}
middle() {  # middle NAME: median and range of the numbers on stdin
  sort -g | awk -v name="$1" '{ x[NR] = $1 }
    END { m = int((NR + 1) / 2)
          printf "%-31s median %.3f   range %.3f to %.3f\n", name, NR % 2 ? x[m] : (x[m] + x[m + 1]) / 2, x[1], x[NR] }'
}

compare() {  # compare MODEL SCALE
  echo "== $(basename "$1") x $2, $rounds rounds"
  rm -f "$work"/*.txt
  for ((round = 1; round <= rounds; ++round)); do
    p=$(seconds peer "$1" "$2")
    n=$(seconds ours "$1" "$2" none)
    e=$(seconds ours "$1" "$2" paper)
    i=$(seconds ours "$1" "$2" inverse)
    echo "round $round: PrusaSlicer $p s, binderjet none $n s, paper $e s, inverse $i s"
    echo "$p" >> "$work/peer.txt"
    awk "BEGIN { print $n / $p }" >> "$work/none.txt"
    awk "BEGIN { print $e / $p }" >> "$work/paper.txt"
    awk "BEGIN { print $i / $p }" >> "$work/inverse.txt"
  done
  middle "PrusaSlicer, s" < "$work/peer.txt"
  middle "--enhance none / PrusaSlicer" < "$work/none.txt"
  middle "--enhance paper / PrusaSlicer" < "$work/paper.txt"
  middle "--enhance inverse / PrusaSlicer" < "$work/inverse.txt"
}

if [ $# -gt 0 ]; then
  compare "$1" "${2:-1}"
else
  "$binderjet" coupon --kind golfball -o "$work/golfball.stl" -q
  compare "$work/golfball.stl" 4.4496  # 190 mm
  gargoyle=$data/models/clean/gargoyle.obj
  if [ -f "$gargoyle" ]; then
    compare "$gargoyle" 1
  else
    echo "the gargoyle is left out: there is no $gargoyle"
  fi
fi
