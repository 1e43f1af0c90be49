// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of the USB path share: an emulated printer on its bus, and senders of a small job.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "driver/emulator/printed_volume.h"
#include "tests/printer/emulator/umockdev_bus.h"
#include "tests/transport/sample_job.h"
#include "transport/emulator/printer_emulator.h"
#include "transport/open/open_backend.h"

namespace binderjet {

inline constexpr int kPrintLayers = 40;

// The sample job's records with masks of their header's size, 64 x 64 pixels.
inline std::vector<std::byte> print_records(int layer) {
  std::vector<std::byte> mask(8 * 64);
  std::minstd_rand random(static_cast<unsigned>(layer) + 1);
  for (std::byte& byte : mask) byte = static_cast<std::byte>(random() >> 8);
  return encode_record(RecordKind::kMask, layer, mask);
}

inline std::vector<std::vector<std::byte>> whole_print() {
  std::vector<std::vector<std::byte>> layers;
  for (int layer = 0; layer < kPrintLayers; ++layer) layers.push_back(print_records(layer));
  return layers;
}

class PrinterTest : public testing::Test {
 protected:
  std::unique_ptr<Backend> backend(const std::string& uri = "usb:?patience_s=1") {
    BackendOptions options;
    options.state_folder = folder_ / "state";
    auto opened = open_backend(uri, options);
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
  UmockdevBus bus_{printer_};
  std::string id_;
};

}  // namespace binderjet
