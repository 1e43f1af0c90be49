// SPDX-License-Identifier: GPL-3.0-or-later
// An emulated printer as a host reaches it: over the socket in its folder.
//
// There is no thread: bytes move whenever the link is asked anything, and what the system has
// buffered moves by itself. A restart is a new connection.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "transport/base/file.h"
#include "transport/base/result.h"
#include "transport/emulator/socket_frame.h"
#include "transport/printer/printer_link.h"

namespace binderjet {

class SocketLink : public PrinterLink {
 public:
  // kDevice if no emulated printer is running in the folder.
  static Result<std::unique_ptr<PrinterLink>> open(const std::string& folder,
                                                   const std::string& uri);
  SocketLink(std::string folder, std::string uri, File connection);

  const std::string& uri() const override { return uri_; }
  void post(std::vector<std::byte> bytes) override;
  std::size_t unsent() const override { return static_cast<std::size_t>(posted_ - taken_); }
  std::uint64_t sent() const override { return taken_; }
  std::vector<std::byte> take_input() override;
  LinkState state() const override { return state_; }
  std::string trouble() const override { return trouble_; }
  void wait(Clock::time_point until) override;
  bool restart() override;

 private:
  // Moves what can be moved, waiting for that until `until` at most; whether anything moved.
  bool move_bytes(Clock::time_point until);
  void send_some();
  void receive_some();
  void take(SocketFrame frame);
  void set_state(LinkState state, const std::string& why);

  std::string folder_;
  std::string uri_;
  File connection_;
  bool used_ = false;  // something was said over this connection

  LinkState state_ = LinkState::kFine;
  std::string trouble_;
  bool ready_ = false;
  std::vector<std::byte> out_;  // not yet given to the system, from out_at_ on
  std::size_t out_at_ = 0;
  std::uint64_t posted_ = 0;
  std::uint64_t taken_ = 0;
  SocketFrames frames_;
  std::vector<std::byte> input_;
};

}  // namespace binderjet
