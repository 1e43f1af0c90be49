// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the man pages, keys.md and the completion for bash into a folder: binderjet_manual FOLDER
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>

#include "driver/base/files.h"
#include "driver/manual/manual.h"
#include "driver/verbs/program.h"

int main(int argc, char** argv) {
  using namespace binderjet;
  if (argc != 2) return 2;
  try {
    const std::string folder = argv[1];
    const auto program = make_program();
    write_text(folder + "/binderjet.1", program_page(*program));
    for (const CLI::App* verb : program->get_subcommands({})) {
      write_text(folder + "/binderjet-" + verb->get_name() + ".1", verb_page(*verb));
    }
    write_text(folder + "/keys.md", keys_page(*program));
    write_text(folder + "/binderjet", bash_completion(*program));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
