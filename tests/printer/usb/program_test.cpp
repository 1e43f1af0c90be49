// SPDX-License-Identifier: GPL-3.0-or-later
// The program itself, as a process of its own, prints to the emulated printer: unplugged, killed,
// cancelled, streaming.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <nlohmann/json.hpp>

#include "tests/printer/emulator/printer_fixture.h"
#include "tests/support/models.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using F = PrinterFault;
using Clock = std::chrono::steady_clock;

struct Ended {
  int status = -1;  // exit status, or 128 + signal
  std::string out;
  std::string err;
  double cpu_s = 0;
};

class UsbProgram : public PrinterTest {
 protected:
  UsbProgram() {
    setenv("BINDERJET_STATE", (folder_ / "state").c_str(), 1);
    // The program is not linked with umockdev; a sanitizer's runtime need not come first here.
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
    setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0777));
  }
  ~UsbProgram() override { unsetenv("LD_PRELOAD"); }

  pid_t spawn(std::vector<std::string> words, uid_t user = 0) {
    words.insert(words.begin(), BINDERJET_PROGRAM);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ++spawned_;
    const std::string out = output(".out", spawned_);
    const std::string err = output(".err", spawned_);
    const pid_t child = fork();
    if (child != 0) {
      numbers_[child] = spawned_;
      return child;
    }
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0666), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0666), STDERR_FILENO);
    // Opened before: the other user need not come into the folder that this was built in.
    const int program = open(BINDERJET_PROGRAM, O_RDONLY | O_CLOEXEC);
    if (user != 0 && setuid(user) != 0) _exit(127);
    fexecve(program, argv.data(), environ);
    _exit(127);
  }
  Ended wait(pid_t child) {
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            file_text(output(".out", numbers_[child])), file_text(output(".err", numbers_[child])),
            seconds(usage.ru_utime) + seconds(usage.ru_stime)};
  }
  Ended run(std::vector<std::string> words) { return wait(spawn(std::move(words))); }
  // Of a process that was not waited for yet.
  static double cpu_s(pid_t child) {
    clockid_t clock = 0;
    timespec time{};
    EXPECT_EQ(clock_getcpuclockid(child, &clock), 0);
    EXPECT_EQ(clock_gettime(clock, &time), 0);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
  }
  // How long a cancel took, by its own watch: a busy machine starts programs slowly.
  double cancel(const std::string& id) {
    const Ended ended = run({"cancel", id, "--to", "usb:", "--json"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    return ended.status == 0 ? nlohmann::json::parse(ended.out)["seconds"].get<double>() : 0;
  }

  std::string write_job() {
    const std::string path = folder_ / "a.bjob";
    auto writer = JobWriter::create(path, kSampleHeader);
    for (int layer = 0; layer < kPrintLayers; ++layer) {
      EXPECT_TRUE(writer->append(print_records(layer)));
    }
    EXPECT_TRUE(writer->finish());
    return path;
  }
  std::string write_part(double height_mm) {
    const std::string path = folder_ / "part.obj";
    models::write_obj(models::box({0, 0, 0}, {6, 5, height_mm}), path);
    return path;
  }
  // The printed layers are exactly the records of this job file.
  void expect_printed(const std::string& job_path) {
    const auto job = JobReader::open(job_path);
    ASSERT_TRUE(job);
    const EmulatedJob printed = printer_.jobs().back();
    EXPECT_TRUE(printed.done);
    EXPECT_EQ(printed.header, job->header());
    ASSERT_EQ(printed.layers.size(), job->entries().size());
    for (std::size_t layer = 0; layer < printed.layers.size(); ++layer) {
      EXPECT_TRUE(printed.layers[layer] ==
                  *job->read_record(RecordKind::kMask, static_cast<int>(layer)));
    }
    EXPECT_EQ(printer_.record().size(), printed.layers.size()) << "each layer once";
    EXPECT_EQ(printer_.sent_again(), 0);
  }

 private:
  std::string output(const char* kind, int number) const {
    return folder_ / (std::to_string(number) + kind);
  }
  int spawned_ = 0;
  std::map<pid_t, int> numbers_;
};

TEST_F(UsbProgram, EndsInStatus4AndSaysTheFaultTheLayerAndHowToGoOn) {
  const std::string job = write_job();
  printer_.set_plan({{F::kGone, 12}});
  const Ended printed = run({"print", job, "--to", "usb:"});
  EXPECT_EQ(printed.status, 4);
  EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
  EXPECT_THAT(printed.err, HasSubstr("unplugged or switched off"));
  EXPECT_THAT(printed.err, testing::ContainsRegex("layer [0-9]+ of 40"));
  EXPECT_THAT(printed.err, HasSubstr("binderjet resume 1 --to usb:"));
  EXPECT_EQ(run({"resume", "1", "--to", "usb:"}).status, 4) << "still unplugged";
  printer_.plug();
  EXPECT_EQ(run({"resume", "1", "--to", "usb:"}).status, 0);
  expect_printed(job);
  EXPECT_EQ(run({"resume", "1", "--to", "usb:"}).status, 3) << "nothing is left to resume";
}

TEST_F(UsbProgram, GoesOnWhereItWasKilled) {
  const std::string job = write_job();
  printer_.set_plan({{F::kSlow, 0, 1, 3}});
  const pid_t sender = spawn({"print", job, "--to", "usb:"});
  ASSERT_TRUE(printer_.wait_for_layers(10));
  kill(sender, SIGKILL);
  EXPECT_EQ(wait(sender).status, 128 + SIGKILL);
  const auto status = nlohmann::json::parse(run({"status", "1", "--to", "usb:", "--json"}).out);
  EXPECT_EQ(status["state"], "held");
  EXPECT_LE(status["acknowledged"], printer_.acknowledged());
  EXPECT_GE(status["acknowledged"], printer_.acknowledged() - 5);
  EXPECT_EQ(run({"resume", "1", "--to", "usb:"}).status, 0);
  expect_printed(job);
}

TEST_F(UsbProgram, GoesOnBehindALossOfPower) {
  const std::string job = write_job();
  printer_.set_plan({{F::kPowerLoss, 20}});
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 4);
  printer_.plug();
  EXPECT_EQ(run({"resume", "1", "--to", "usb:"}).status, 0);
  expect_printed(job);
}

TEST_F(UsbProgram, StreamsAPartAsItIsSlicedAndResumesItWithoutAJobFile) {
  const std::string part = write_part(5);
  const std::vector<std::string> how = {"-p", "z450"};  // inverse masks
  std::vector<std::string> slice = {"slice", part, "-o", folder_ / "whole.bjob"};
  slice.insert(slice.end(), how.begin(), how.end());
  ASSERT_EQ(run(slice).status, 0);
  std::vector<std::string> print = {"print", part, "--to", "usb:", "--stream"};
  print.insert(print.end(), how.begin(), how.end());
  const Ended whole = run(print);
  ASSERT_EQ(whole.status, 0) << whole.err;
  expect_printed(folder_ / "whole.bjob");
  printer_.set_plan({{F::kPowerLoss, 30}});
  const Ended cut = run(print);
  EXPECT_EQ(cut.status, 4);
  EXPECT_THAT(cut.err, HasSubstr("binderjet resume 2 --to usb:"));
  printer_.plug();
  const Ended resumed = run({"resume", "2", "--to", "usb:"});
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  expect_printed(folder_ / "whole.bjob");
  EXPECT_LE(printer_.max_waiting(), 4);
}

TEST_F(UsbProgram, StreamsAPartIntoASpoolToo) {
  const std::string part = write_part(3);
  ASSERT_EQ(run({"slice", part, "-p", "z450", "-o", folder_ / "whole.bjob"}).status, 0);
  const std::string spool = folder_ / "spool";
  ASSERT_EQ(run({"print", part, "-p", "z450", "--to", "spool:" + spool}).status, 0);
  EXPECT_EQ(file_text(spool + "/done/1.bjob"), file_text(folder_ / "whole.bjob"));
}

TEST_F(UsbProgram, CancelsWithinASecondWhateverThePrinterDoes) {
  const std::string job = write_job();
  std::size_t job_number = 0;
  for (const PlannedFault fault :
       {PlannedFault{F::kNak, 12, 1, 0}, PlannedFault{F::kSilent, 12, 1, 0},
        PlannedFault{F::kSlow, 12, 1, 3600000}}) {
    printer_.set_plan({fault});
    const pid_t sender = spawn({"print", job, "--to", "usb:", "--json"});
    // Cancelled jobs leave the printer's memory; of those before, the printed ones are there.
    ASSERT_TRUE(printer_.wait_for_layers(12, ++job_number));
    if (fault.what == F::kNak) printer_.add_fault({F::kHangControl, 0, -1});
    const auto jobs = nlohmann::json::parse(run({"status", "--to", "usb:", "--json"}).out)["jobs"];
    const std::string id = jobs.back()["job"];
    const auto begin = Clock::now();
    EXPECT_LT(cancel(id), 1);
    const Ended stopped = wait(sender);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    std::printf("%s: the sender stopped within %.2f s\n", to_text(fault).c_str(), seconds);
    // Alone on a machine it is one; a sender that waits out its patience takes 30.
    EXPECT_LT(seconds, 10);
    EXPECT_EQ(stopped.status, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("was cancelled"));
    printer_.heal();
    EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 0) << "the next job has the way free";
    expect_printed(job);
  }
}

TEST_F(UsbProgram, CancelsAHeldJobOfAPrinterThatHangs) {
  const std::string job = write_job();
  printer_.set_plan({{F::kOutOfPowder, 12}});
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 4);
  const Ended second = run({"print", job, "--to", "usb:"});
  EXPECT_EQ(second.status, 4);
  EXPECT_THAT(second.err, HasSubstr("binderjet cancel 1 --to usb:"));
  printer_.set_plan({{F::kHangControl, 0, -1}});
  EXPECT_LT(cancel("1"), 1);
  printer_.heal();
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 0);
  expect_printed(job);
}

TEST_F(UsbProgram, WaitsWithoutWorkWhileThePrinterTakesNothing) {
  const std::string job = write_job();
  printer_.set_plan({{F::kNak, 12, 1, 5000}});
  const pid_t sender = spawn({"print", job, "--to", "usb:"});
  // Only the wait counts: a sanitizer makes a program's start and end slow.
  ASSERT_TRUE(printer_.wait_for_layers(12));
  const auto begin = Clock::now();
  const double cpu_before = cpu_s(sender);
  ASSERT_TRUE(printer_.wait_for_layers(13));
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  const double cpu = cpu_s(sender) - cpu_before;
  const Ended printed = wait(sender);
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_GE(seconds, 4.5);
  EXPECT_LT(cpu, 0.1 * seconds);
  std::printf("CPU %.3f s in %.2f s; %d empty reaps\n", cpu, seconds, bus_.empty_reaps());
}

TEST_F(UsbProgram, ListsThePrinterAndWhatItHas) {
  const auto seen = nlohmann::json::parse(run({"devices", "--json"}).out)["devices"];
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0]["uri"], "usb://1209:0001/EMU0001");
  const auto one = nlohmann::json::parse(run({"devices", "--to", "usb:", "--json"}).out)["devices"];
  EXPECT_EQ(one[0]["state"], "idle");
  EXPECT_THAT(one[0]["description"].get<std::string>(), HasSubstr("binder 60 %"));
}

TEST_F(UsbProgram, NamesTheFixWhereThePrinterCannotBeHad) {
  const std::string job = write_job();
  bus_.set_busy(true);
  EXPECT_THAT(run({"print", job, "--to", "usb:"}).err, HasSubstr("another program uses it"));
  bus_.set_busy(false);
  EXPECT_THAT(run({"print", job, "--to", "usb://1209:0001/OTHER"}).err, HasSubstr("serial number"));
  EXPECT_THAT(run({"print", job, "--to", "usb://dead:beef"}).err, HasSubstr("no such printer"));
  EXPECT_EQ(run({"print", job, "--to", "usb:nonsense"}).status, 2);
  // Root may open anything, so somebody else tries.
  chmod(bus_.node().c_str(), 0);
  const uid_t nobody = getuid() == 0 ? 65534 : 0;
  const Ended refused = wait(spawn({"print", job, "--to", "usb:"}, nobody));
  EXPECT_EQ(refused.status, 4);
  EXPECT_THAT(refused.err, HasSubstr("60-binderjet.rules"));
  chmod(bus_.node().c_str(), 0666);
  bus_.set_usblp(true);
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 0) << "the kernel's driver steps aside";
  EXPECT_TRUE(bus_.usblp_detached());
}

TEST_F(UsbProgram, WaitsForThePrinterToBePluggedInAgain) {
  const std::string job = write_job();
  printer_.set_plan({{F::kGone, 12}});
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 4);
  bus_.remove();
  EXPECT_THAT(run({"resume", "1", "--to", "usb:", "--wait", "0.3"}).err,
              HasSubstr("plugged in within"));
  const pid_t sender = spawn({"resume", "1", "--to", "usb:", "--wait", "20"});
  printer_.plug();
  bus_.add();
  EXPECT_EQ(wait(sender).status, 0);
  expect_printed(job);
}

TEST_F(UsbProgram, KeepsTheDataPipeFull) {
  // 96 layers of 1 MiB that do not compress.
  constexpr int kLayers = 96;
  const std::string path = folder_ / "big.bjob";
  auto writer = JobWriter::create(path, R"({"size_px": [2896, 2896, 96]})");
  std::mt19937_64 random(1);
  for (int layer = 0; layer < kLayers; ++layer) {
    std::vector<std::uint64_t> words((1 << 20) / 8);
    for (std::uint64_t& word : words) word = random();
    ASSERT_TRUE(writer->append(encode_record(
        RecordKind::kMask, layer, std::as_bytes(std::span<const std::uint64_t>(words)))));
  }
  ASSERT_TRUE(writer->finish());
  const Ended printed = run({"print", path, "--to", "usb:", "--json"});
  ASSERT_EQ(printed.status, 0) << printed.err;
  const auto result = nlohmann::json::parse(printed.out);
  const double rate = result["bytes_sent"].get<double>() / result["seconds"].get<double>() / 1e6;
  std::printf("%.0f MB/s, %zu transfers in flight at most, CPU %.2f s\n", rate,
              bus_.max_in_flight(), printed.cpu_s);
  // 53 MB/s were measured while two cores did the work of eight. This bound only catches a pipe
  // that runs dry between transfers.
  EXPECT_GT(rate, 5);
  EXPECT_GE(bus_.max_in_flight(), 3U);
  expect_printed(path);
}

TEST_F(UsbProgram, MakesDoWithLittleMemoryForTransfers) {
  const std::string job = write_job();
  bus_.set_no_memory(20 << 10);
  EXPECT_EQ(run({"print", job, "--to", "usb:"}).status, 0);
  expect_printed(job);
}

}  // namespace
}  // namespace binderjet
