#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tests once more with the address and the undefined-behavior sanitizer (`address`), with the
# thread sanitizer (`thread`), or, without a word, with both. Builds into build-address/ and
# build-thread/.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- address thread
bash tests/packages/install.sh program package tests

as_nobody=()
if [ "$(id -u)" -eq 0 ]; then
  as_nobody=(setpriv --reuid=nobody --regid=nogroup --clear-groups env HOME=/tmp)
  if ! "${as_nobody[@]}" test -r tests/sanitize.sh; then
    echo "Some tests run as nobody, who cannot read $PWD: chmod a+x the folders on the way" >&2
    exit 1
  fi
fi
# Left out: what measures time or memory or looks at pages, and what takes a minute with a sanitizer
# and is not the only test of its code. SLOW= runs all of it.
slow='StaysWithin|WithinASecond|Viewer|NastyFile|CleanModel|Export3mf.(Has|Gives|IsAcc)|^Disk|^Names'
slow+='|^Portable|^Terminal|^Keys|CouponOfKind|^EmulatorVerb.Killed|^Changing|^Interrupted|PaperColor|PaperGargoyle|Mend.NeverMakes|SecondPrint'
slow+='|^Inverse.(Never|Answers|Keeps|GivesTheSameInPiecesBlocks)|Calibrate.(NamesBleed|SaysOnWhat)'
slow_thread='|^Export|^Slots|^Measured|^Interrupt.Ends|Calibrate.(Gives|Takes|Finds|NamesThe)'

# The preloaded part of umockdev comes before the sanitizer's, which is right here.
export ASAN_OPTIONS=verify_asan_link_order=0
export LSAN_OPTIONS=suppressions=$PWD/tests/sanitize_leaks.txt:print_suppressions=0
export TSAN_OPTIONS=suppressions=$PWD/tests/sanitize_races.txt:halt_on_error=1

# The tests of a program, started by the words behind it, but those of $leave_out: in two processes at
# once. Not by &, which lets them, and what they start, ignore Ctrl-C.
run_in_halves() {
  local names
  names=$("$1" --gtest_list_tests | awk '/^[^ ]/ { suite = $1 } /^ / { print suite $1 }' |
          grep -vE "${leave_out:-^$}" | paste -sd:)
  printf '%s\n' 0 1 | GTEST_FILTER=$names GTEST_TOTAL_SHARDS=2 xargs -P 2 -I{} \
    env GTEST_SHARD_INDEX={} "${@:2}" "$1" --gtest_brief=1
}

for sanitizer in "$@"; do
  build=$PWD/build-$sanitizer
  # `alone` talks to printers or reads strangers' bytes: as a user without rights, leaks looked for.
  # `computing` runs in one process a room: a start, with the libraries of all readers, costs a
  # second with a sanitizer, and most tests less. `rest` starts the program anyway: by ctest.
  case $sanitizer in
    address)
      flags="-fsanitize=address,undefined -fno-sanitize-recover=undefined"
      libraries=()
      alone=(transport emulator usb fuzz)
      computing=(slicer paper properties hidden_printers)
      rest=(read driver trust install)
      leave_out=${SLOW-$slow}
      ;;
    thread)  # what computes in parallel or sends
      bash tests/build_tsan_tbb.sh "$build/tbb"
      flags="-fsanitize=thread"
      libraries=(-DCMAKE_BUILD_RPATH="$build/tbb/lib")
      alone=(transport emulator)
      computing=(slicer properties hidden_printers)
      rest=(driver)
      leave_out=${SLOW-$slow$slow_thread}
      ;;
  esac
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None "${libraries[@]}" \
    -DCMAKE_CXX_FLAGS="-O1 -g1 -D_GLIBCXX_ASSERTIONS $flags"
  cmake --build "$build" -j 2 -t binderjet \
    "${alone[@]/%/_test}" "${computing[@]/%/_test}" "${rest[@]/%/_test}"
  folder=$(mktemp -d)
  chmod 777 "$folder"
  for room in "${alone[@]}"; do
    # Whole stacks, which only the mesh readers' leaks need, make the other tests too slow.
    options=$ASAN_OPTIONS
    if [ "$room" = fuzz ]; then options+=:fast_unwind_on_malloc=0; fi
    program=$build/tests/${room}_test
    case $room in
      emulator|usb)  # as in ctest: their clocks would measure other tests
        (cd "$folder" && ASAN_OPTIONS=$options "${as_nobody[@]}" "$program" --gtest_brief=1) ;;
      *)
        (cd "$folder" && leave_out='' ASAN_OPTIONS=$options \
          run_in_halves "$program" "${as_nobody[@]}") ;;
    esac
  done
  # Debian's libzip and OpenImageIO leak a little in every run.
  for room in "${computing[@]}"; do
    ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 run_in_halves "$build/tests/${room}_test"
  done
  ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 ctest --test-dir "$build" -j 2 --output-on-failure \
    -L "^($(IFS='|'; echo "${rest[*]}"))$" -E "$leave_out"
done
