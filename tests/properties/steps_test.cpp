// SPDX-License-Identifier: GPL-3.0-or-later
// The table of steps in slicer/README.md against the pipelines that the program builds.
#include <cxxabi.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "driver/job/encoded_layers.h"
#include "driver/job/job_masks.h"
#include "driver/job/print_stream.h"
#include "driver/job/slice_plan.h"
#include "slicer/color/color.h"
#include "slicer/color/shell.h"
#include "slicer/score/score.h"
#include "tests/support/models.h"

namespace binderjet {
namespace {

// A row of the table: | step | from | to | looks at | in | file |.
struct Row {
  std::string name;
  std::string from;
  std::string to;
  std::string reach;
  std::set<std::string> in;
  std::string file;
};

std::string text_of_file(const std::string& name) {
  std::ifstream in(std::string(BINDERJET_SOURCE_DIR) + "/" + name);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> words(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, separator);) {
    const std::size_t first = word.find_first_not_of(" `");
    if (first == std::string::npos) continue;
    out.push_back(word.substr(first, word.find_last_not_of(" `") + 1 - first));
  }
  return out;
}

std::vector<Row> table() {
  std::vector<Row> rows;
  std::istringstream in(text_of_file("slicer/README.md"));
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> cells = words(line, '|');
    if (cells.size() == 6 && cells[0] == "step") inside = true;
    if (inside && cells.empty()) break;
    if (!inside || cells[0] == "step" || cells[0].starts_with("--")) continue;
    EXPECT_EQ(cells.size(), 6U) << line;
    if (cells.size() != 6) continue;
    const std::vector<std::string> in_words = words(cells[4], ',');
    rows.push_back(
        {cells[0], cells[1], cells[2], cells[3], {in_words.begin(), in_words.end()}, cells[5]});
  }
  return rows;
}

// The name of a kind of layer without its namespaces; "-" for none.
std::string type_name(const std::type_index& type) {
  if (type == typeid(void)) return "-";
  int status = 0;
  char* text = abi::__cxa_demangle(type.name(), nullptr, nullptr, &status);
  const std::string name = text;
  std::free(text);
  return name.substr(name.rfind(':') + 1);
}

// Layers of the printer model's window (w), of the colored shell's (c) and of the depth's (d).
struct Lengths {
  int w = 0;
  int c = 0;
  int d = 0;
};

std::string formula(const StepInfo& step, const std::string& written, const Lengths& by) {
  const std::map<std::string, int> values{
      {"0", 0},    {"1", 1},   {"w", by.w}, {"2 w", 2 * by.w}, {"2 w + 2", 2 * by.w + 2},
      {"c", by.c}, {"d", by.d}};
  EXPECT_TRUE(values.contains(written)) << written;
  if (step.block_layers > 0) return "works in blocks";
  if (step.reach != LayerReach::both_sides(values.at(written))) return "looks elsewhere";
  return "";
}

class Steps : public testing::Test {
 protected:
  // `effect` may make binder cross layers.
  JobHeader header(Enhancement enhance, const std::vector<EffectSpec>& effects = {}) const {
    JobHeader out;
    out.profile = load_profile("z450");
    out.profile.effects.insert(out.profile.effects.end(), effects.begin(), effects.end());
    out.grid = out.profile.grid({});
    out.enhance = enhance;
    out.passes = enhance == Enhancement::kPaper ? 2 : 0;
    out.box = job_box(bounding_box(*mesh_).max, out.grid, {0, 0}, {8, 8});
    return out;
  }
  PrinterModel model(const JobHeader& of) const { return {of.profile.effects, of.grid}; }

  // Each step has its row, as it is; the rows named `in` have their step, in the table's order.
  void expect_listed(const std::string& in, const std::vector<StepInfo>& steps, const Lengths& by) {
    SCOPED_TRACE(in);
    std::set<std::string> missing;
    for (const Row& row : rows_) {
      if (row.in.contains(in)) missing.insert(row.name);
    }
    std::size_t last = 0;
    std::set<std::string> seen;
    for (const StepInfo& step : steps) {
      SCOPED_TRACE(step.name);
      std::size_t at = 0;
      while (at < rows_.size() && rows_[at].name != step.name) ++at;
      ASSERT_LT(at, rows_.size()) << "is not in the table";
      const Row& row = rows_[at];
      EXPECT_TRUE(row.in.contains(in));
      EXPECT_EQ(row.from, type_name(step.from));
      EXPECT_EQ(row.to, type_name(step.to));
      EXPECT_EQ(formula(step, row.reach, by), "");
      if (seen.insert(step.name).second) {
        EXPECT_GE(at, last) << "stands before the step that feeds it";
        last = at;
      }
      missing.erase(step.name);
      met_.insert(step.name);
    }
    EXPECT_TRUE(missing.empty()) << *missing.begin() << " is not run";
  }

  std::vector<Row> rows_ = table();
  std::set<std::string> met_;
  std::shared_ptr<const Mesh> mesh_ =
      std::make_shared<const Mesh>(models::box({0, 0, 0}, {3, 2, 1}));
};

TEST_F(Steps, AreThoseOfTheTableInTheReadme) {
  ASSERT_FALSE(rows_.empty());
  const EffectSpec bleed{"z_bleed_down", {}, {{"share", {0.3}}}};
  const JobHeader across = header(Enhancement::kInverse, {bleed});
  const int w = model(across).window_reach();
  ASSERT_GT(w, 0);
  const auto steps = [&](const JobHeader& of) { return job_masks(of, mesh_).steps(); };
  expect_listed("none", steps(header(Enhancement::kNone)), {});
  expect_listed("paper", steps(header(Enhancement::kPaper)), {});
  expect_listed("paper", steps(header(Enhancement::kPaper, {bleed})), {w, 0});
  expect_listed("inverse", steps(across), {w, 0});
  // Layers that share no print need no second turn.
  for (const StepInfo& step : steps(header(Enhancement::kInverse)))
    EXPECT_NE(step.name, "improve again");

  const JobHeader plain = header(Enhancement::kNone);
  const auto after = [&](std::vector<StepInfo> all, const std::vector<StepInfo>& before) {
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(before.size()));
    return all;
  };
  expect_listed("job", after(encoded_layers(plain, mesh_, nullptr).steps(), steps(plain)), {});
  const auto white = plain_field(kWhite);
  const Shell shell(plain.grid, plain.box, plain.profile.color.depth_mm, white);
  expect_listed("color job", after(encoded_layers(plain, mesh_, white).steps(), steps(plain)),
                {0, shell.reach()});

  const PrinterModel printer = model(across);
  const auto shared = std::make_shared<const PrinterModel>(printer);
  expect_listed(
      "check",
      after(printed_job(plain, mesh_, shared, std::make_shared<MaskTally>()).steps(), steps(plain)),
      {w, 0});
  const MaskSource masks{};
  expect_listed("simulate", printed_layers(masks, printer).steps(), {w, 0});
  const Pipeline<ComparedLayer> compared("compare", {0, 1}, Pipeline<ComparedLayer>::Open());
  expect_listed("score", score_steps(compared, plain.grid).steps(),
                {0, 0, DepthFinder(plain.grid).reach().below});

  for (const Row& row : rows_) {
    EXPECT_TRUE(met_.contains(row.name)) << row.name << " is run by none";
    EXPECT_NE(text_of_file(row.file).find("\"" + row.name + "\""), std::string::npos)
        << row.file << " does not name " << row.name;
  }
}

}  // namespace
}  // namespace binderjet
