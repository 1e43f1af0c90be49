// SPDX-License-Identifier: GPL-3.0-or-later
// A printer that says what cannot be is not believed, and what an earlier session left is no
// answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "tests/transport/sample_job.h"
#include "transport/printer/frame.h"
#include "transport/printer/printer_backend.h"
#include "transport/printer/printer_job.h"

namespace binderjet {
namespace {

using namespace protocol;
using testing::HasSubstr;

constexpr std::uint64_t kJob = 7;
constexpr auto kPatience = std::chrono::milliseconds(1000);

// Answers each frame as a function says, with what stands in the pipe before.
class ScriptedLink : public PrinterLink {
 public:
  using Answer = std::function<std::vector<std::byte>(const Frame& frame)>;

  explicit ScriptedLink(Answer answer) : answer_(std::move(answer)) {}

  const std::string& uri() const override { return uri_; }
  void post(std::vector<std::byte> bytes) override {
    FrameDecoder decoder(1 << 20);
    decoder.feed(bytes);
    const std::vector<std::byte> said = answer_(*decoder.take_frame());
    input_.insert(input_.end(), said.begin(), said.end());
  }
  std::size_t unsent() const override { return 0; }
  std::uint64_t sent() const override { return 0; }
  std::vector<std::byte> take_input() override { return std::exchange(input_, {}); }
  LinkState state() const override { return LinkState::kFine; }
  std::string trouble() const override { return ""; }
  void wait(Clock::time_point) override {}
  bool restart() override {
    input_.clear();
    return true;
  }

 private:
  std::string uri_ = "printer";
  Answer answer_;
  std::vector<std::byte> input_;
};

std::vector<std::byte> welcome(const Frame& hello) {
  Welcome said;
  said.session = decode_hello(hello.payload)->session;
  said.max_layer_bytes = said.max_header_bytes = 1 << 20;
  return encode_frame(Type::kWelcome, 0, encode(said));
}

std::vector<std::byte> refused_version() {
  return encode_frame(Type::kRefused, 0, encode(Refused{0, Refusal::kNoVersion, 0, ""}));
}

PrinterJob at(ScriptedLink::Answer answer, std::vector<int>* kept = nullptr) {
  auto session = std::make_unique<PrinterSession>(std::make_unique<ScriptedLink>(std::move(answer)),
                                                  kPatience, [] { return Result<void>(); });
  return {std::move(session), kPatience, [kept](int layers, std::uint64_t) {
            if (kept != nullptr) kept->push_back(layers);
            return Result<void>();
          }};
}

// One that has so many layers of each job that it is asked for.
ScriptedLink::Answer has(std::uint32_t layers) {
  return [layers](const Frame& frame) {
    return frame.type == Type::kHello
               ? welcome(frame)
               : encode_frame(Type::kReady, 1, encode(Progress{kJob, layers, layers + 4, 99}));
  };
}

TEST(LyingPrinter, HasNoLayersOfAJobThatBegins) {
  std::vector<int> kept;
  PrinterJob job = at(has(1), &kept);
  ASSERT_TRUE(job.greet());
  EXPECT_THAT(job.start(kJob, 40, "header").error().what, HasSubstr("layer it was not sent"));
  EXPECT_TRUE(kept.empty());
}

TEST(LyingPrinter, HasNoMoreLayersThanWereUnderWayWhenAnEarlierSenderEnded) {
  for (const std::uint32_t there : {10U, 14U, 15U, 40U}) {
    SCOPED_TRACE(there);
    std::vector<int> kept;
    PrinterJob job = at(has(there), &kept);
    ASSERT_TRUE(job.greet());
    const auto first = job.resume(kJob, 40, "header", 10, 99);
    if (there <= 10 + kMaxCredits) {
      ASSERT_TRUE(first) << first.error().what;
      EXPECT_EQ(*first, static_cast<int>(there));
    } else {
      EXPECT_THAT(first.error().what, HasSubstr("layers it was not sent"));
      EXPECT_TRUE(kept.empty());
    }
  }
}

// Nobody was told the number of a job whose start fails, so nobody could resume it.
TEST(AStartThatFails, LeavesNoJob) {
  struct Case {
    Type answer;  // to JOB; HELLO is no answer
    bool stop;    // as soon as JOB was sent
    const char* said;
  };
  for (const Case& one : {Case{Type::kRefused, false, "refuses the job: full"},
                          {Type::kHello, false, "says nothing"},
                          {Type::kHello, true, "interrupted"}}) {
    SCOPED_TRACE(one.said);
    const TempFolder folder;
    bool asked_for_job = false;
    std::vector<Type> heard;
    PrinterAccess access;
    access.uri = "printer";
    access.patience = std::chrono::milliseconds(50);
    access.journals = folder / "jobs";
    access.stop_asked = [&] { return one.stop && asked_for_job; };
    access.open = [&](const std::string&) -> Result<std::unique_ptr<PrinterLink>> {
      return std::make_unique<ScriptedLink>([&](const Frame& frame) -> std::vector<std::byte> {
        heard.push_back(frame.type);
        asked_for_job = asked_for_job || frame.type == Type::kJob;
        if (frame.type == Type::kHello) return welcome(frame);
        if (frame.type == Type::kCancel) return encode_frame(Type::kCancelled, 1, frame.payload);
        if (one.answer != Type::kRefused) return {};
        return encode_frame(Type::kRefused, 1,
                            encode(Refused{frame.sequence, Refusal::kOtherJob, 0, "full"}));
      });
    };
    const auto backend = make_printer_backend(std::move(access));
    const auto id = backend->start({"header", 40, "a", ""});
    ASSERT_FALSE(id);
    EXPECT_THAT(id.error().what, HasSubstr(one.said));
    EXPECT_TRUE(backend->status()->empty());
    EXPECT_TRUE(asked_for_job);
    if (!one.stop) {
      EXPECT_EQ(heard.back(), Type::kCancel) << "the printer is told, too";
    }
  }
}

TEST(Greeting, IsNotEndedByARefusalThatAnEarlierSessionLeft) {
  const auto said_before = [](const Frame& frame) {
    std::vector<std::byte> said = refused_version();
    const std::vector<std::byte> more = welcome(frame);
    said.insert(said.end(), more.begin(), more.end());
    return said;
  };
  EXPECT_TRUE(at(said_before).greet());
  const auto refuses = [](const Frame&) { return refused_version(); };
  EXPECT_THAT(at(refuses).greet().error().what, HasSubstr("no version of binderjet-1"));
}

}  // namespace
}  // namespace binderjet
