#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Slices a part in shares under a real queue, Slurm, and under GNU parallel: one share is killed in
# its middle and run again, and what `join` makes has the bytes of slicing in one go.
#   bash tests/packages/install.sh program cluster
#   sudo bash tests/cluster/run.sh [build/binderjet]
# Needs root. The daemons live in namespaces of their own: none is left however this script ends,
# none takes a port of the machine, and a machine that belongs to a real cluster is not disturbed.
set -euo pipefail
export PATH=$PATH:/usr/sbin:/sbin
here=$(cd "$(dirname "$0")" && pwd)

if [ "${1:-}" != --inside ]; then
  for tool in unshare ip munged slurmctld slurmd sbatch parallel; do
    command -v "$tool" > /dev/null || {
      echo "run.sh: no $tool: bash tests/packages/install.sh cluster" >&2
      exit 1
    }
  done
  [ "$(id -u)" -eq 0 ] || {
    echo "run.sh: a queue of its own needs root: call it with sudo" >&2
    exit 1
  }
  BINDERJET=$(realpath "${1:-$here/../../build/binderjet}")
  export BINDERJET
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  chmod 711 "$work"  # munged refuses a socket that nobody else could reach
  unshare --pid --fork --kill-child --mount-proc --net --uts bash "$here/run.sh" --inside "$work"
  exit
fi

work=$2
cd "$work"
. "$here/slurm.sh"
say() { echo "$SECONDS s: $1"; }
fail() {
  echo "FAIL: $1" >&2
  [ ! -d "$work/slurm" ] || tail -n 20 "$work"/slurm/*.log >&2
  exit 1
}

"$BINDERJET" coupon --kind golfball -o ball.stl -q
export SLICE="$work/ball.stl -p z450 --scale 0.1" SHARES=4 LAYERS HOLD
read -ra words <<< "$SLICE"
LAYERS=$("$BINDERJET" slice "${words[@]}" -o whole.bjob --json -q |
  python3 -c 'import json, sys; print(json.load(sys.stdin)["layers"])')
mkfifo held

# slice_in_shares FOLDER: `run_shares` starts all shares and waits for them, `run_again` only those
# that failed. Share 1 is the one that is killed.
slice_in_shares() {
  mkdir "$1"
  cd "$1"
  HOLD=1:../held run_shares &
  shares=$!
  read -r -t 60 held <> ../held || fail "share 1 did not begin within a minute"
  kill -KILL "$held"
  wait "$shares" && fail "a killed share counts as done"
  [ ! -e share_1.bjob ] || fail "a killed share left a file under its name"
  "$BINDERJET" join share_*.bjob -o joined.bjob 2> join.err && fail "a share was not missed"
  grep -q "layers $((LAYERS / SHARES)) to" join.err || fail "$(cat join.err)"
  HOLD="" run_again
  "$BINDERJET" join share_*.bjob -o joined.bjob -q
  cmp joined.bjob ../whole.bjob || fail "shares and one go give other bytes"
  say "$1: $SHARES shares, one of them killed and run again, joined to the same bytes"
  cd ..
}

run_shares() { seq 0 $((SHARES - 1)) | parallel --joblog log bash "$here/share.sh"; }
run_again() { parallel --joblog log --retry-failed; }
slice_in_shares parallel

mkdir slurm
start_slurm "$work/slurm"
say "a Slurm is there"
run_shares() { sbatch --quiet --wait --array="0-$((SHARES - 1))" "$here/share.sh"; }
run_again() { sbatch --quiet --wait --array=1 "$here/share.sh"; }
slice_in_shares queue
