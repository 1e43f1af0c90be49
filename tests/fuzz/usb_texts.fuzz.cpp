// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's door to fuzz_usb_texts (targets.h).
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  binderjet::fuzz_usb_texts(data, size);
  return 0;
}
