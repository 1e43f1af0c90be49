#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs, builds and runs every test; says which seeds the random ones took.
set -euo pipefail
cd "$(dirname "$0")/.."
bash tests/build.sh
status=0
ctest --test-dir build --output-on-failure -j 2 "$@" || status=$?
echo
echo "Seeds, to run a random test again with the same:"
awk '/ Test: / { test = $3 } /^BINDERJET_SEED=/ { print "  " $0 "  " test }' \
  build/Testing/Temporary/LastTest.log
exit "$status"
