#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tests of transport and of the emulated printer, those too that run the program, once more with
# the address and the undefined-behaviour sanitizer, as a user without rights; builds into
# build-sanitize/ (or $1).
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build-sanitize}
tests=(transport_test emulator_test usb_test fuzz_test)

flags="-O1 -g1 -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=undefined"
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags"
cmake --build "$build" -j 2 -t binderjet "${tests[@]}"

# The preloaded part of umockdev comes before the sanitizer's, which is right here.
export ASAN_OPTIONS=verify_asan_link_order=0
export LSAN_OPTIONS=suppressions=$PWD/tests/sanitize_leaks.txt:print_suppressions=0
run=()
if [ "$(id -u)" -eq 0 ]; then
  run=(setpriv --reuid=nobody --regid=nogroup --clear-groups env HOME=/tmp)
fi
programs=$(realpath "$build")/tests
cd "$(mktemp -d)"
chmod 777 .
for test in "${tests[@]}"; do
  # Whole stacks, which only these libraries' leaks need, make the other tests too slow.
  if [ "$test" = fuzz_test ]; then ASAN_OPTIONS+=:fast_unwind_on_malloc=0; fi
  "${run[@]}" "$programs/$test" --gtest_brief=1
done
