// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a job that no compression makes small: each mask is noise, so its bytes are what they are.
//
//   make_noisy_job FILE.bjob WIDTH_PX HEIGHT_PX LAYERS
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "driver/job/job.h"
#include "driver/profile/profile.h"
#include "transport/job/job_file.h"

namespace {

using binderjet::encode_record;
using binderjet::JobHeader;
using binderjet::JobWriter;
using binderjet::RecordKind;

// Packed as slicer/layers/run_layer.h has it: rows of whole bytes, bits behind the last column are
// 0.
std::vector<std::byte> noise(int width, int height, std::mt19937& random) {
  const int row = (width + 7) / 8;
  std::vector<std::byte> bits(static_cast<std::size_t>(row) * static_cast<std::size_t>(height));
  for (std::byte& each : bits) each = static_cast<std::byte>(random() >> 24);
  return bits;
}

}  // namespace

int main(int count, char** words) {
  if (count != 5) {
    std::fputs("make_noisy_job FILE.bjob WIDTH_PX HEIGHT_PX LAYERS\n", stderr);
    return 2;
  }
  const int width = std::atoi(words[2]) / 8 * 8;
  const int height = std::atoi(words[3]);
  const int layers = std::atoi(words[4]);
  JobHeader header;
  header.profile = binderjet::load_profile("z450");
  header.grid = header.profile.grid({});
  header.box.size_px = {width, height, layers};

  auto job = JobWriter::create(words[1], binderjet::to_text(header));
  std::mt19937 random(1);  // the same job in every run
  for (int layer = 0; job && layer < layers; ++layer) {
    const auto done =
        job->append(encode_record(RecordKind::kMask, layer, noise(width, height, random)));
    if (!done) job = tl::unexpected(done.error());
  }
  const auto done = job ? job->finish() : binderjet::Result<void>(tl::unexpected(job.error()));
  if (!done) {
    std::fprintf(stderr, "%s\n", done.error().what.c_str());
    return 5;
  }
  return 0;
}
