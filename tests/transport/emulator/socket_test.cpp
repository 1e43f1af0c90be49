// SPDX-License-Identifier: GPL-3.0-or-later
// The socket of an emulated printer: one printer a folder, wherever the folder is, and nothing that
// a stranger says on either side is believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <functional>
#include <thread>

#include "tests/transport/sample_job.h"
#include "transport/base/bytes.h"
#include "transport/emulator/emulator_backend.h"
#include "transport/emulator/fault_plan.h"
#include "transport/emulator/socket_frame.h"
#include "transport/emulator/socket_link.h"
#include "transport/emulator/socket_server.h"
#include "transport/printer/frame.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using Clock = PrinterLink::Clock;

constexpr auto kLong = std::chrono::seconds(20);

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = as_bytes(text);
  return {bytes.begin(), bytes.end()};
}

TEST(SocketFrame, ComesOutOfAnyCutOfTheStream) {
  std::vector<std::byte> stream;
  put_socket_frame(stream, SocketWord::kReady);
  put_socket_frame(stream, SocketWord::kAnswer, 0, bytes_of("hello"));
  put_socket_frame(stream, SocketWord::kTaken, 70000);
  for (std::size_t cut = 1; cut <= stream.size(); ++cut) {
    SocketFrames frames;
    std::vector<SocketFrame> found;
    for (std::size_t at = 0; at < stream.size(); at += cut) {
      frames.feed(std::span(stream).subspan(at, std::min(cut, stream.size() - at)));
      while (auto frame = frames.next()) found.push_back(*frame);
    }
    ASSERT_EQ(found.size(), 3U) << cut;
    EXPECT_EQ(found[0].word, SocketWord::kReady);
    EXPECT_EQ(found[1].data, bytes_of("hello"));
    EXPECT_EQ(found[2].number, 70000U);
    EXPECT_FALSE(frames.wrong());
  }
}

TEST(SocketFrame, ThatIsNoneOrClaimsTooMuchEndsIt) {
  std::vector<std::byte> longest;
  put_socket_frame(longest, SocketWord::kAnswer, 0, std::vector<std::byte>(kSocketPiece));
  std::vector<std::byte> too_long;
  put_socket_frame(too_long, SocketWord::kAnswer, 0, std::vector<std::byte>(kSocketPiece + 1));
  SocketFrames frames;
  frames.feed(longest);
  EXPECT_TRUE(frames.next());
  frames.feed(too_long);
  EXPECT_FALSE(frames.next());
  EXPECT_TRUE(frames.wrong());
  for (const std::string head : {"BJX"
                                 "R\0\0\0\0",
                                 "BJE"
                                 "?\0\0\0\0"}) {
    frames.reset();
    frames.feed(bytes_of(std::string(head.c_str(), 4) + std::string(4, '\0')));
    EXPECT_FALSE(frames.next());
    EXPECT_TRUE(frames.wrong()) << head;
  }
}

TEST(FaultPlan, TakesNoLayerBelowTheFirst) {
  EXPECT_TRUE(parse_fault("forgets-job@0"));
  EXPECT_FALSE(parse_fault("forgets-job@-1"));
  EXPECT_TRUE(parse_fault("stall@12x-1"));
  EXPECT_FALSE(parse_fault("stall@12x-2"));
  EXPECT_FALSE(parse_fault("nak@12x1:-5"));
}

TEST(PrinterSocket, IsForItsUserAloneAndGoesWithThePrinter) {
  const TempFolder folder;
  const std::string path = folder / "printer.socket";
  {
    const auto socket = PrinterSocket::listen(folder.path());
    ASSERT_TRUE(socket) << socket.error().what;
    struct stat info {};
    ASSERT_EQ(stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0600U);
    EXPECT_TRUE(connect_to_printer(folder.path()));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THAT(connect_to_printer(folder.path()).error().what,
              HasSubstr("binderjet emulator -o " + folder.path()));
  EXPECT_FALSE(connect_to_printer(folder / "nowhere"));
}

TEST(PrinterSocket, IsRefusedWhereAnotherPrinterListens) {
  const TempFolder folder;
  const auto first = PrinterSocket::listen(folder.path());
  ASSERT_TRUE(first);
  const auto second = PrinterSocket::listen(folder.path());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().where, folder.path());
  EXPECT_THAT(second.error().what, HasSubstr("another emulated printer has this folder"));
  EXPECT_TRUE(connect_to_printer(folder.path())) << "the first goes on";
}

TEST(PrinterSocket, IsReachedHoweverLongThePathIs) {
  const TempFolder folder;
  std::string deep = folder.path();
  for (int i = 0; i < 20; ++i) {
    deep += "/a-folder-with-a-long-name-for-a-printer";
    std::filesystem::create_directory(deep);
  }
  ASSERT_GT(deep.size(), 800U);
  const auto socket = PrinterSocket::listen(deep);
  ASSERT_TRUE(socket) << socket.error().what;
  EXPECT_TRUE(connect_to_printer(deep));
}

// Reads until the other side closes, `most` bytes or the time is over; what came.
std::string heard(const File& connection, std::size_t most) {
  std::string text;
  const auto until = Clock::now() + kLong;
  while (text.size() < most && Clock::now() < until) {
    pollfd ready{connection.fd(), POLLIN, 0};
    poll(&ready, 1, 1000);
    char piece[4096];
    const ssize_t got = recv(connection.fd(), piece, sizeof piece, MSG_DONTWAIT);
    if (got == 0) return text + "|closed";
    if (got > 0) text.append(piece, static_cast<std::size_t>(got));
  }
  return text;
}

class ServedPrinter : public testing::Test {
 protected:
  ServedPrinter()
      : socket_(*PrinterSocket::listen(folder_.path())),
        server_([this] { serve_on_socket(printer_, socket_, [this] { return stop_.load(); }); }) {}
  ~ServedPrinter() override {
    stop_ = true;
    server_.join();
  }
  File connect() const { return *connect_to_printer(folder_.path()); }
  static void say(const File& connection, const std::string& text) {
    ASSERT_EQ(send(connection.fd(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  void expect_prints() {
    const auto backend = make_emulator_backend("emulator:" + folder_.path(), {});
    const auto id = (*backend)->start({kSampleHeader, kPrintLayers, "sample", ""});
    ASSERT_TRUE(id) << id.error().what;
    for (int layer = 0; layer < kPrintLayers; ++layer) {
      ASSERT_TRUE((*backend)->send(layer, print_records(layer)));
    }
    ASSERT_TRUE((*backend)->end());
    EXPECT_TRUE(printer_.jobs().back().layers == whole_print());
  }

  TempFolder folder_;
  PrinterEmulator printer_;
  PrinterSocket socket_;
  std::atomic<bool> stop_{false};
  std::thread server_;
};

TEST_F(ServedPrinter, TakesAJob) { expect_prints(); }

TEST_F(ServedPrinter, HearsNobodyWhoDoesNotGreet) {
  const File stranger = connect();
  say(stranger, "GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(heard(stranger, 100), "|closed");
  const File silent = connect();  // has no claim to it
  expect_prints();
}

TEST_F(ServedPrinter, OutlivesAnyBytesBehindTheGreeting) {
  auto random = seeded_random();
  for (int round = 0; round < 20; ++round) {
    const File stranger = connect();
    say(stranger, "BJE1");
    ASSERT_THAT(heard(stranger, 8), testing::StartsWith("BJER"));
    std::string noise(1 + random_below(random, 5000), '\0');
    for (char& c : noise) c = static_cast<char>(random());
    if (round % 2 == 0) noise.replace(0, std::min<std::size_t>(4, noise.size()), "BJU1");
    say(stranger, noise);
  }
  expect_prints();
}

// One that never reads must not cost memory or time without end.
TEST_F(ServedPrinter, OutlivesAHostThatNeverReads) {
  {
    const File stranger = connect();
    say(stranger, "BJE1");
    ASSERT_THAT(heard(stranger, 8), testing::StartsWith("BJER"));
    // Questions, each with an answer, until neither side takes any more.
    std::string ask;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const auto frame = protocol::encode_frame(protocol::Type::kAskStatus, i, {});
      ask.append(reinterpret_cast<const char*>(frame.data()), frame.size());
    }
    int refused = 0;
    while (refused < 20) {
      pollfd ready{stranger.fd(), POLLOUT, 0};
      poll(&ready, 1, 10);
      refused +=
          send(stranger.fd(), ask.data(), ask.size(), MSG_NOSIGNAL | MSG_DONTWAIT) > 0 ? 0 : 1;
      if (printer_.bytes_taken() > (64U << 20)) break;  // it drops what is deaf: just as well
    }
  }
  expect_prints();
}

TEST_F(ServedPrinter, HasOneHostAtATime) {
  const File host = connect();
  say(host, "BJE1");
  ASSERT_THAT(heard(host, 8), testing::StartsWith("BJER"));
  const auto backend = make_emulator_backend("emulator:" + folder_.path(), {});
  const auto refused = (*backend)->start({kSampleHeader, kPrintLayers, "sample", ""});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("another program uses it"));
}

// What a link makes of a printer that answers its greeting with these bytes.
LinkState state_after(const std::string& answer, std::string* trouble = nullptr) {
  const TempFolder folder;
  const auto socket = PrinterSocket::listen(folder.path());
  auto link = SocketLink::open(folder.path(), "emulator:" + folder.path());
  const File host(accept(socket->fd(), nullptr, nullptr));
  EXPECT_EQ(send(host.fd(), answer.data(), answer.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(answer.size()));
  static_cast<void>((*link)->restart());
  const auto until = Clock::now() + kLong;
  while ((*link)->state() == LinkState::kFine && (*link)->take_input().empty() &&
         Clock::now() < until) {
    (*link)->wait(until);
  }
  if (trouble != nullptr) *trouble = (*link)->trouble();
  return (*link)->state();
}

std::string frame(SocketWord word, std::uint32_t number = 0) {
  std::vector<std::byte> out;
  put_socket_frame(out, word, number);
  return {reinterpret_cast<const char*>(out.data()), out.size()};
}

TEST(SocketLink, BelievesNoStranger) {
  std::string trouble;
  EXPECT_EQ(state_after("HTTP/1.1 400 Bad Request\r\n", &trouble), LinkState::kGone);
  EXPECT_THAT(trouble, HasSubstr("no emulated printer"));
  const std::string ready = frame(SocketWord::kReady);
  const std::string lying = std::string("BJEA") + "\xff\xff\xff\x7f";
  EXPECT_EQ(state_after(ready + lying, &trouble), LinkState::kGone);
  EXPECT_EQ(state_after(ready + frame(SocketWord::kTaken, 5), &trouble), LinkState::kBroken);
  EXPECT_THAT(trouble, HasSubstr("more than it was sent"));
  EXPECT_EQ(state_after(ready + frame(SocketWord::kStall, 1), &trouble), LinkState::kBroken);
  EXPECT_EQ(state_after(frame(SocketWord::kGone), &trouble), LinkState::kGone);
  EXPECT_EQ(trouble, "the printer was unplugged or switched off");
}

TEST(EmulatorUri, NamesAFolder) {
  EXPECT_EQ(emulator_folder("emulator:a/b/"), "a/b");
  EXPECT_EQ(emulator_folder("emulator:///tmp/a"), "/tmp/a");
  EXPECT_EQ(emulator_folder("emulator:what?"), "what?");
  EXPECT_EQ(emulator_folder("emulator:a?patience_s=2"), "a");
  EXPECT_EQ(emulator_folder("emulator:"), std::nullopt);
  EXPECT_EQ(emulator_folder("spool:a"), std::nullopt);
  EXPECT_EQ(make_emulator_backend("emulator:", {}).error().kind, FailureKind::kBadInput);
  EXPECT_EQ(make_emulator_backend("emulator:a?patience_s=0", {}).error().kind,
            FailureKind::kBadInput);
}

}  // namespace
}  // namespace binderjet
