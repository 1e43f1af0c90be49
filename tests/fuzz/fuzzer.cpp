// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's door to the target that BINDERJET_TARGET names (targets.h).
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  binderjet::BINDERJET_TARGET(data, size);
  return 0;
}
