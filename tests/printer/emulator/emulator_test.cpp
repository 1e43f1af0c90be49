// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated printer prints what it should, and a host on the other side of a socket can use it.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "driver/emulator/printed_volume.h"
#include "slicer/stack/slice_stack.h"
#include "tests/printer/emulator/printer_fixture.h"
#include "tests/printer/emulator/usbip_server.h"
#include "transport/base/bytes.h"

namespace binderjet {
namespace {

using testing::ElementsAre;

EmulatedJob job_of(std::vector<std::vector<unsigned char>> masks) {
  EmulatedJob job;
  job.header = R"({"size_px": [8, 3, 2], "pitch_mm": [0.1, 0.05, 0.2], "origin_mm": [1, 2, 3]})";
  for (std::size_t i = 0; i < masks.size(); ++i) {
    job.layers.push_back(
        encode_record(RecordKind::kMask, static_cast<int>(i), std::as_bytes(std::span(masks[i]))));
  }
  return job;
}

std::vector<int> rows(const std::vector<std::byte>& layer) {
  std::vector<int> out;
  for (const std::byte row : layer) out.push_back(static_cast<int>(row));
  return out;
}

// By hand, from the window of 5 x 3 drops, 7 of which bind, and the 2 that sink: three full rows
// of columns 3 and 4 are 6 drops for columns 2 to 5, and bind only where drops fell above.
TEST(PrintedVolume, GrowsAlongXUnderALayerAndNotAtTheTop) {
  const std::vector<unsigned char> wall = {0x18, 0x18, 0x18};
  const PrintedVolume volume = print_volume(job_of({wall, wall}));
  EXPECT_THAT(rows(volume.layers[0]), ElementsAre(0x00, 0x3c, 0x00));
  EXPECT_THAT(rows(volume.layers[1]), ElementsAre(0x00, 0x00, 0x00));
  const std::vector<unsigned char> block = {0xff, 0xff, 0xff};
  EXPECT_THAT(rows(print_volume(job_of({block})).layers[0]), ElementsAre(0x7e, 0xff, 0x7e));
}

TEST(PrintedVolume, IsWrittenAsAMeasuredStack) {
  const TempFolder folder;
  PrintedVolume volume = print_volume(job_of({{0, 0, 0}, {0, 0, 0}}));
  volume.layers[0][0] = std::byte{0x80};
  volume.layers[1][1] = std::byte{0x01};
  write_measured(volume, folder / "out");
  const StackReader stack(folder / "out");
  EXPECT_EQ(stack.info().kind, StackKind::kMeasured);
  EXPECT_THAT(stack.info().size, ElementsAre(8, 3, 2));
  EXPECT_THAT(stack.info().origin_mm, ElementsAre(1, 2, 3));
  EXPECT_TRUE(stack.read(0).at(0, 0));
  EXPECT_TRUE(stack.read(1).at(7, 1));
  EXPECT_EQ(stack.read(1).count(), 1);
}

TEST(PrintedVolume, RefusesALayerOfAnotherSize) {
  EXPECT_THROW(print_volume(job_of({{0x80}})), std::runtime_error);
}

// One request and its answer over USB/IP, as the kernel's vhci_hcd sends them.
class UsbIp : public testing::Test {
 protected:
  UsbIp() {
    server_ = std::thread([this] { serve_usbip(printer_, kPort, stop_); });
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(kPort);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    do {
      if (fd_ >= 0) close(fd_);
      fd_ = socket(AF_INET, SOCK_STREAM, 0);
    } while (connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0);
  }
  ~UsbIp() override {
    close(fd_);
    stop_ = true;
    server_.join();
  }
  void say(const std::vector<std::byte>& bytes) {
    ASSERT_EQ(send(fd_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  std::vector<std::byte> hear(std::size_t size) {
    std::vector<std::byte> bytes(size);
    EXPECT_EQ(recv(fd_, bytes.data(), size, MSG_WAITALL), static_cast<ssize_t>(size));
    return bytes;
  }
  static std::vector<std::byte> words(std::initializer_list<std::uint32_t> values) {
    std::vector<std::byte> out;
    for (const std::uint32_t value : values) {
      for (int shift = 24; shift >= 0; shift -= 8) {
        out.push_back(static_cast<std::byte>(value >> shift));
      }
    }
    return out;
  }

  static constexpr int kPort = 32407;
  PrinterEmulator printer_;
  std::atomic<bool> stop_{false};
  std::thread server_;
  int fd_ = -1;
};

TEST_F(UsbIp, ImportsThePrinterAndCarriesItsTransfers) {
  auto ask = words({0x01118003, 0});
  ask.resize(8 + 32);
  say(ask);
  const auto answer = hear(8 + 312);
  EXPECT_EQ(answer[3], std::byte{3});
  EXPECT_EQ(answer[7], std::byte{0});
  // GET_DEVICE_ID on the control pipe.
  say(words({1, 1, 0x00010002, 1, 0, 0, 1024, 0, 0, 0, 0xa1000000, 0x00000004}));
  const auto head = hear(48);
  EXPECT_EQ(head[3], std::byte{3});
  EXPECT_EQ(head[23], std::byte{0}) << "status";
  const auto length = static_cast<std::size_t>(head[27]);
  const auto id = hear(length);
  EXPECT_THAT(std::string(reinterpret_cast<const char*>(id.data()), id.size()),
              testing::HasSubstr("CMD:BINDERJET-1"));
  // A read of the IN pipe waits; HELLO down the OUT pipe makes it answer.
  say(words({1, 2, 0x00010002, 1, 2, 0, 512, 0, 0, 0, 0, 0}));
  const auto hello = protocol::encode_frame(protocol::Type::kHello, 0,
                                            protocol::encode(protocol::Hello{1, 1, 42}));
  auto out =
      words({1, 3, 0x00010002, 0, 1, 0, static_cast<std::uint32_t>(hello.size()), 0, 0, 0, 0, 0});
  out.insert(out.end(), hello.begin(), hello.end());
  say(out);
  bool welcomed = false;
  for (int i = 0; i < 2; ++i) {
    const auto done = hear(48);
    if (done[7] != std::byte{2}) continue;
    const auto heard = hear(static_cast<std::size_t>(done[27]));
    const auto found = protocol::find_frame(heard, protocol::Type::kWelcome, 4096);
    welcomed = found && protocol::decode_welcome(found->frame.payload)->session == 42;
  }
  EXPECT_TRUE(welcomed);
}

}  // namespace
}  // namespace binderjet
