// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of the ways to a printer share: an emulated one at the end of each, and senders of
// a small job.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "driver/emulator/printed_volume.h"
#include "tests/printer/emulator/umockdev_bus.h"
#include "tests/transport/sample_job.h"
#include "transport/emulator/printer_emulator.h"
#include "transport/emulator/socket_server.h"
#include "transport/open/open_backend.h"

namespace binderjet {

class SenderTest : public testing::Test {
 protected:
  virtual std::string uri() const = 0;  // to print to, with a second of patience
  // What a fault names.
  virtual std::string printer_uri() const = 0;

  std::unique_ptr<Backend> backend() {
    BackendOptions options;
    options.state_folder = folder_ / "state";
    auto opened = open_backend(uri(), options);
    EXPECT_TRUE(opened) << opened.error().what;
    return std::move(*opened);
  }
  JobTicket ticket() const { return {kSampleHeader, kPrintLayers, "sample", ""}; }

  // Sends what is left of the job; the last words if it does not get through.
  static Result<void> send_rest(Backend& sender, int first) {
    for (int layer = first; layer < kPrintLayers; ++layer) {
      if (auto sent = sender.send(layer, print_records(layer)); !sent) {
        return tl::unexpected(sent.error());
      }
    }
    return sender.end();
  }
  Result<void> print() {
    const auto sender = backend();
    const auto id = sender->start(ticket());
    if (!id) return tl::unexpected(id.error());
    id_ = *id;
    return send_rest(*sender, 0);
  }
  Result<void> resume() {
    const auto sender = backend();
    const auto first = sender->resume(id_, ticket());
    if (!first) return tl::unexpected(first.error());
    return send_rest(*sender, *first);
  }
  JobStatus job() {
    const auto jobs = *backend()->status();
    for (const JobStatus& one : jobs) {
      if (one.id == id_) return one;
    }
    ADD_FAILURE() << "no job " << id_;
    return {};
  }

  // The printer has the whole job, each layer once, and nothing came again.
  void expect_printed_once() {
    ASSERT_FALSE(printer_.jobs().empty());
    const EmulatedJob printed = printer_.jobs().back();
    EXPECT_TRUE(printed.done);
    EXPECT_EQ(printed.header, kSampleHeader);
    EXPECT_TRUE(printed.layers == whole_print()) << "the printed layers are not those of the job";
    EmulatedJob unfaulted = printed;
    unfaulted.layers = whole_print();
    EXPECT_TRUE(print_volume(printed) == print_volume(unfaulted)) << "another volume was printed";
    std::vector<int> once(kPrintLayers);
    std::iota(once.begin(), once.end(), 0);
    EXPECT_EQ(printer_.record(), once);
    EXPECT_EQ(printer_.sent_again(), 0);
    EXPECT_LE(printer_.max_waiting(), 4);
  }

  TempFolder folder_;
  PrinterEmulator printer_;
  std::string id_;
};

// On a USB bus.
class PrinterTest : public SenderTest {
 protected:
  std::string uri() const override { return "usb:?patience_s=1"; }
  std::string printer_uri() const override { return "usb://1209:0001/EMU0001"; }

  UmockdevBus bus_{printer_};
};

// At the socket of a folder.
class SocketPrinterTest : public SenderTest {
 protected:
  SocketPrinterTest()
      : socket_(*PrinterSocket::listen(folder_ / "printer")),
        server_([this] { serve_on_socket(printer_, socket_, [this] { return stop_.load(); }); }) {}
  ~SocketPrinterTest() override {
    stop_ = true;
    server_.join();
  }
  std::string uri() const override { return printer_uri() + "?patience_s=1"; }
  std::string printer_uri() const override { return "emulator:" + (folder_ / "printer"); }

 private:
  PrinterSocket socket_;
  std::atomic<bool> stop_{false};
  std::thread server_;
};

}  // namespace binderjet
