#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds Debian's oneTBB from its source for the thread sanitizer, which sees no order between tasks
# of the one that is installed; leaves the library in $1/lib.
set -euo pipefail
mkdir -p "$1"
cd "$1"
[ ! -e lib/libtbb.so.12 ] || exit 0
# A package list of its own, so that it needs no rights and leaves the machine's as it is.
mkdir -p lists/partial
echo "deb-src http://deb.debian.org/debian bookworm main" > source.list
apt=(apt-get -qq -o Dir::State::Lists="$PWD/lists" -o Dir::Etc::SourceList="$PWD/source.list"
     -o Dir::Etc::SourceParts=/dev/null)
"${apt[@]}" update
"${apt[@]}" source onetbb
cmake -S onetbb-*/ -B build -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread \
  -DCMAKE_CXX_FLAGS=-Wno-tsan -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF \
  -DTBB_OUTPUT_DIR_BASE=out > /dev/null
cmake --build build -j 2 -t tbb
ln -sfn build/out_relwithdebinfo lib
