// SPDX-License-Identifier: GPL-3.0-or-later
// Every input of the corpus, and cuts and flipped bits of it, go through its fuzz target.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/fuzz/targets.h"
#include "tests/transport/sample_job.h"

namespace binderjet {
namespace {

struct Target {
  const char* name;
  void (*run)(const std::uint8_t*, std::size_t);
  std::size_t step = 1;  // of the cuts and flipped bits, where each costs a file
};

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, BreaksNoDecoder) {
  int inputs = 0;
  const std::string folder =
      std::string(BINDERJET_SOURCE_DIR "/tests/fuzz/corpus/") + GetParam().name;
  for (const std::string& name : names_in(folder)) {
    std::string text = file_text(folder + "/" + name);
    const auto run = [&text](std::size_t size) {
      // A copy of the exact size, so that a sanitizer sees one byte too many.
      const std::vector<std::uint8_t> bytes(text.begin(),
                                            text.begin() + static_cast<std::ptrdiff_t>(size));
      GetParam().run(bytes.data(), bytes.size());
    };
    run(text.size());
    for (std::size_t size = 0; size <= text.size(); size += GetParam().step) run(size);
    for (std::size_t bit = 0; bit < 8 * text.size(); bit += GetParam().step) {
      text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << bit % 8));
      run(text.size());
      text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << bit % 8));
    }
    ++inputs;
  }
  EXPECT_GT(inputs, 0) << folder;
}

INSTANTIATE_TEST_SUITE_P(
    Fuzz, Corpus,
    testing::Values(Target{"frames", fuzz_frames}, Target{"messages", fuzz_messages},
                    Target{"usb_texts", fuzz_usb_texts}, Target{"records", fuzz_records},
                    Target{"printer", fuzz_printer}, Target{"stl", fuzz_stl, 5},
                    Target{"ply", fuzz_ply, 5}, Target{"obj", fuzz_obj, 5},
                    Target{"off", fuzz_off, 3}, Target{"wrl", fuzz_wrl, 13},
                    Target{"3mf", fuzz_3mf, 41}, Target{"gltf", fuzz_gltf, 13},
                    Target{"profile", fuzz_profile, 5}, Target{"job", fuzz_job, 7},
                    Target{"stack", fuzz_stack, 3}, Target{"gauges", fuzz_gauges, 3}),
    [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace binderjet
