#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One of SHARES shares of a part of LAYERS layers, as a task of Slurm or of GNU parallel: share.sh
# [NUMBER], the first is 0. From the environment: BINDERJET, SLICE (the words that are the same for all
# shares), SHARES and LAYERS. share_NUMBER.bjob goes to the folder that the task runs in.
#
# Where HOLD is NUMBER:PIPE, that share stops once it has begun to write and names its process to
# the pipe. So a test kills a share in its middle, and not when a clock says so.
set -euo pipefail
share=${1:-$SLURM_ARRAY_TASK_ID}
layers=$((share * LAYERS / SHARES)):$(((share + 1) * LAYERS / SHARES))
out=share_$share.bjob

read -ra words <<< "$SLICE"
"$BINDERJET" slice "${words[@]}" --layers "$layers" --threads 1 -o "$out" -q &
slicing=$!
if [ "${HOLD%%:*}" = "$share" ]; then
  until compgen -G "$out.*.part" > /dev/null; do :; done
  kill -STOP "$slicing"
  echo "$slicing" > "${HOLD#*:}"
fi
wait "$slicing"
