// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of binderjet-1 are those of PROTOCOL.md, and nothing a device claims is believed.
#include "transport/printer/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/transport/sample_job.h"
#include "transport/base/bytes.h"
#include "transport/printer/frame.h"

namespace binderjet {
namespace {

using namespace protocol;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::byte> sample_frame() { return encode_frame(Type::kCancel, 5, encode_key(9)); }

TEST(Frame, HasTheBytesItsDescriptionSays) {
  const auto frame = sample_frame();
  ASSERT_EQ(frame.size(), 40U);
  EXPECT_EQ(get_le<std::uint32_t>(frame, 0), 0x31554a42U) << "BJU1";
  EXPECT_EQ(get_le<std::uint32_t>(frame, 4), 0x09U);
  EXPECT_EQ(get_le<std::uint32_t>(frame, 8), 5U);
  EXPECT_EQ(get_le<std::uint32_t>(frame, 12), 8U);
  EXPECT_EQ(get_le<std::uint64_t>(frame, 16), checksum(std::span(frame).subspan(32)));
  EXPECT_EQ(get_le<std::uint64_t>(frame, 24), checksum(std::span(frame).first(24)));
  EXPECT_EQ(get_le<std::uint64_t>(frame, 32), 9U);
}

TEST(Frame, ComesOutOfAnyCutOfTheStream) {
  std::vector<std::byte> stream = sample_frame();
  const auto second = encode_frame(Type::kAskStatus, 6, {});
  stream.insert(stream.end(), second.begin(), second.end());
  for (std::size_t step = 1; step <= stream.size(); ++step) {
    FrameDecoder decoder(64);
    std::vector<Type> types;
    for (std::size_t at = 0; at < stream.size();) {
      at += decoder.feed(std::span(stream).subspan(at, std::min(step, stream.size() - at)));
      if (const auto frame = decoder.take_frame()) types.push_back(frame->type);
    }
    EXPECT_THAT(types, ElementsAre(Type::kCancel, Type::kAskStatus)) << "in steps of " << step;
    EXPECT_TRUE(decoder.idle());
  }
}

TEST(Frame, WithAFlippedBitIsNeverTaken) {
  const auto frame = sample_frame();
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    auto wrong = frame;
    wrong[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    FrameDecoder decoder(64);
    decoder.feed(wrong);
    EXPECT_FALSE(decoder.take_frame()) << "bit " << bit;
    EXPECT_NE(decoder.fault(), "") << "bit " << bit;
  }
}

TEST(Frame, LongerThanTheBoundIsRefusedBeforeItsPayloadIsKept) {
  const auto frame = encode_frame(Type::kLayer, 0, std::vector<std::byte>(65));
  FrameDecoder decoder(64);
  EXPECT_EQ(decoder.feed(frame), kFrameHeadBytes);
  EXPECT_THAT(decoder.fault(), HasSubstr("65 bytes where 64 are the most"));
  EXPECT_EQ(decoder.feed(frame), 0U) << "nothing more is taken";
}

TEST(Frame, AsLongAsTheBoundIsTaken) {
  FrameDecoder decoder(64);
  decoder.feed(encode_frame(Type::kLayer, 0, std::vector<std::byte>(64)));
  const auto frame = decoder.take_frame();
  ASSERT_TRUE(frame) << decoder.fault();
  EXPECT_EQ(frame->payload.size(), 64U);
}

TEST(Frame, IsFoundBehindWhateverAnEarlierSessionLeft) {
  Welcome welcome;
  welcome.session = 77;
  const auto right = encode_frame(Type::kWelcome, 0, encode(welcome));
  std::vector<std::byte> noise = sample_frame();
  noise.resize(37);  // half a frame: its length reaches into what follows
  noise.insert(noise.end(), right.begin(), right.end());
  const auto found = find_frame(noise, Type::kWelcome, 4096);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->end, noise.size());
  EXPECT_EQ(decode_welcome(found->frame.payload)->session, 77U);
  noise.pop_back();
  EXPECT_FALSE(find_frame(noise, Type::kWelcome, 4096)) << "not yet whole";
}

TEST(Frame, WithAWrongHeadIsNotFound) {
  Welcome welcome;
  welcome.session = 77;
  const auto right = encode_frame(Type::kWelcome, 0, encode(welcome));
  ASSERT_TRUE(find_frame(right, Type::kWelcome, 4096));
  for (std::size_t i = 0; i < right.size(); ++i) {
    auto wrong = right;
    wrong[i] ^= std::byte{4};
    EXPECT_FALSE(find_frame(wrong, Type::kWelcome, 4096)) << "byte " << i;
  }
}

TEST(Message, StatusSaysWhatItWasGiven) {
  Status status;
  status.state = State::kStopped;
  status.job = 3;
  status.acknowledged = 12;
  status.reasons = {"media-empty", "cover-open"};
  status.supplies = {{"powder", 0}, {"binder", -1}};
  const auto bytes = encode(status);
  const auto again = decode_status(bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->reasons, status.reasons);
  EXPECT_EQ(again->supplies[1].name, "binder");
  EXPECT_EQ(again->supplies[1].level_percent, -1);
  EXPECT_EQ(again->acknowledged, 12U);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A copy of the exact size, so that a sanitizer sees one byte too many.
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<long>(size));
    EXPECT_FALSE(decode_status(cut)) << size;
  }
}

TEST(Message, TextOfADeviceCannotReachTheTerminalAsControl) {
  Welcome welcome;
  welcome.name = "a\x1b[2Jb\nc\xff";
  EXPECT_EQ(decode_welcome(encode(welcome))->name, "a?[2Jb?c?");
}

TEST(Message, ThatPromisesMoreThanItHasIsRefused) {
  auto bytes = encode(Status{});
  bytes[1] = std::byte{200};  // supplies
  EXPECT_FALSE(decode_status(bytes));
  bytes = encode(Status{});
  bytes[2] = std::byte{0xff};  // reasons
  EXPECT_FALSE(decode_status(bytes));
  EXPECT_FALSE(decode_progress(encode(Progress{1, 5, 4, 0}))) << "a limit before what is there";
  EXPECT_FALSE(decode_resume(encode(Resume{1, 5, 6, 0})));
  EXPECT_FALSE(decode_welcome(encode(Welcome{.credits = 0, .name = ""})));
}

TEST(Digest, TellsLayersTheirOrderAndTheirJob) {
  const auto a = sample_records(0);
  const auto b = sample_records(1);
  const std::uint64_t empty = first_digest("{}", 2);
  EXPECT_NE(next_digest(next_digest(empty, a), b), next_digest(next_digest(empty, b), a));
  EXPECT_NE(first_digest("{}", 2), first_digest("{}", 3));
  EXPECT_NE(first_digest("{}", 2), first_digest("{ }", 2));
}

}  // namespace
}  // namespace binderjet
