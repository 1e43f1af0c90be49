// SPDX-License-Identifier: GPL-3.0-or-later
// Shares become the job they are shares of, or are refused with the layer's name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/transport/sample_job.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Join, OfSevenSharesIsTheWholeJobByteForByte) {
  const TempFolder folder;
  write_sample_job(folder / "whole.bjob", 0, 40);
  std::vector<std::string> shares;
  for (int i = 0; i < 7; ++i) {
    shares.push_back(folder / ("share" + std::to_string(i)));
    write_sample_job(shares.back(), 40 * i / 7, 40 * (i + 1) / 7);
  }
  std::swap(shares[1], shares[5]);
  const auto joined = join_jobs(shares, folder / "joined.bjob", 40);
  ASSERT_TRUE(joined) << joined.error().what;
  EXPECT_EQ(file_text(folder / "joined.bjob"), file_text(folder / "whole.bjob"));
}

TEST(Join, TellsEachLayerAndLeavesNothingWhereItIsEnded) {
  const TempFolder folder;
  write_sample_job(folder / "low", 0, 20);
  write_sample_job(folder / "high", 20, 40);
  std::vector<int> told;
  const std::vector<std::string> shares = {folder / "high", folder / "low"};
  ASSERT_TRUE(
      join_jobs(shares, folder / "joined.bjob", 40, [&told](int layer) { told.push_back(layer); }));
  told.erase(std::unique(told.begin(), told.end()), told.end());
  ASSERT_EQ(told.size(), 40U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));

  const auto enough = [](int layer) {
    if (layer == 30) throw std::runtime_error("enough");
  };
  EXPECT_THROW((void)join_jobs(shares, folder / "ended.bjob", 40, enough), std::runtime_error);
  EXPECT_THAT(names_in(folder.path()), Not(testing::Contains(HasSubstr("ended"))));
}

class RefusedJoin : public testing::Test {
 protected:
  // Joins shares with these layers; what the fault says.
  std::string join(const std::vector<std::pair<int, int>>& ranges) {
    std::vector<std::string> shares;
    for (const auto& [first, end] : ranges) {
      shares.push_back(folder_ / ("share" + std::to_string(shares.size())));
      write_sample_job(shares.back(), first, end);
    }
    return refusal(shares);
  }
  std::string refusal(const std::vector<std::string>& shares) {
    const auto joined = join_jobs(shares, folder_ / "joined.bjob", 40);
    EXPECT_THAT(names_in(folder_.path()), Not(testing::Contains(HasSubstr("joined"))));
    if (joined) return "joined";
    EXPECT_EQ(joined.error().kind, FailureKind::kBadInput);
    return joined.error().what;
  }
  TempFolder folder_;
};

TEST_F(RefusedJoin, NamesALayerThatTwoSharesHave) {
  EXPECT_THAT(join({{0, 21}, {20, 40}}), HasSubstr("layer 20 is in"));
}

TEST_F(RefusedJoin, NamesTheLayersOfAGap) {
  EXPECT_THAT(join({{0, 20}, {23, 40}}), HasSubstr("layers 20 to 22 of 40 missing"));
}

TEST_F(RefusedJoin, NamesTheLayersMissingAtBothEnds) {
  EXPECT_THAT(join({{1, 40}}), HasSubstr("layer 0 of 40 missing"));
  EXPECT_THAT(join({{0, 39}}), HasSubstr("layer 39 of 40 missing"));
}

TEST_F(RefusedJoin, NamesALayerAboveTheJob) {
  EXPECT_THAT(join({{0, 41}}), HasSubstr("layer 40 is above"));
}

TEST_F(RefusedJoin, OfDifferentJobs) {
  write_sample_job(folder_ / "a", 0, 20);
  write_sample_job(folder_ / "b", 20, 40, "another header");
  EXPECT_THAT(refusal({folder_ / "a", folder_ / "b"}), HasSubstr("not of the same job"));
}

TEST_F(RefusedJoin, OfACutShare) {
  write_sample_job(folder_ / "a", 0, 20);
  write_sample_job(folder_ / "b", 20, 40);
  std::filesystem::resize_file(folder_ / "b", std::filesystem::file_size(folder_ / "b") - 1);
  EXPECT_THAT(refusal({folder_ / "a", folder_ / "b"}), HasSubstr("index"));
}

TEST_F(RefusedJoin, OfASharesDamagedRecord) {
  write_sample_job(folder_ / "a", 0, 20);
  write_sample_job(folder_ / "b", 20, 40);
  std::string text = file_text(folder_ / "b");
  const auto offset = JobReader::open(folder_ / "b")->entries()[6].offset;
  text[offset + 50] = static_cast<char>(text[offset + 50] ^ 8);
  write_text(folder_ / "b", text);
  EXPECT_THAT(refusal({folder_ / "a", folder_ / "b"}), HasSubstr("layer 23 is damaged"));
}

}  // namespace
}  // namespace binderjet
