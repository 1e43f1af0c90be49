// SPDX-License-Identifier: GPL-3.0-or-later
// An emulated USB device as its front ends see it: control requests and two bulk pipes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
namespace binderjet {
enum class UsbOutcome { kOk, kNak, kStall, kGone };
struct ControlSetup {
  std::uint8_t request_type, request;
  std::uint16_t value, index, length;
};
struct UsbReply {
  UsbOutcome outcome = UsbOutcome::kOk;
  std::vector<std::byte> data;
};  // IN
struct UsbTaken {
  UsbOutcome outcome = UsbOutcome::kOk;
  std::size_t bytes = 0;
};  // OUT: bytes taken before the outcome
class EmulatedUsbDevice {
 public:
  virtual ~EmulatedUsbDevice() = default;
  virtual std::vector<std::byte> device_descriptor() const = 0;  // 18 bytes
  virtual std::vector<std::byte> configuration_descriptor()
      const = 0;  // whole, printer class 07/01/02, bulk OUT 0x01, bulk IN 0x82
  virtual std::vector<std::byte> string_descriptor(int index) const = 0;
  virtual UsbReply control(
      const ControlSetup& setup,
      std::span<const std::byte> out) = 0;  // class requests and standard ones a front end forwards
  virtual UsbTaken bulk_out(
      std::span<const std::byte> data) = 0;        // kNak: try again later with what was not taken
  virtual UsbReply bulk_in(std::size_t most) = 0;  // kNak: nothing to say yet
  virtual void clear_halt(std::uint8_t endpoint) = 0;
};
}  // namespace binderjet
