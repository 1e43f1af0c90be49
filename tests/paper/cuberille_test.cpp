// SPDX-License-Identifier: GPL-3.0-or-later
// The paper, 4.3: the way to the printer through a cuberille mesh gives the masks that could have
// been sent at once, and costs this much more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <iostream>

#include "driver/job/mask_source.h"
#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

struct Cost {
  double seconds = 0;
  double peak_mb = 0;
  // One after the other: times add up, and the larger peak counts.
  Cost operator+(const Cost& next) const {
    return {seconds + next.seconds, std::max(peak_mb, next.peak_mb)};
  }
};

Cost run(const Workplace& place, std::vector<std::string> words) {
  words.emplace_back("-q");
  const auto start = std::chrono::steady_clock::now();
  const Ran ran = place.run(words);
  EXPECT_EQ(ran.status, 0) << words[0] << ": " << ran.err;
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          ran.peak_rss_mb};
}

// The masks cut to the pixels that hold any binder; the mesh does not know the powder around.
std::vector<RunLayer> trimmed(const std::string& path) {
  const MaskSource job = open_job(path, Console{});
  std::vector<RunLayer> masks;
  std::array<int, 2> low{job.size_px[0], job.size_px[1]};
  std::array<int, 2> high{0, 0};
  for (int k = 0; k < job.size_px[2]; ++k) {
    masks.push_back(job.read(k));
    for (int y = 0; y < job.size_px[1]; ++y) {
      const auto row = masks.back().row(y);
      if (row.empty()) continue;
      low = {std::min(low[0], row.front()), std::min(low[1], y)};
      high = {std::max(high[0], row.back()), std::max(high[1], y + 1)};
    }
  }
  while (!masks.empty() && masks.back().empty()) masks.pop_back();
  while (!masks.empty() && masks.front().empty()) masks.erase(masks.begin());
  for (RunLayer& mask : masks) {
    mask = window(mask, low[0], low[1], high[0] - low[0], high[1] - low[1]);
  }
  return masks;
}

TEST(PaperCuberille, GivesTheSameMasksAndCostsMore) {
  const Workplace folder;
  const auto file = [&](const char* name) { return folder / name; };
  models::write_obj(models::golf_ball(8), file("ball.obj"));

  const Cost direct = run(folder, {"slice", file("ball.obj"), "-p", "z450", "-o",
                                   file("direct.bjob"), "--enhance", "paper", "--passes", "2"});
  const Cost write =
      run(folder, {"export", file("direct.bjob"), "--cuberille", file("cuberille.ply")});
  const Cost again = run(folder, {"slice", file("cuberille.ply"), "-p", "z450", "-o",
                                  file("again.bjob"), "--enhance", "none"});
  const Cost detour = direct + write + again;

  std::cout << fmt::format(
      "masks directly:          {:6.2f} s, {:5.0f} MiB, {:8.2f} MB\n"
      "through the cuberille:   {:6.2f} s, {:5.0f} MiB, {:8.2f} MB of mesh (written in {:.2f} s, "
      "sliced in {:.2f} s)\n"
      "ratio:                   {:6.1f}    {:5.1f}\n",
      direct.seconds, direct.peak_mb,
      static_cast<double>(std::filesystem::file_size(file("direct.bjob"))) / 1e6, detour.seconds,
      detour.peak_mb, static_cast<double>(std::filesystem::file_size(file("cuberille.ply"))) / 1e6,
      write.seconds, again.seconds, detour.seconds / direct.seconds,
      detour.peak_mb / direct.peak_mb);

  const auto sent = trimmed(file("direct.bjob"));
  ASSERT_GT(sent.size(), 100U);
  EXPECT_EQ(trimmed(file("again.bjob")), sent);
  EXPECT_GT(detour.seconds, direct.seconds);
  EXPECT_GT(detour.peak_mb, direct.peak_mb);
}

}  // namespace
}  // namespace binderjet
