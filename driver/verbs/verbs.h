// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of the program; each adds itself to the command line and runs in the parser's callback.
// A verb ends by returning (exit status 0) or by throwing Error.
#pragma once

namespace CLI {
class App;
}

namespace binderjet {

void add_slice_verb(CLI::App& program);
void add_export_verb(CLI::App& program);
void add_join_verb(CLI::App& program);
void add_print_verb(CLI::App& program);
void add_emulator_verb(CLI::App& program);
void add_queue_verbs(CLI::App& program);  // status, cancel, resume and devices
void add_profile_verb(CLI::App& program);
void add_simulate_verb(CLI::App& program);
void add_score_verb(CLI::App& program);
void add_explain_verb(CLI::App& program);
void add_check_verb(CLI::App& program);
void add_coupon_verb(CLI::App& program);
void add_calibrate_verb(CLI::App& program);

}  // namespace binderjet
