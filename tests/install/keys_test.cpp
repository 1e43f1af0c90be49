// SPDX-License-Identifier: GPL-3.0-or-later
// Man pages name every key of JSON and every column of CSV that the program writes or reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <regex>
#include <set>
#include <sstream>

#include "driver/verbs/program.h"
#include "tests/support/caliper_readings.h"
#include "tests/support/models.h"
#include "tests/support/program.h"
#include "tests/support/started_program.h"
#include "transport/job/job_file.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

using testing::IsEmpty;
using Json = nlohmann::json;

// The ways to all values: "found[].at_mm". What holds nothing has no way.
void add_ways(const Json& json, const std::string& way, std::set<std::string>& ways) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      add_ways(value, way.empty() ? key : way + "." + key, ways);
    }
  } else if (json.is_array() && !json.empty() && json.front().is_object()) {
    for (const Json& one : json) add_ways(one, way + "[]", ways);
  } else if (!json.is_array() || !json.empty()) {
    ways.insert(way);
  }
}

std::set<std::string> ways_of(const Json& json) {
  std::set<std::string> ways;
  add_ways(json, "", ways);
  return ways;
}

std::set<std::string> columns_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  while (std::getline(lines, line) && line.starts_with("#")) {
  }
  std::istringstream cells(line);
  std::set<std::string> columns;
  for (std::string cell; std::getline(cells, cell, ',');) columns.insert(cell);
  return columns;
}

// What a man page says the meaning of, in bold after .TP; "a, b" are two.
std::set<std::string> named_in(const std::string& verb) {
  std::ifstream file(BINDERJET_BUILD_DIR "/manual/binderjet-" + verb + ".1");
  std::set<std::string> names;
  std::string before;
  for (std::string line; std::getline(file, line); before = line) {
    std::smatch bold;
    static const std::regex in_bold(R"(\\fB(.*)\\fR)");
    if (before != ".TP" || !std::regex_match(line, bold, in_bold)) continue;
    const std::string all = std::regex_replace(bold[1].str(), std::regex(", "), "\n");
    std::istringstream each(all);
    for (std::string name; std::getline(each, name);) names.insert(name);
  }
  return names;
}

bool names(const std::string& pattern, const std::string& way) {
  std::string regex;
  for (const char c : pattern)
    regex += std::isalnum(c) != 0 || c == '_' ? std::string(1, c) : std::string("\\") + c;
  regex = std::regex_replace(regex, std::regex("NAME"), "[a-z0-9_ ]+");
  regex = std::regex_replace(regex, std::regex(R"(\\\[\\\]$)"), "");  // a list of values
  return std::regex_match(way, std::regex(regex));
}

std::vector<std::string> unnamed(const std::set<std::string>& ways, const std::string& verb) {
  const std::set<std::string> all = named_in(verb);
  std::vector<std::string> out;
  for (const std::string& way : ways) {
    // compare.NAME stands for the same keys again.
    const std::string plain = std::regex_replace(way, std::regex("^compare\\.[a-z]+\\."), "");
    const bool known = std::any_of(all.begin(), all.end(),
                                   [&](const std::string& name) { return names(name, plain); });
    if (!known) out.push_back(verb + ": " + way);
  }
  return out;
}

class Keys : public testing::Test {
 protected:
  Keys() {
    models::write_obj(models::golf_ball(1.5, 4), here_ / "ball.obj");
    run({"slice", here_ / "ball.obj", "-p", "z450", "-o", here_ / "a.bjob"});
    run({"slice", here_ / "ball.obj", "-p", "z450", "-o", here_ / "low.bjob", "--layers", ":9"});
    run({"slice", here_ / "ball.obj", "-p", "z450", "-o", here_ / "high.bjob", "--layers", "9:"});
  }
  // Runs a verb, and demands that its page names all that it says.
  Json run(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Ran ran = here_.run(words);
    EXPECT_EQ(ran.status, 0) << words.front() << ": " << ran.err;
    if (ran.status != 0) return {};
    ran_.insert(words.front());
    EXPECT_THAT(unnamed(ways_of(ran.json()), words.front()), IsEmpty());
    return ran.json();
  }
  void expect_file(const std::string& name, const std::string& verb) const {
    const Json json = Json::parse(here_.text(name));
    EXPECT_THAT(unnamed(ways_of(json), verb), IsEmpty()) << name;
  }
  void expect_table(const std::string& csv) {
    EXPECT_THAT(unnamed(columns_of(csv), "calibrate"), IsEmpty());
    std::ofstream(here_ / "gauges.csv") << csv;
    run({"calibrate", "-p", "z450", "--gauges", here_ / "gauges.csv", "-o", here_ / "gauges"});
    expect_file("gauges/calibration.json", "calibrate");
  }
  void print_to_an_emulator(const std::string& job) {
    Started emulator({"emulator", "-o", here_ / "printer", "--json"}, false);
    EXPECT_THAT(emulator.line(), testing::HasSubstr("ready"));
    const Json sent = run({"print", job, "--to", "emulator:" + (here_ / "printer")});
    EXPECT_TRUE(sent.contains("printed"));
    expect_file("printer/1/stack.json", "emulator");
    emulator.signal(SIGTERM);
    const Json ended = Json::parse(emulator.end().out);
    EXPECT_FALSE(ended["jobs"].empty());
    EXPECT_THAT(unnamed(ways_of(ended), "emulator"), IsEmpty());
    ran_.insert("emulator");
  }
  void hold_a_job() const {
    const JobReader job = *JobReader::open(here_ / "a.bjob");
    const auto spool = *open_backend(spool_);
    const int layers = static_cast<int>(job.layers(RecordKind::kMask).size());
    ASSERT_TRUE(spool->start({job.header(), layers, "a", here_ / "a.bjob"}));
    ASSERT_TRUE(spool->send(0, *job.read_record(RecordKind::kMask, 0)));
  }

  Workplace here_;
  std::string spool_ = "spool:" + (here_ / "spool");
  std::set<std::string> ran_;
};

TEST_F(Keys, OfEveryVerbStandInItsManPage) {
  const std::string job = here_ / "a.bjob";
  run({"export", job, "-o", here_ / "masks"});
  expect_file("masks/stack.json", "export");
  run({"export", job, "-o", here_ / "all", "--what", "mask,target", "--html", here_ / "a.html"});
  run({"simulate", here_ / "masks", "-p", "z450-fig3", "-o", here_ / "print"});
  expect_file("print/stack.json", "simulate");
  run({"score", job, "--target", here_ / "ball.obj", "--compare", "--map", here_ / "map"});
  expect_file("map/features.json", "score");
  run({"explain", job, "5,5,5"});
  run({"coupon", "--kind", "walls", "-o", here_ / "walls.stl"});
  const Json checked =
      run({"check", here_ / "walls.stl", "-p", "z450", "--enhance", "none", "--scale", "0.4"});
  EXPECT_FALSE(checked["found"].empty());
  const Json found = run({"calibrate", "-p", "z450", "--job", here_ / "masks", "--measured",
                          here_ / "print", "-o", here_ / "out"});
  EXPECT_FALSE(found["effects"].empty());
  expect_file("out/calibration.json", "calibrate");
  run({"join", here_ / "low.bjob", here_ / "high.bjob", "-o", here_ / "whole.bjob"});
  run({"print", job, "--to", spool_});
  hold_a_job();
  run({"status", "--to", spool_});
  run({"status", "2", "--to", spool_});
  run({"resume", "2", "--to", spool_});
  hold_a_job();
  run({"cancel", "3", "--to", spool_});
  run({"devices", "--to", spool_});
  print_to_an_emulator(job);
  run({"profile", "list"});
  run({"profile", "show", "z450"});
  run({"profile", "check", "z450-fig3"});

  std::set<std::string> all;
  const auto program = make_program();
  for (const CLI::App* verb : program->get_subcommands({})) all.insert(verb->get_name());
  EXPECT_EQ(ran_, all);
}

TEST_F(Keys, OfEveryGaugeTableStandInTheManPageOfCalibrate) {
  expect_table(
      "axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nx,0.6,0.7\ny,0.3,0.3\nz,0.1,0.1"
      "\n");
  expect_table(
      "gauge,axis,nominal_mm,measured_mm,uncertainty_mm\nwall,x,1,1.3,0.05\nwall,y,1,1.1,0.05\n"
      "slot,x,1,0.7,0.05\n");
  expect_table("gauge,axis,nominal_mm,visible\nwall,x,0.2,0\nwall,x,0.3,1\n");
  write_readings(here_ / "lengths.csv", {}, 1);
  expect_table(here_.text("lengths.csv"));
}

TEST(KeysPage, IsWhatTheProgramSays) {
  const auto text = [](const std::string& path) {
    std::ostringstream out;
    out << std::ifstream(path).rdbuf();
    return out.str();
  };
  EXPECT_EQ(text(BINDERJET_SOURCE_DIR "/driver/manual/keys.md"),
            text(BINDERJET_BUILD_DIR "/manual/keys.md"))
      << "cp build/manual/keys.md driver/manual/";
}

}  // namespace
}  // namespace binderjet
