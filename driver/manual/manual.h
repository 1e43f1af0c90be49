// SPDX-License-Identifier: GPL-3.0-or-later
// What the program says of itself with --help, as man pages and as completion for bash.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace binderjet {

// binderjet.1: the verbs, exit status, files.
std::string program_page(const CLI::App& program);
// binderjet-VERB.1: what --help of the verb says, and what its JSON and CSV mean (keys.h).
std::string verb_page(const CLI::App& verb);
// What JSON and CSV of all verbs mean, in Markdown: keys.md beside this file.
std::string keys_page(const CLI::App& program);
// For /usr/share/bash-completion/completions.
std::string bash_completion(const CLI::App& program);

}  // namespace binderjet
