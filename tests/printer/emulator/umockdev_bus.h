// SPDX-License-Identifier: GPL-3.0-or-later
// A USB bus of umockdev's making, with one emulated device on it: this process and its children see
// it through Debian's own libusb.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "transport/emulator/emulated_usb_device.h"

namespace binderjet {

class UmockdevBus {
 public:
  // The device must outlive the bus. Plugs it in.
  explicit UmockdevBus(EmulatedUsbDevice& device);
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  // The node goes and comes, with the events that hotplug listens to.
  void remove();
  void add();

  // Refusals of the system, until taken back.
  void set_busy(bool busy);              // another program has claimed it
  void set_usblp(bool bound);            // the kernel's driver has it until it is detached
  void set_no_memory(std::size_t most);  // bytes that may be in flight; 0: no bound
  bool usblp_detached() const;

  // The node's file, for its rights; and how often a program asked for finished transfers in vain,
  // which tells a poll from a wait.
  std::string node() const;
  int empty_reaps() const;
  std::size_t max_in_flight() const;  // transfers

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace binderjet
