// SPDX-License-Identifier: GPL-3.0-or-later
// The known devices, and reading what a device says of itself.
#include "transport/usb/usb_quirks.h"

#include <algorithm>
#include <charconv>

namespace binderjet {
namespace {

std::optional<std::uint16_t> hex4(std::string_view text) {
  std::uint16_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.empty() || text.size() > 4 || error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

// "MANUFACTURER" and "MFG" are the same key.
std::string_view short_key(std::string_view key) {
  if (key == "MANUFACTURER") return "MFG";
  if (key == "MODEL") return "MDL";
  if (key == "COMMAND SET") return "CMD";
  if (key == "SERIALNUMBER" || key == "SN") return "SER";
  return key;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

const std::vector<UsbModel>& known_usb_models() {
  static const std::vector<UsbModel> kModels = {
      // pid.codes reserves this id for testing; the emulated printer has it. No product has an id
      // yet: a printer built to PROTOCOL.md is named in its profile or in the URI.
      {0x1209, 0x0001, {}},
  };
  return kModels;
}

std::optional<UsbModel> parse_usb_model(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto vendor = hex4(text.substr(0, colon));
  const auto product = hex4(text.substr(colon + 1));
  if (!vendor || !product) return std::nullopt;
  return UsbModel{*vendor, *product, {}};
}

std::optional<UsbModel> parse_usb_model_words(std::string_view text) {
  std::size_t blank = std::min(text.find(' '), text.size());
  std::optional<UsbModel> model = parse_usb_model(text.substr(0, blank));
  while (model && blank < text.size()) {
    text.remove_prefix(blank + 1);
    blank = std::min(text.find(' '), text.size());
    if (!set_usb_quirk(text.substr(0, blank), model->quirks)) return std::nullopt;
  }
  return model;
}

bool set_usb_quirk(std::string_view word, UsbQuirks& quirks) {
  if (word == "device-id-little-endian") return quirks.device_id_little_endian = true;
  if (word == "no-device-id") return quirks.no_device_id = true;
  if (word == "soft-reset-1.0") return quirks.soft_reset_1_0 = true;
  return false;
}

std::string device_id_text(std::string_view answer, const UsbQuirks& quirks) {
  if (answer.size() < 2) return "";
  std::size_t high = static_cast<unsigned char>(answer[0]);
  std::size_t low = static_cast<unsigned char>(answer[1]);
  if (quirks.device_id_little_endian) std::swap(high, low);
  const std::size_t claimed = high * 256 + low;  // with the two bytes of the length itself
  const std::size_t length = claimed < 2 ? answer.size() : std::min(claimed, answer.size());
  std::string text(answer.substr(2, length - 2));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return text;
}

std::string device_id_value(std::string_view device_id, std::string_view key) {
  while (!device_id.empty()) {
    const std::size_t end = std::min(device_id.find(';'), device_id.size());
    const std::string_view field = device_id.substr(0, end);
    device_id.remove_prefix(std::min(end + 1, device_id.size()));
    const std::size_t colon = field.find(':');
    if (colon == std::string_view::npos) continue;
    if (short_key(trimmed(field.substr(0, colon))) == short_key(key)) {
      return std::string(trimmed(field.substr(colon + 1)));
    }
  }
  return "";
}

}  // namespace binderjet
