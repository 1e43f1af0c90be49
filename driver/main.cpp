// SPDX-License-Identifier: GPL-3.0-or-later
// The program: one line for an error, and its kind as the exit status.
#include <fmt/core.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>

#include "driver/base/interrupt.h"
#include "driver/verbs/program.h"
#include "slicer/base/error.h"

namespace {

// Layers are made and freed by the thousand; pages that go back to the kernel each time come again
// at the price of a fault.
void keep_freed_pages() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  using namespace binderjet;
  keep_freed_pages();
  const auto program = make_program();
  catch_interrupts();
  try {
    program->parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    const int status = program->exit(error);
    return status == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
  } catch (const Error& error) {
    fmt::print(stderr, "binderjet: {}\n", error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "binderjet: out of memory; try a smaller part or a coarser grid\n");
    return static_cast<int>(ErrorKind::kNoRoom);
  } catch (const std::exception& error) {
    fmt::print(stderr, "binderjet: internal error, please report it: {}\n", error.what());
    return 1;
  }
}
