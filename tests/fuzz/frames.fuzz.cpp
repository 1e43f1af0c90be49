// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's door to fuzz_frames (targets.h).
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  binderjet::fuzz_frames(data, size);
  return 0;
}
