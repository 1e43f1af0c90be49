// SPDX-License-Identifier: GPL-3.0-or-later
// What a USB printer says of itself, and the words for what it does otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "transport/usb/usb_quirks.h"

namespace binderjet {
namespace {

TEST(DeviceId, IsReadWithEitherByteOrder) {
  const std::string text = "MANUFACTURER:a b;MDL: c ;CMD:BINDERJET-1;";
  const std::string length = {'\0', static_cast<char>(text.size() + 2)};
  const std::string swapped = {length[1], length[0]};
  const UsbQuirks none;
  UsbQuirks little;
  ASSERT_TRUE(set_usb_quirk("device-id-little-endian", little));
  EXPECT_EQ(device_id_text(length + text, none), text);
  EXPECT_EQ(device_id_text(swapped + text, little), text);
  EXPECT_EQ(device_id_text(swapped + text, none), text) << "a length beyond the answer is cut";
  EXPECT_EQ(device_id_text("", none), "");
  EXPECT_EQ(device_id_value(text, "MFG"), "a b");
  EXPECT_EQ(device_id_value(text, "MDL"), "c");
  EXPECT_EQ(device_id_value(text, "SER"), "");
}

TEST(UsbModel, IsReadWithItsQuirksAndNothingElse) {
  const auto model = parse_usb_model_words("1209:0001 no-device-id soft-reset-1.0");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->vendor, 0x1209);
  EXPECT_TRUE(model->quirks.no_device_id && model->quirks.soft_reset_1_0);
  EXPECT_FALSE(model->quirks.device_id_little_endian);
  for (const char* wrong : {"", "1209", "1209:", "12091:1", "1209:0001 no-such", "1209:0001 "}) {
    EXPECT_FALSE(parse_usb_model_words(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace binderjet
