#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing and builds: build.sh [all|program|package] [FOLDER]
# `all`, as without a word, is the program and its tests; `program` downloads half as much; `package`
# is that with the man pages, and what driver/package/ takes.
set -euo pipefail
cd "$(dirname "$0")/.."
what=${1:-all}
build=${2:-build}

case $what in
  all) lists=(program package tests) testing=ON targets=(all) ;;
  program) lists=(program) testing=OFF targets=(binderjet) ;;
  package) lists=(program package) testing=OFF targets=(binderjet manual) ;;
  *) echo "build.sh: $what is none of all, program and package" >&2; exit 2 ;;
esac
bash tests/packages/install.sh "${lists[@]}"
cmake -S . -B "$build" -G Ninja -DBUILD_TESTING="$testing"
cmake --build "$build" -j 2 -t "${targets[@]}"
