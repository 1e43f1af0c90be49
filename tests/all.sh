#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs, builds and runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
bash tests/build.sh
ctest --test-dir build --output-on-failure -j 2 "$@"
