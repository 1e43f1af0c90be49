// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that goes wrong at a printer ends in the whole job, or in one line and a resume that
// makes it whole.
#include "tests/printer/emulator/printer_fixture.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using F = PrinterFault;

struct Row {
  PlannedFault fault;
  const char* line;  // what the fault is called, or null where the job gets through by itself
};

void PrintTo(const Row& row, std::ostream* out) { *out << to_text(row.fault); }

// A fault that lasts (times -1, or 0 ms) is healed by a person before the resume.
const Row kTable[] = {
    {{F::kNak, 12, 1, 300}, nullptr},
    {{F::kNak, 12, 1, 0}, "takes no data"},
    {{F::kStall, 12}, nullptr},
    {{F::kStall, 0}, nullptr},
    {{F::kStall, 39, 2}, nullptr},
    {{F::kStall, 12, -1}, "stalled its data pipe"},
    {{F::kShortWrite, 12}, nullptr},
    {{F::kShortWrite, 12, 3}, nullptr},
    {{F::kSwallow, 12}, nullptr},
    {{F::kSwallow, 12, -1}, "printer"},
    {{F::kFlipBit, 12}, nullptr},
    {{F::kFlipBit, 12, -1}, "refuses what it was sent"},
    {{F::kReset, 12}, nullptr},
    {{F::kReset, 39, 3}, nullptr},
    {{F::kGone, 12}, "unplugged or switched off"},
    {{F::kGone, 0}, "unplugged or switched off"},
    {{F::kGone, 39}, "unplugged or switched off"},
    {{F::kPowerLoss, 12}, "unplugged or switched off"},
    {{F::kPowerLoss, 1}, "unplugged or switched off"},
    {{F::kStallIn, 12}, nullptr},
    {{F::kStallIn, 12, -1}, nullptr},
    {{F::kLoseAck, 12}, nullptr},
    {{F::kLoseAck, 39}, nullptr},
    {{F::kRepeatAck, 12}, nullptr},
    {{F::kLateAck, 12, 1, 200}, nullptr},
    {{F::kGoneBeforeAck, 12}, "unplugged or switched off"},
    {{F::kGoneBeforeAck, 39}, "unplugged or switched off"},
    {{F::kAckTooFar, 12}, nullptr},
    {{F::kAckOtherJob, 12}, nullptr},
    {{F::kAckWrongDigest, 12}, nullptr},
    {{F::kNoise, 12}, nullptr},
    {{F::kLyingLength, 12}, nullptr},
    {{F::kShortLength, 12}, nullptr},
    {{F::kUnknownType, 12}, nullptr},
    {{F::kSkipSequence, 12}, nullptr},
    {{F::kByteByByte, 12}, nullptr},
    {{F::kEmptyAnswers, 12}, nullptr},
    {{F::kSilent, 12, 1, 300}, nullptr},
    {{F::kSilent, 12, 1, 0}, "says nothing"},
    {{F::kWrongStatus, 12}, nullptr},
    {{F::kStrangeStatus, 12}, nullptr},
    {{F::kOutOfPowder, 12}, "media-empty"},
    {{F::kOutOfBinder, 30}, "marker-supply-empty"},
    {{F::kCoverOpen, 12}, "cover-open"},
    {{F::kPaused, 12, 1, 300}, nullptr},
    {{F::kSlow, 38, 1, 100}, nullptr},
    {{F::kNoCredit, 12, 1, 300}, nullptr},
    {{F::kNoHello, 0, 2}, nullptr},
    {{F::kWrongDone}, "printed something else"},
    {{F::kLoseDone}, nullptr},
    {{F::kGoneBeforeDone}, "unplugged or switched off"},
    {{F::kStallDeviceId}, nullptr},
    {{F::kSwappedDeviceId}, nullptr},
    {{F::kResetClass10, 0, -1}, nullptr},
    {{F::kPortStatus}, nullptr},
};

// A row of the table, at any printer.
template <class Printer>
class FaultRow : public Printer, public testing::WithParamInterface<Row> {
 protected:
  void run(const Row& row) {
    this->printer_.set_plan({row.fault});
    const auto printed = this->print();
    if (row.line == nullptr) {
      ASSERT_TRUE(printed) << printed.error().where << ": " << printed.error().what;
    } else {
      ASSERT_FALSE(printed) << "reported done";
      EXPECT_EQ(printed.error().kind, FailureKind::kDevice);
      EXPECT_THAT(printed.error().what, HasSubstr(row.line));
      EXPECT_THAT(printed.error().where, HasSubstr(this->printer_uri() + ": layer "));
      EXPECT_THAT(printed.error().where, HasSubstr(" of 40"));
      EXPECT_THAT(printed.error().what, testing::Not(HasSubstr("\n")));
      EXPECT_EQ(this->job().state, JobState::kHeld);
      EXPECT_LE(this->job().acknowledged, this->printer_.acknowledged());
      this->printer_.heal();
      const auto resumed = this->resume();
      ASSERT_TRUE(resumed) << resumed.error().where << ": " << resumed.error().what;
    }
    this->expect_printed_once();
    EXPECT_EQ(this->job().state, JobState::kDone);
  }
};

using FaultTable = FaultRow<PrinterTest>;
using SocketFaultTable = FaultRow<SocketPrinterTest>;

TEST_P(FaultTable, EndsInTheWholeJobOrInOneLineAndAResume) { run(GetParam()); }
TEST_P(SocketFaultTable, EndsInTheWholeJobOrInOneLineAndAResume) { run(GetParam()); }

std::string row_name(const testing::TestParamInfo<Row>& row) {
  std::string name = std::to_string(row.index) + "_" + to_text(row.param.fault);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Printer, FaultTable, testing::ValuesIn(kTable), row_name);
INSTANTIATE_TEST_SUITE_P(Printer, SocketFaultTable, testing::ValuesIn(kTable), row_name);

// No printer that keeps PROTOCOL.md does this; it must at least not pass for a printed job.
TEST_F(PrinterTest, NeverReportsDoneWhatAPrinterForgot) {
  printer_.set_plan({{F::kForgetsJob, 12}});
  const auto printed = print();
  ASSERT_FALSE(printed);
  EXPECT_THAT(printed.error().what, HasSubstr("lost layers that it had acknowledged"));
  printer_.heal();
  EXPECT_THAT(resume().error().what, HasSubstr("cancel the job and print it again"));
  EXPECT_EQ(job().state, JobState::kHeld);
}

TEST_F(PrinterTest, RefusesAPrinterOfAnotherVersion) {
  printer_.set_plan({{F::kOldVersion, 0, -1}});
  EXPECT_THAT(print().error().what, HasSubstr("version 0 of binderjet-1"));
  EXPECT_EQ(backend()->status()->size(), 0U) << "nothing is left of a job that never began";
}

// Faults that a sender may meet in any number and order. Those that never end are left out: who
// would heal them?
TEST_F(PrinterTest, PrintsOnceUnderFiftyRandomPlans) {
  auto random = seeded_random();
  std::vector<PrinterFault> choice;
  for (const PrinterFault fault : all_printer_faults()) {
    if (fault != F::kForgetsJob && fault != F::kOldVersion && fault != F::kHangControl) {
      choice.push_back(fault);
    }
  }
  int at_once = 0;
  int resumes = 0;
  for (int round = 0; round < 50; ++round) {
    FaultPlan plan;
    std::string text = "plan";
    for (std::size_t i = 0, n = 1 + random_below(random, 5); i < n; ++i) {
      plan.push_back({choice[random_below(random, choice.size())],
                      static_cast<int>(random_below(random, kPrintLayers)),
                      static_cast<int>(1 + random_below(random, 4)),
                      static_cast<int>(1 + random_below(random, 40))});
      if (plan.back().what == F::kSlow) plan.back().ms = 2;
      text.append(1, ' ').append(to_text(plan.back()));
    }
    SCOPED_TRACE(text);
    printer_.set_plan(plan);
    auto printed = print();
    at_once += printed ? 1 : 0;
    int tries = 0;
    while (!printed && tries < 30) {
      ASSERT_EQ(printed.error().kind, FailureKind::kDevice) << printed.error().what;
      // A person plugs it in and fills it up; the plan goes on.
      printer_.refill();
      if (printer_.gone()) printer_.plug();
      const bool begun = !id_.empty() && job().state == JobState::kHeld;
      printed = begun ? resume() : print();
      ++tries;
    }
    resumes += tries;
    ASSERT_TRUE(printed) << printed.error().what;
    expect_printed_once();
    if (HasFailure()) break;
    printer_.heal();
    id_.clear();
  }
  std::printf("50 plans: %d jobs in one go, %d resumes\n", at_once, resumes);
}

}  // namespace
}  // namespace binderjet
