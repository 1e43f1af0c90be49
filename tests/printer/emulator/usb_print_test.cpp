// SPDX-License-Identifier: GPL-3.0-or-later
// Printing over USB when all is well, and the ways a printer cannot be had.
#include <sys/stat.h>

#include "tests/printer/emulator/printer_fixture.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

using UsbPrint = PrinterTest;

TEST_F(UsbPrint, SendsEachLayerOnceAndEndsInTheSameDigest) {
  const auto printed = print();
  ASSERT_TRUE(printed) << printed.error().where << ": " << printed.error().what;
  expect_printed_once();
  EXPECT_EQ(job().state, JobState::kDone);
  EXPECT_EQ(job().acknowledged, kPrintLayers);
}

}  // namespace
}  // namespace binderjet
