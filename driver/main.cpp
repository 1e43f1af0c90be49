// SPDX-License-Identifier: GPL-3.0-or-later
// The program: one line for an error, and its kind as the exit status.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <sstream>
#include <string>

#include "driver/base/interrupt.h"
#include "driver/base/said.h"
#include "driver/verbs/program.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

// Layers are made and freed by the thousand; pages that go back to the kernel each time come again
// at the price of a fault.
void keep_freed_pages() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

int fail(ErrorKind kind, const std::string& what) {
  // A call of the system that a signal ended fails in words of its own.
  if (interrupted() && kind != ErrorKind::kInterrupted) {
    return fail(ErrorKind::kInterrupted, "interrupted: " + what);
  }
  claim_end();
  say_line("binderjet: " + what);
  return static_cast<int>(kind);
}

// Help and version, which CLI11 takes for errors, and wrong words.
int say_parsed(const CLI::App& program, const CLI::ParseError& error) {
  std::ostringstream out;
  std::ostringstream err;
  const int status = program.exit(error, out, err);
  std::string text = out.str();
  if (text.ends_with('\n')) text.pop_back();
  if (!text.empty()) say_result(text);
  std::istringstream lines(err.str());
  for (std::string line; std::getline(lines, line);) say_line(line);
  return status == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
}

int run(int argc, char** argv) {
  const auto program = make_program();
  catch_interrupts();
  try {
    try {
      program->parse(argc, argv);
      claim_end();
      return 0;
    } catch (const CLI::ParseError& error) {
      return say_parsed(*program, error);
    }
  } catch (const Error& error) {
    return fail(error.kind(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kNoRoom, "out of memory; try a smaller part or a coarser grid");
  } catch (const std::exception& error) {
    constexpr auto kOurFault = static_cast<ErrorKind>(1);
    return fail(kOurFault, std::string("internal error, please report it: ") + error.what());
  }
}

}  // namespace
}  // namespace binderjet

int main(int argc, char** argv) {
  binderjet::hold_standard_files();
  binderjet::keep_freed_pages();
  return binderjet::run(argc, argv);
}
