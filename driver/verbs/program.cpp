// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/verbs/program.h"

#include <CLI/CLI.hpp>

#include "driver/verbs/verbs.h"

namespace binderjet {

std::unique_ptr<CLI::App> make_program() {
  auto program = std::make_unique<CLI::App>("the open printer driver for powder-binder 3D printers",
                                            "binderjet");
  program->set_version_flag("--version", "binderjet " BINDERJET_VERSION);
  program->require_subcommand(1);
  add_slice_verb(*program);
  add_export_verb(*program);
  add_simulate_verb(*program);
  add_score_verb(*program);
  add_explain_verb(*program);
  add_check_verb(*program);
  add_coupon_verb(*program);
  add_calibrate_verb(*program);
  add_join_verb(*program);
  add_print_verb(*program);
  add_queue_verbs(*program);
  add_emulator_verb(*program);
  add_profile_verb(*program);
  return program;
}

}  // namespace binderjet
