// SPDX-License-Identifier: GPL-3.0-or-later
// --help, the man pages, the completion and the README say the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <regex>
#include <set>

#include "driver/verbs/program.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Long options, and short ones that stand alone, in a text.
std::set<std::string> options_in(const std::string& text) {
  static const std::regex option("(^|[^\\w-])(--[a-z0-9][a-z0-9-]*)");
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at) {
    found.insert((*at)[2]);
  }
  return found;
}

std::set<std::string> verbs() {
  const auto program = make_program();
  std::set<std::string> found;
  for (const CLI::App* verb : program->get_subcommands({})) found.insert(verb->get_name());
  return found;
}

// What --help of the verb, and of its own verbs, offers.
std::set<std::string> options_of(const std::string& name) {
  const auto program = make_program();
  const CLI::App* verb = program->get_subcommand(name);
  std::set<std::string> found = options_in(verb->help());
  for (const CLI::App* sub : verb->get_subcommands({})) found.merge(options_in(sub->help()));
  return found;
}

std::string man_page(const std::string& verb) {
  const std::string page = file_text(BINDERJET_BUILD_DIR "/manual/binderjet-" + verb + ".1");
  return std::regex_replace(page, std::regex("\\\\-"), "-");
}

TEST(Manual, HasAPageForEveryVerbWithTheOptionsOfItsHelp) {
  const std::set<std::string> all = verbs();
  EXPECT_GE(all.size(), 14U);
  const std::string overview = file_text(BINDERJET_BUILD_DIR "/manual/binderjet.1");
  for (const std::string& verb : all) {
    SCOPED_TRACE(verb);
    EXPECT_EQ(options_in(std::regex_replace(man_page(verb), std::regex("\\\\f[BIR]"), " ")),
              options_of(verb));
    EXPECT_THAT(overview, HasSubstr("\\fB" + verb + "\\fR"));
  }
}

TEST(Manual, IsUnderstoodByGroff) {
  for (const std::string& verb : verbs()) {
    const std::string command = "groff -man -Tascii -ww " BINDERJET_BUILD_DIR "/manual/binderjet-" +
                                verb + ".1 2>&1 > /dev/null | grep .";
    EXPECT_NE(std::system(command.c_str()), 0) << verb;  // nothing to complain of
  }
}

TEST(Manual, AgreesWithTheReadme) {
  const std::string readme = file_text(BINDERJET_SOURCE_DIR "/README.md");
  std::set<std::string> known = {"--help", "--version"};
  known.insert({"--array", "--joblog", "--retry-failed"});  // of Slurm and GNU parallel
  std::set<std::string> named;
  for (const std::string& verb : verbs()) {
    known.merge(options_of(verb));
    if (std::regex_search(readme, std::regex("\\| [^|\n]*`" + verb + "[ `][^|]*\\|"))) {
      named.insert(verb);
    }
  }
  EXPECT_EQ(named, verbs());
  EXPECT_THAT(known, IsSupersetOf(options_in(readme)));
}

TEST(Completion, OffersVerbsOptionsAndTheirValues) {
  const auto offered = [](const std::string& words) {
    const Workplace place;
    const std::string script =
        "source " BINDERJET_BUILD_DIR "/manual/binderjet; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); compopt() { :; }; _binderjet; "
        "echo \"${COMPREPLY[@]}\"";
    std::ofstream(place / "script") << script;
    EXPECT_EQ(std::system(("bash " + (place / "script") + " > " + (place / "said")).c_str()), 0);
    return place.text("said");
  };
  EXPECT_EQ(offered("binderjet sl"), "slice\n");
  EXPECT_EQ(offered("binderjet slice --enh"), "--enhance\n");
  EXPECT_EQ(offered("binderjet slice --enhance in"), "inverse\n");
  EXPECT_EQ(offered("binderjet profile sh"), "show\n");
}

TEST(Completion, RunsNoNameOfAProfile) {
  const Workplace place;
  // A program that lists what somebody may have put into the folder of profiles.
  std::ofstream(place / "binderjet") << "#!/bin/sh\n"
                                        "echo 'z450 /share/z450.toml'\n"
                                        "echo '$(touch${IFS}'\"$HERE\"'/pwned) /share/x.toml'\n"
                                        "echo '`touch '\"$HERE\"'/pwned2` /share/y.toml'\n";
  std::filesystem::permissions(place / "binderjet", std::filesystem::perms(0755));
  std::ofstream(place / "script")
      << "source " BINDERJET_BUILD_DIR
         "/manual/binderjet; COMP_WORDS=(binderjet slice -p z); "
         "COMP_CWORD=3; compopt() { :; }; _binderjet; echo \"${COMPREPLY[@]}\"";
  const std::string here = place / "";
  EXPECT_EQ(std::system(("HERE='" + here + "' PATH='" + here + "':$PATH bash " +
                         (place / "script") + " > " + (place / "said"))
                            .c_str()),
            0);
  EXPECT_EQ(place.text("said"), "z450\n");
  EXPECT_FALSE(std::filesystem::exists(place / "pwned"));
  EXPECT_FALSE(std::filesystem::exists(place / "pwned2"));
}

}  // namespace
}  // namespace binderjet
