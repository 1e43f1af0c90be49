// SPDX-License-Identifier: GPL-3.0-or-later
// Ties the C callbacks of libusbredirparser to a UsbredirPort.
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

#include "tests/printer/emulator/usbredir_port.h"

namespace binderjet {
namespace {

UsbredirPort& port(void* self) { return *static_cast<UsbredirPort*>(self); }

}  // namespace

UsbredirPort::UsbredirPort(EmulatedUsbDevice& device, int socket)
    : device_(device), socket_(socket), parser_(usbredirparser_create()) {
  if (parser_ == nullptr) std::abort();
  set_callbacks();
  set_callbacks_of_other_pipes();
  std::uint32_t caps[USB_REDIR_CAPS_SIZE] = {};
  for (const int cap : {usb_redir_cap_connect_device_version, usb_redir_cap_filter,
                        usb_redir_cap_device_disconnect_ack, usb_redir_cap_ep_info_max_packet_size,
                        usb_redir_cap_64bits_ids, usb_redir_cap_32bits_bulk_length}) {
    usbredirparser_caps_set_cap(caps, cap);
  }
  usbredirparser_init(parser_.get(), "binderjet emulator", caps, USB_REDIR_CAPS_SIZE,
                      usbredirparser_fl_usb_host);
}

bool UsbredirPort::read() {
  // A message it cannot parse is skipped; the next call would go on behind it, but a peer that
  // sends one is broken.
  return usbredirparser_do_read(parser_.get()) == 0;
}

bool UsbredirPort::write() { return usbredirparser_do_write(parser_.get()) == 0; }

void UsbredirPort::set_callbacks() {
  usbredirparser& on = *parser_;
  on.priv = this;
  on.log_func = [](void* self, int level, const char* text) {
    if (level <= usbredirparser_warning) port(self).complaint_ = text;
  };
  on.read_func = [](void* self, std::uint8_t* data, int count) {
    const ssize_t got = recv(port(self).socket_, data, static_cast<std::size_t>(count), 0);
    if (got > 0) return static_cast<int>(got);
    return got < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
  };
  on.write_func = [](void* self, std::uint8_t* data, int count) {
    const ssize_t sent =
        send(port(self).socket_, data, static_cast<std::size_t>(count), MSG_NOSIGNAL);
    if (sent >= 0) return static_cast<int>(sent);
    return errno == EAGAIN || errno == EINTR ? 0 : -1;
  };
  on.hello_func = [](void* self, usb_redir_hello_header*) { port(self).announce(); };
  on.reset_func = [](void* self) { port(self).reset(); };
  on.cancel_data_packet_func = [](void* self, std::uint64_t id) { port(self).cancel(id); };
  on.device_disconnect_ack_func = [](void* self) { port(self).awaits_ack_ = false; };
  on.filter_reject_func = [](void* self) {
    port(self).complaint_ = "the peer's filter refuses it";
  };
  on.filter_filter_func = [](void*, usbredirfilter_rule* rules, int) { std::free(rules); };
  on.set_configuration_func = [](void* self, std::uint64_t id,
                                 usb_redir_set_configuration_header* head) {
    port(self).set_configuration(id, head->configuration);
  };
  on.get_configuration_func = [](void* self, std::uint64_t id) {
    usb_redir_configuration_status_header status{};
    status.configuration = port(self).configuration_;
    usbredirparser_send_configuration_status(port(self).parser_.get(), id, &status);
  };
  on.set_alt_setting_func = [](void* self, std::uint64_t id,
                               usb_redir_set_alt_setting_header* head) {
    port(self).set_alternate(id, head->interface, head->alt);
  };
  on.get_alt_setting_func = [](void* self, std::uint64_t id,
                               usb_redir_get_alt_setting_header* head) {
    usb_redir_alt_setting_status_header status{};
    status.interface = head->interface;
    usbredirparser_send_alt_setting_status(port(self).parser_.get(), id, &status);
  };
  // The bytes are the parser's to free, whatever happens to the transfer.
  on.control_packet_func = [](void* self, std::uint64_t id, usb_redir_control_packet_header* head,
                              std::uint8_t* data, int size) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    port(self).queue_control(id, *head, {first, first + size});
    usbredirparser_free_packet_data(port(self).parser_.get(), data);
  };
  on.bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* head,
                           std::uint8_t* data, int size) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    port(self).queue_bulk(id, *head, {first, first + size});
    usbredirparser_free_packet_data(port(self).parser_.get(), data);
  };
}

// A printer has no such pipes. The parser calls without looking, so each needs an answer: no.
void UsbredirPort::set_callbacks_of_other_pipes() {
  usbredirparser& on = *parser_;
  on.start_iso_stream_func = [](void* self, std::uint64_t id,
                                usb_redir_start_iso_stream_header* head) {
    usb_redir_iso_stream_status_header no{usb_redir_inval, head->endpoint};
    usbredirparser_send_iso_stream_status(port(self).parser_.get(), id, &no);
  };
  on.stop_iso_stream_func = [](void*, std::uint64_t, usb_redir_stop_iso_stream_header*) {};
  on.start_interrupt_receiving_func = [](void* self, std::uint64_t id,
                                         usb_redir_start_interrupt_receiving_header* head) {
    usb_redir_interrupt_receiving_status_header no{usb_redir_inval, head->endpoint};
    usbredirparser_send_interrupt_receiving_status(port(self).parser_.get(), id, &no);
  };
  on.stop_interrupt_receiving_func = [](void*, std::uint64_t,
                                        usb_redir_stop_interrupt_receiving_header*) {};
  on.iso_packet_func = [](void* self, std::uint64_t, usb_redir_iso_packet_header*,
                          std::uint8_t* data,
                          int) { usbredirparser_free_packet_data(port(self).parser_.get(), data); };
  on.interrupt_packet_func = [](void* self, std::uint64_t id,
                                usb_redir_interrupt_packet_header* head, std::uint8_t* data, int) {
    usbredirparser_free_packet_data(port(self).parser_.get(), data);
    usb_redir_interrupt_packet_header no{head->endpoint, usb_redir_inval, 0};
    usbredirparser_send_interrupt_packet(port(self).parser_.get(), id, &no, nullptr, 0);
  };
}

}  // namespace binderjet
