// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/manual/manual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <vector>

#include "driver/manual/keys.h"

namespace binderjet {
namespace {

// Text that groff takes as it is.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return !out.empty() && (out.front() == '.' || out.front() == '\'') ? "\\&" + out : out;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string heading(const std::string& name) {
  return fmt::format(".TH {} 1 \"\" \"binderjet {}\" \"binderjet manual\"\n", name,
                     BINDERJET_VERSION);
}

std::string exit_status() {
  return ".SH EXIT STATUS\n"
         "0 done; 2 usage; 3 bad input (mesh, profile, job, stack); 4 device or transport;\n"
         "5 no room; 130 interrupted. One line says what is wrong, where, and what to do.\n";
}

// "-p, --profile TEXT", or "PART ...".
std::string term(const CLI::Option& option) {
  std::string names;
  if (option.get_positional()) {
    names = "\\fI" + roff(option.get_name(true)) + "\\fR";
  } else {
    for (const std::string& name : option.get_snames()) names += ", \\fB\\-" + roff(name) + "\\fR";
    for (const std::string& name : option.get_lnames()) {
      names += ", \\fB\\-\\-" + roff(name) + "\\fR";
    }
    names = names.substr(2);
  }
  if (option.get_items_expected_max() > 0) {
    if (!option.get_positional()) names += " \\fI" + roff(option.get_type_name()) + "\\fR";
    if (option.get_items_expected_max() > 1) names += " ...";
  }
  return names;
}

std::string options_section(const CLI::App& app) {
  std::string out = ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) {
    out += ".TP\n" + term(*option) + "\n" + roff(option->get_description());
    if (option->get_required()) out += " (required)";
    if (!option->get_default_str().empty()) {
      out += " (default: " + roff(option->get_default_str()) + ")";
    }
    out += "\n";
  }
  return out;
}

std::string keys_sections(const std::string& verb) {
  std::string out;
  for (const KeyTable& table : key_tables(verb)) {
    out += ".SH " + table.title + "\n" + roff(table.about) + "\n";
    for (const Key& key : table.keys) {
      out += ".TP\n\\fB" + roff(key.name) + "\\fR\n" + roff(key.meaning) + "\n";
    }
  }
  return out;
}

std::string synopsis(const CLI::App& verb) {
  std::string out = fmt::format("\\fBbinderjet {}\\fR", roff(verb.get_name()));
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional()) {
      out += " " + term(*option);
    } else if (option->get_required()) {
      out += fmt::format(" \\fB\\-{}\\fR \\fI{}\\fR",
                         option->get_snames().empty() ? "\\-" + roff(option->get_lnames()[0])
                                                      : roff(option->get_snames()[0]),
                         roff(option->get_type_name()));
    }
  }
  for (const CLI::App* sub : verb.get_subcommands({})) out += " | " + roff(sub->get_name());
  return out + " [\\fIoptions\\fR]\n";
}

std::vector<std::string> long_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// "TEXT:{none,paper}" -> "none paper"; empty if any text will do.
std::string choices(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string words = type.substr(begin + 1, end - begin - 1);
  for (char& c : words) c = c == ',' ? ' ' : c;
  return words;
}

}  // namespace

std::string program_page(const CLI::App& program) {
  std::string out = heading("BINDERJET");
  out += ".SH NAME\nbinderjet \\- " + roff(program.get_description()) + "\n";
  out += ".SH SYNOPSIS\n\\fBbinderjet\\fR \\fIverb\\fR [\\fIoptions\\fR]\n";
  out += ".SH VERBS\nEach has a page of its own, binderjet\\-VERB(1), and \\fB\\-\\-help\\fR.\n";
  for (const CLI::App* verb : program.get_subcommands({})) {
    out += ".TP\n\\fB" + roff(verb->get_name()) + "\\fR\n" + roff(verb->get_description()) + "\n";
  }
  out += options_section(program);
  out += exit_status();
  out +=
      ".SH ENVIRONMENT\n.TP\n\\fBBINDERJET_STATE\\fR\nwhere the journals of printed jobs are kept "
      "(default: ~/.local/state/binderjet)\n"
      ".TP\n\\fBBINDERJET_PROGRESS_AFTER\\fR\nafter so many seconds of work a terminal shows "
      "how far it is (default: 0.5); with 0 every step is shown\n"
      ".TP\n\\fBBINDERJET_READ\\fR\nthe program that decodes images (default: binderjet-read "
      "beside this one)\n"
      ".SH NAMES\nNames of files are bytes. In messages and in JSON a byte that is not UTF-8, and in "
      "messages one that a terminal would obey, is written \\exNN with two hex digits.\n";
  return out;
}

std::string verb_page(const CLI::App& verb) {
  std::string out = heading(fmt::format("BINDERJET\\-{}", upper(verb.get_name())));
  out += fmt::format(".SH NAME\nbinderjet\\-{} \\- {}\n", verb.get_name(),
                     roff(verb.get_description()));
  out += ".SH SYNOPSIS\n" + synopsis(verb);
  for (const CLI::App* sub : verb.get_subcommands({})) {
    out += fmt::format(".SH {}\n{}\n.br\n{}", upper(sub->get_name()), roff(sub->get_description()),
                       synopsis(*sub));
    for (const CLI::Option* option : sub->get_options()) {
      out += ".TP\n" + term(*option) + "\n" + roff(option->get_description()) + "\n";
    }
  }
  out += options_section(verb);
  out += keys_sections(verb.get_name());
  out += exit_status();
  out += ".SH SEE ALSO\nbinderjet(1)\n";
  return out;
}

std::string keys_page(const CLI::App& program) {
  std::string out =
      "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n"
      "# Every key of JSON and every column of CSV\n\n"
      "The man pages say the same, verb by verb. `found[].at_mm` is `at_mm` of each object of the "
      "list "
      "`found`.\n"
      "Made by `build/driver/binderjet_manual build/manual` (`build/manual/keys.md`).\n";
  for (const CLI::App* verb : program.get_subcommands({})) {
    for (const KeyTable& table : key_tables(verb->get_name())) {
      out += fmt::format("\n## {}: {}\n\n{}\n\n| key | meaning |\n|---|---|\n", verb->get_name(),
                         table.title, table.about);
      for (const Key& key : table.keys) {
        out += fmt::format("| `{}` | {} |\n", key.name, key.meaning);
      }
    }
  }
  return out;
}

std::string bash_completion(const CLI::App& program) {
  std::string verbs;
  std::string cases;
  std::string values;
  std::string subs;
  for (const CLI::App* verb : program.get_subcommands({})) {
    verbs += (verbs.empty() ? "" : " ") + verb->get_name();
    std::string words = fmt::format("{}", fmt::join(long_names(*verb), " "));
    std::string second;
    for (const CLI::App* sub : verb->get_subcommands({})) second += " " + sub->get_name();
    if (!second.empty()) subs += fmt::format("    {}) words=\"{}\" ;;\n", verb->get_name(), second);
    cases += fmt::format("    {}) words=\"{}\" ;;\n", verb->get_name(), words);
    for (const CLI::Option* option : verb->get_options()) {
      const std::string some = choices(*option);
      if (some.empty() || option->get_lnames().empty()) continue;
      values += fmt::format("    \"{} --{}\") words=\"{}\" ;;\n", verb->get_name(),
                            option->get_lnames()[0], some);
    }
  }
  return fmt::format(R"(# bash completion for binderjet
# SPDX-License-Identifier: GPL-3.0-or-later
_binderjet() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{} --help --version" -- "$current")
    return
  fi
  case "${{COMP_WORDS[1]}} $before" in
{}  esac
  case "$before" in
    # compgen expands its words, so a name that the shell would run is not among them.
    -p | --profile)
      words=$(binderjet profile list 2> /dev/null | sed -n 's/^\([[:alnum:]._+-]*\) .*/\1/p')
      ;;
  esac
  if [ -z "$words" ] && [[ $current == -* ]]; then
    case "${{COMP_WORDS[1]}}" in
{}    esac
  elif [ -z "$words" ] && [ "$COMP_CWORD" -eq 2 ]; then
    case "${{COMP_WORDS[1]}}" in
{}    esac
  fi
  if [ -n "$words" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -F _binderjet binderjet
)",
                     verbs, values, cases, subs);
}

}  // namespace binderjet
