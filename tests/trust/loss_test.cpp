// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing that the program did not write is replaced or removed, and no number of a stranger's job
// or of the command line is taken for more than it can be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kPart =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class Loss : public testing::Test {
 protected:
  Loss() {
    std::ofstream(here_ / "part.obj") << kPart;
    const Ran ran = here_.run(
        {"slice", here_ / "part.obj", "-p", "z450", "--enhance", "none", "-o", here_ / "a.bjob"});
    EXPECT_EQ(ran.status, 0) << ran.err;
  }
  // The good job with a changed header.
  template <class Change>
  std::string job_with(Change change) const {
    const auto good = JobReader::open(here_ / "a.bjob");
    Json header = Json::parse(good->header());
    change(header);
    const std::string path = here_ / "odd.bjob";
    fs::remove(path);
    auto writer = JobWriter::create(path, header.dump());
    for (const int layer : good->layers(RecordKind::kMask)) {
      EXPECT_TRUE(writer->append(*good->read_record(RecordKind::kMask, layer)));
    }
    EXPECT_TRUE(writer->finish());
    return path;
  }

  Workplace here_;
};

TEST_F(Loss, OfAModelOrALetterByTheNameOfAnOutput) {
  std::ofstream(here_ / "letter.txt") << "dear";
  for (const std::string& out : {here_ / "part.obj", here_ / "letter.txt"}) {
    const std::string name = fs::path(out).filename();
    const std::string before = here_.text(name);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"slice", here_ / "part.obj", "-p", "z450", "--enhance", "none",
                                   "-o", out},
          {"print", here_ / "a.bjob", "--to", "file:" + out},
          {"join", here_ / "a.bjob", "-o", out}}) {
      const Ran ran = here_.run(words);
      EXPECT_THAT(ran.status, AnyOf(2, 3)) << words.front();
      EXPECT_EQ(here_.text(name), before) << words.front();
    }
  }
  const Ran again = here_.run(
      {"slice", here_ / "part.obj", "-p", "z450", "--enhance", "none", "-o", here_ / "a.bjob"});
  EXPECT_EQ(again.status, 0) << "a job may be replaced: " << again.err;
}

TEST_F(Loss, OfWhatLiesInAnOutputFolder) {
  const std::string out = here_ / "out";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"export", here_ / "a.bjob", "-o", out},
        {"export", here_ / "a.bjob", "-o", out, "--what", "printed"},
        {"export", here_ / "a.bjob", "-o", out, "--what", "target"},
        {"simulate", here_ / "a.bjob", "-p", "z450", "-o", out},
        {"score", here_ / "a.bjob", "--target", here_ / "part.obj", "--map", out}}) {
    SCOPED_TRACE(words.front());
    fs::remove_all(out);
    fs::create_directory(out);
    std::ofstream(out + "/stack.json") << "";
    std::ofstream(out + "/thesis.txt") << "mine";
    EXPECT_EQ(here_.run(words).status, 2) << "a folder with any stack.json";
    EXPECT_TRUE(fs::exists(out + "/thesis.txt"));
    fs::remove_all(out);
    ASSERT_EQ(here_.run(words).status, 0);
    EXPECT_EQ(here_.run(words).status, 0) << "its own stack is replaced";
    fs::copy(here_ / "a.bjob", out + "/my.bjob");
    const Ran ran = here_.run(words);
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, HasSubstr("holds my.bjob"));
    EXPECT_TRUE(fs::exists(out + "/my.bjob"));
    // A stack.json that claims a file elsewhere has no power over it.
    fs::remove(out + "/my.bjob");
    std::ofstream(here_ / "thesis.txt") << "mine";
    Json json = Json::parse(std::ifstream(out + "/stack.json"));
    json["also"] = {"../thesis.txt", here_ / "thesis.txt"};
    std::ofstream(out + "/stack.json") << json.dump();
    EXPECT_EQ(here_.run(words).status, 2);
    EXPECT_TRUE(fs::exists(here_ / "thesis.txt"));
  }
}

TEST_F(Loss, OfSenseInAJobsHeader) {
  const std::vector<std::pair<std::string, Json>> odd = {
      {"passes", -5},
      {"passes", 2147483647},
      {"detail_vx", {0, 2, 1}},
      {"detail_vx", {-2, 2, 1}},
      {"detail_vx", {100, 2, 1}},
      {"pitch_mm", {0, 0.1, 0.1}},
      {"pitch_mm", {-1, 1, 1}},
      {"pitch_mm", {1e308, 1, 1}},
      {"margin_px", {-1, 0, 0}},
      {"bed_px", {2000000000, 0, 0}},
      {"size_px", {0, 1, 1}},
      {"size_px", {1, 1, -1}},
      {"sources", Json::array()},
  };
  for (const auto& [key, value] : odd) {
    SCOPED_TRACE(key + " " + value.dump());
    const std::string job = job_with([&](Json& header) { header[key] = value; });
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"export", job, "-o", here_ / "out"},
          {"score", job, "--target", here_ / "part.obj"},
          {"simulate", job, "-p", "z450", "-o", here_ / "printed"},
          {"export", job, "--html", here_ / "a.html"}}) {
      EXPECT_EQ(here_.run(words, 10, 1024).status, 3) << words.front();
    }
  }
  for (const auto& [key, value] :
       std::vector<std::pair<std::string, Json>>{{"scale", -1},
                                                 {"scale", 1e300},
                                                 {"unit_mm", 0},
                                                 {"rotate_deg", {1e300, 0, 0}},
                                                 {"wall_mm", -1},
                                                 {"corner_px", {2000000000, 0}}}) {
    SCOPED_TRACE(key + " " + value.dump());
    const std::string job = job_with([&](Json& header) { header["sources"][0][key] = value; });
    const Ran ran = here_.run({"export", job, "--what", "target", "-o", here_ / "out"}, 10, 1024);
    EXPECT_EQ(ran.status, 3) << ran.err;
  }
}

TEST_F(Loss, OfSenseInANumberOfTheCommandLine) {
  const std::vector<std::vector<std::string>> odd = {
      {"--at", "nan,nan"},     {"--at", "1e300,1e300"}, {"--at", "inf,0"},  {"--rotate", "nan,0,0"},
      {"--rotate", "inf,0,0"}, {"--scale", "nan"},      {"--scale", "inf"}, {"--scale", "1e300"},
      {"--size", "nan"},       {"--size", "inf"},       {"--layer", "nan"}, {"--wall", "nan"},
      {"--wall", "inf"},
  };
  for (const std::vector<std::string>& option : odd) {
    SCOPED_TRACE(option[0] + " " + option[1]);
    for (const char* verb : {"slice", "check"}) {
      std::vector<std::string> words = {verb, here_ / "part.obj", "-p", "z450"};
      if (std::string(verb) == "slice") {
        words.insert(words.end(), {"--enhance", "none", "-o", here_ / "x.bjob"});
      }
      words.insert(words.end(), option.begin(), option.end());
      const Ran ran = here_.run(words, 10, 1024);
      EXPECT_THAT(ran.status, AnyOf(2, 3)) << verb << ": " << ran.out << ran.err;
      EXPECT_FALSE(fs::exists(here_ / "x.bjob"));
    }
  }
}

}  // namespace
}  // namespace binderjet
