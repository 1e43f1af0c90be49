// SPDX-License-Identifier: GPL-3.0-or-later
// One emulated device as the far side of a usb-redir connection sees it: transfers in, answers out.
#pragma once

#include <usbredirparser.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "transport/emulator/emulated_usb_device.h"

namespace binderjet {

// Speaks the protocol on a connected, non-blocking socket and does every transfer in the order its
// endpoint got it. A transfer the device answers with kNak stays at the head of its endpoint and is
// tried again by attend(); nothing here waits.
//
// One limit comes from QEMU: it forgets how much of a cancelled OUT transfer was taken and tells
// its guest 0. Whoever streams through it must not trust that number.
class UsbredirPort {
 public:
  // `device` and `socket` outlive the port.
  UsbredirPort(EmulatedUsbDevice& device, int socket);
  UsbredirPort(const UsbredirPort&) = delete;
  UsbredirPort& operator=(const UsbredirPort&) = delete;

  // False once the peer has closed the connection or broken the protocol.
  bool read();
  bool write();
  bool wants_to_write() const { return usbredirparser_has_data_to_write(parser_.get()) > 0; }

  // Tries what is queued until the device takes and gives no more. True if anything moved.
  bool attend();
  // A transfer waits for the device.
  bool waiting() const;

  // The device said kGone, and the peer has been told.
  bool gone() const { return gone_; }
  // The peer knows that the device is gone; closing the connection loses nothing.
  bool parted() const { return gone_ && !awaits_ack_ && !wants_to_write(); }
  // The last complaint of the protocol's parser, or empty.
  const std::string& complaint() const { return complaint_; }

 private:
  struct Transfer {
    std::uint64_t id = 0;
    std::uint32_t length = 0;  // of an IN transfer: the most it takes
    std::vector<std::byte> out;
    std::size_t done = 0;  // bytes of `out` the device took
    usb_redir_control_packet_header control{};
    usb_redir_bulk_packet_header bulk{};
  };
  struct Endpoint {
    std::deque<Transfer> queue;
    bool halted = false;
  };
  struct ParserEnd {
    void operator()(usbredirparser* parser) const { usbredirparser_destroy(parser); }
  };

  void set_callbacks();
  void set_callbacks_of_other_pipes();
  void announce();
  void queue_control(std::uint64_t id, const usb_redir_control_packet_header& head,
                     std::vector<std::byte> out);
  void queue_bulk(std::uint64_t id, const usb_redir_bulk_packet_header& head,
                  std::vector<std::byte> out);
  void cancel(std::uint64_t id);
  void reset();
  void set_configuration(std::uint64_t id, std::uint8_t value);
  void set_alternate(std::uint64_t id, std::uint8_t interface, std::uint8_t alternate);

  bool attend(std::uint8_t address, Endpoint& endpoint);
  UsbOutcome do_control(Transfer& transfer);
  UsbReply standard_request(const ControlSetup& setup);
  UsbOutcome do_bulk(std::uint8_t address, Transfer& transfer);
  void answer(std::uint8_t address, Transfer& transfer, std::uint8_t status,
              std::vector<std::byte> data);
  void part();

  EmulatedUsbDevice& device_;
  int socket_;
  std::unique_ptr<usbredirparser, ParserEnd> parser_;
  std::map<std::uint8_t, Endpoint> endpoints_;  // by address; control is 0
  std::uint8_t configuration_ = 0;
  bool gone_ = false;
  bool awaits_ack_ = false;
  std::string complaint_;
};

}  // namespace binderjet
