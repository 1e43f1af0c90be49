#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Puts each fault of this folder (or of the patches named) into the code by itself, runs the tests
# that should notice in build/, and takes it out again. Prints the table of tests/README.md; fails
# if a fault goes unnoticed.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -gt 0 ] || set -- tests/mutations/*.patch
log=$(mktemp)
unnoticed=0
for patch in "$@"; do
  fault=$(sed -n 's/^Fault: //p' "$patch")
  read -r program filter < <(sed -n 's/^Test: //p' "$patch")
  git apply "$patch"
  trap 'git apply -R "$patch"; rm -f "$log"' EXIT
  ninja -C build "$program" > "$log" || { cat "$log"; exit 1; }
  if timeout 600 "build/tests/$program" --gtest_filter="$filter" --gtest_fail_fast > "$log" 2>&1
  then
    by="**nobody**"
    unnoticed=$((unnoticed + 1))
  else
    # The last one that began, where the program did not live to say that it failed.
    by=$(grep -m1 '^\[  FAILED' "$log" || grep '^\[ RUN' "$log" | tail -1)
    by=$(sed -E 's/^\[[^]]*\] ([^ ,]*).*/\1/' <<< "$by")
  fi
  git apply -R "$patch"
  trap 'rm -f "$log"' EXIT
  echo "| $(sed -n 's/^+++ b\///p' "$patch") | $fault | $by |"
done
[ "$unnoticed" -eq 0 ]
