// SPDX-License-Identifier: GPL-3.0-or-later
// What single devices do otherwise than the USB printer class says; data, with the reason beside.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace binderjet {

struct UsbQuirks {
  // The class gives the device id's length in big-endian order; some firmware swaps it.
  bool device_id_little_endian = false;
  // GET_DEVICE_ID hangs or upsets some firmware; the device is then known by its numbers only.
  bool no_device_id = false;
  // SOFT_RESET is 0x21/2 since class 1.1; devices of class 1.0 expect 0x23/2.
  bool soft_reset_1_0 = false;
};

// A device that may be spoken to without being named: "vid:pid" and its quirks' words.
struct UsbModel {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  UsbQuirks quirks;
};

// The models this program knows by itself.
const std::vector<UsbModel>& known_usb_models();

// "1209:0001"; nothing if it is not that.
std::optional<UsbModel> parse_usb_model(std::string_view text);
// The same with quirks behind it: "1209:0001 no-device-id soft-reset-1.0".
std::optional<UsbModel> parse_usb_model_words(std::string_view text);
// Sets the quirk of this word; false if there is none.
bool set_usb_quirk(std::string_view word, UsbQuirks& quirks);

// The text of an IEEE 1284 device id, as GET_DEVICE_ID's answer carries it behind two bytes of
// length. A length that does not fit the answer falls back on what is there.
std::string device_id_text(std::string_view answer, const UsbQuirks& quirks);
// The value of a key of a device id ("MFG", "MDL", "CMD"), long or short form; may be empty.
std::string device_id_value(std::string_view device_id, std::string_view key);

}  // namespace binderjet
