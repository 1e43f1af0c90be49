// SPDX-License-Identifier: GPL-3.0-or-later
// ZIP archives: made of texts, and read with minizip's own reader.
#pragma once

#include <gtest/gtest.h>
#include <minizip/unzip.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slicer/stack/zip_writer.h"

namespace binderjet {

struct ArchiveEntry {
  std::string name;
  std::string bytes;
  bool stored = false;  // without compression

  std::span<const std::byte> data() const { return std::as_bytes(std::span(bytes)); }
};

struct Archive {
  std::vector<ArchiveEntry> entries;  // in the order of the file

  explicit Archive(const std::string& path) {
    const unzFile file = unzOpen64(path.c_str());
    if (file == nullptr) {
      ADD_FAILURE() << path << " is no archive";
      return;
    }
    for (int answer = unzGoToFirstFile(file); answer == UNZ_OK; answer = unzGoToNextFile(file)) {
      unz_file_info64 info{};
      std::array<char, 256> name{};
      unzGetCurrentFileInfo64(file, &info, name.data(), name.size(), nullptr, 0, nullptr, 0);
      std::string bytes(info.uncompressed_size, '\0');
      EXPECT_EQ(unzOpenCurrentFile(file), UNZ_OK);
      EXPECT_EQ(unzReadCurrentFile(file, bytes.data(), static_cast<unsigned>(bytes.size())),
                static_cast<int>(bytes.size()));
      EXPECT_EQ(unzCloseCurrentFile(file), UNZ_OK) << name.data();  // the checksum
      entries.push_back({name.data(), bytes, info.compression_method == 0});
    }
    unzClose(file);
  }

  bool has(const std::string& name) const { return find(name) != entries.end(); }
  const ArchiveEntry& at(const std::string& name) const {
    static const ArchiveEntry none;
    if (has(name)) return *find(name);
    ADD_FAILURE() << "no entry " << name;
    return none;
  }

 private:
  std::vector<ArchiveEntry>::const_iterator find(const std::string& name) const {
    return std::find_if(entries.begin(), entries.end(),
                        [&](const ArchiveEntry& entry) { return entry.name == name; });
  }
};

// The bytes of an archive with these entries.
inline std::string archive_bytes(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string name = (std::filesystem::temp_directory_path() / "binderjet-zip-XXXXXX").string();
  close(mkstemp(name.data()));
  ZipWriter zip(name);
  for (const auto& [entry, text] : entries) zip.add(entry, text);
  zip.finish();
  std::ifstream file(name, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(name);
  return bytes;
}

}  // namespace binderjet
