// SPDX-License-Identifier: GPL-3.0-or-later
// What the transport tests share: a folder that goes away, small jobs, random numbers whose seed is
// printed.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "transport/job/job_file.h"

namespace binderjet {

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "binderjet-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// BINDERJET_SEED repeats a run.
inline std::mt19937_64 seeded_random() {
  const char* fixed = std::getenv("BINDERJET_SEED");
  const auto seed = fixed != nullptr ? std::strtoull(fixed, nullptr, 10) : std::random_device{}();
  std::printf("seed: BINDERJET_SEED=%llu\n", static_cast<unsigned long long>(seed));
  return std::mt19937_64(seed);
}

inline std::size_t random_below(std::mt19937_64& random, std::size_t bound) {
  return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
}

// Every layer differs, compresses somewhat, and is the same in every run.
inline std::vector<std::byte> sample_payload(RecordKind kind, int layer) {
  std::minstd_rand random(static_cast<unsigned>(layer) * 8 + static_cast<unsigned>(kind));
  std::vector<std::byte> payload(300 + random() % 400);
  for (std::size_t i = 0; i < payload.size(); ++i) {
    payload[i] = i % 3 == 0 ? static_cast<std::byte>(random()) : std::byte{0};
  }
  return payload;
}

// Color is optional: a part without it has masks alone.
inline std::vector<std::byte> sample_records(int layer, bool color = true) {
  std::vector<std::byte> records =
      encode_record(RecordKind::kMask, layer, sample_payload(RecordKind::kMask, layer));
  if (color) {
    const auto more =
        encode_record(RecordKind::kColor, layer, sample_payload(RecordKind::kColor, layer));
    records.insert(records.end(), more.begin(), more.end());
  }
  return records;
}

inline constexpr const char* kSampleHeader = R"({"format": "job", "size_px": [64, 64, 40]})";

inline void write_sample_job(const std::string& path, int first, int end,
                             const std::string& header = kSampleHeader, bool color = true) {
  auto writer = JobWriter::create(path, header);
  ASSERT_TRUE(writer) << writer.error().what;
  for (int layer = first; layer < end; ++layer) {
    ASSERT_TRUE(writer->append(sample_records(layer, color)));
  }
  const auto done = writer->finish();
  ASSERT_TRUE(done) << done.error().what;
}

inline constexpr int kPrintLayers = 40;

// The sample job's records with masks of their header's size, 64 x 64 pixels.
inline std::vector<std::byte> print_records(int layer) {
  std::vector<std::byte> mask(8 * 64);
  std::minstd_rand random(static_cast<unsigned>(layer) + 1);
  for (std::byte& byte : mask) byte = static_cast<std::byte>(random() >> 8);
  return encode_record(RecordKind::kMask, layer, mask);
}

inline std::vector<std::vector<std::byte>> whole_print() {
  std::vector<std::vector<std::byte>> layers;
  for (int layer = 0; layer < kPrintLayers; ++layer) layers.push_back(print_records(layer));
  return layers;
}

inline std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary)
      .write(text.data(), static_cast<std::streamsize>(text.size()));
}

inline std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace binderjet
