// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated printer's descriptors and control requests, and what a person or a test does to it.
#include <algorithm>
#include <string_view>
#include <utility>

#include "transport/emulator/printer_emulator.h"

namespace binderjet {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

}  // namespace

std::vector<std::byte> PrinterEmulator::device_descriptor() const {
  // 1209:0001 is the id that pid.codes reserves for testing.
  return bytes({18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x09, 0x12, 0x01, 0x00, 0x00, 0x01, 1, 2, 3, 1});
}

std::vector<std::byte> PrinterEmulator::configuration_descriptor() const {
  return bytes({9, 2, 32,   0, 1,    1,    0, 0xc0, 1,  // one interface, self-powered
                9, 4, 0,    0, 2,    7,    1, 2,    0,  // printer class, bidirectional
                7, 5, 0x01, 2, 0x00, 0x02, 0,           // bulk OUT, 512 bytes
                7, 5, 0x82, 2, 0x00, 0x02, 0});         // bulk IN, 512 bytes
}

std::vector<std::byte> PrinterEmulator::string_descriptor(int index) const {
  if (index == 0) return bytes({4, 3, 0x09, 0x04});
  const std::string text = index == 1   ? "binderjet"
                           : index == 2 ? "emulated printer"
                           : index == 3 ? options_.serial
                                        : "";
  if (text.empty()) return {};
  std::vector<std::byte> out = bytes({static_cast<int>(2 + 2 * text.size()), 3});
  for (const char c : text) {
    out.push_back(static_cast<std::byte>(c));
    out.push_back(std::byte{0});
  }
  return out;
}

std::vector<std::byte> PrinterEmulator::device_id() {
  const std::string text =
      "MFG:binderjet;MDL:emulated printer;CMD:BINDERJET-1;CLS:PRINTER;SER:" + options_.serial + ";";
  const int length = static_cast<int>(text.size()) + 2;
  std::vector<std::byte> out = bytes({length >> 8, length & 0xff});
  if (fire_now(PrinterFault::kSwappedDeviceId)) std::swap(out[0], out[1]);
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
  return out;
}

UsbReply PrinterEmulator::control(const ControlSetup& setup, std::span<const std::byte>) {
  const std::lock_guard lock(mutex_);
  if (gone_) return {UsbOutcome::kGone, {}};
  if (std::any_of(plan_.begin(), plan_.end(), [](const PlannedFault& fault) {
        return fault.what == PrinterFault::kHangControl && fault.times != 0;
      })) {
    return {UsbOutcome::kNak, {}};
  }
  UsbReply reply;
  switch (setup.request_type << 8 | setup.request) {
    case 0xa100:  // GET_DEVICE_ID
      if (fire_now(PrinterFault::kStallDeviceId)) return {UsbOutcome::kStall, {}};
      reply.data = device_id();
      break;
    case 0xa101:  // GET_PORT_STATUS: selected, no error
      reply.data = bytes({fire_now(PrinterFault::kPortStatus) ? 0x20 : 0x18});
      break;
    case 0x2102:  // SOFT_RESET, class 1.1
      if (std::any_of(plan_.begin(), plan_.end(), [](const PlannedFault& fault) {
            return fault.what == PrinterFault::kResetClass10 && fault.times != 0;
          })) {
        return {UsbOutcome::kStall, {}};
      }
      [[fallthrough]];
    case 0x2302:  // SOFT_RESET, class 1.0
      ++resets_;
      end_session();
      halted_out_ = halted_in_ = false;
      break;
    case 0x8006: {  // GET_DESCRIPTOR
      const int index = setup.value & 0xff;
      if (setup.value >> 8 == 1) reply.data = device_descriptor();
      if (setup.value >> 8 == 2) reply.data = configuration_descriptor();
      if (setup.value >> 8 == 3) reply.data = string_descriptor(index);
      if (reply.data.empty()) return {UsbOutcome::kStall, {}};
      break;
    }
    case 0x8008:  // GET_CONFIGURATION
      reply.data = bytes({1});
      break;
    case 0x8000:  // GET_STATUS
    case 0x8100:
    case 0x8200:
      reply.data = bytes({setup.request_type == 0x80 ? 1 : 0, 0});
      break;
    case 0x0009:  // SET_CONFIGURATION
    case 0x010b:  // SET_INTERFACE
      end_session();
      halted_out_ = halted_in_ = false;
      break;
    case 0x0201:  // CLEAR_FEATURE of an endpoint
      if ((setup.index & 0x80) != 0) {
        halted_in_ = false;
      } else {
        halted_out_ = false;
      }
      break;
    default:
      return {UsbOutcome::kStall, {}};
  }
  if (reply.data.size() > setup.length) reply.data.resize(setup.length);
  return reply;
}

void PrinterEmulator::clear_halt(std::uint8_t endpoint) {
  const std::lock_guard lock(mutex_);
  ((endpoint & 0x80) != 0 ? halted_in_ : halted_out_) = false;
}

bool PrinterEmulator::gone() const {
  const std::lock_guard lock(mutex_);
  return gone_;
}

void PrinterEmulator::plug() {
  const std::lock_guard lock(mutex_);
  end_session();
  gone_ = false;
  nak_until_ = silent_until_ = {};
}

void PrinterEmulator::unplug() {
  const std::lock_guard lock(mutex_);
  if (!gone_) lose_power(true);
}

void PrinterEmulator::refill() {
  const std::lock_guard lock(mutex_);
  stopped_.clear();
  if (session_) say_status();
}

void PrinterEmulator::mend() {
  if (gone()) plug();
  refill();
}

void PrinterEmulator::heal() {
  refill();
  set_plan({});
  if (gone()) plug();
  const std::lock_guard lock(mutex_);
  nak_until_ = silent_until_ = no_credit_until_ = late_until_ = {};
  layer_time_ = options_.layer_time;
}

void PrinterEmulator::set_plan(FaultPlan plan) {
  const std::lock_guard lock(mutex_);
  plan_ = std::move(plan);
}

std::vector<EmulatedJob> PrinterEmulator::jobs() const {
  const std::lock_guard lock(mutex_);
  return jobs_;
}

void PrinterEmulator::add_fault(PlannedFault fault) {
  const std::lock_guard lock(mutex_);
  plan_.push_back(fault);
}

bool PrinterEmulator::wait_for_layers(int layers, std::size_t job) {
  std::unique_lock lock(mutex_);
  return printed_.wait_for(lock, std::chrono::seconds(20), [&] {
    return jobs_.size() >= job && static_cast<int>(jobs_[job - 1].layers.size()) >= layers;
  });
}

int PrinterEmulator::acknowledged() const {
  const std::lock_guard lock(mutex_);
  return jobs_.empty() ? 0 : static_cast<int>(jobs_.back().layers.size());
}

std::vector<int> PrinterEmulator::record() const {
  const std::lock_guard lock(mutex_);
  if (jobs_.empty()) return {};
  const auto found = record_.find(jobs_.back().number);
  return found == record_.end() ? std::vector<int>() : found->second;
}

int PrinterEmulator::sent_again() const {
  const std::lock_guard lock(mutex_);
  return sent_again_;
}

int PrinterEmulator::max_waiting() const {
  const std::lock_guard lock(mutex_);
  return max_waiting_;
}

int PrinterEmulator::resets() const {
  const std::lock_guard lock(mutex_);
  return resets_;
}

std::uint64_t PrinterEmulator::bytes_taken() const {
  const std::lock_guard lock(mutex_);
  return bytes_taken_;
}

}  // namespace binderjet
