// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/files.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/base/plain_file.h"
#include "slicer/base/whole_file.h"

namespace binderjet {
namespace {

template <class Take>
void for_each_piece(const std::string& path, Take take) {
  demand_plain_file(path);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::vector<char> piece(1 << 20);
  while (file) {
    const std::size_t got = std::fread(piece.data(), 1, piece.size(), file.get());
    take(piece.data(), got);
    if (got == piece.size()) continue;
    if (std::ferror(file.get()) == 0) return;
    break;
  }
  throw Error(ErrorKind::kBadInput, path, std::string("cannot read: ") + std::strerror(errno));
}

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace

std::string read_text(const std::string& path) {
  std::string text;
  for_each_piece(path, [&](const char* bytes, std::size_t size) { text.append(bytes, size); });
  return text;
}

void write_text(const std::string& path, const std::string& text) { write_texts({{path, text}}); }

void write_texts(const std::vector<TextFile>& files) {
  std::vector<GiveName> written;
  for (const TextFile& file : files) written.push_back(write_unnamed(file));
  for (const GiveName& give_name : written) give_name();
}

GiveName write_unnamed(const TextFile& file) {
  const auto written = std::make_shared<WholeFile>(file.path);
  write_file(written->part(), std::as_bytes(std::span(file.text)));
  return [written] { written->keep(); };
}

Fingerprint::Fingerprint() : state_(XXH3_createState(), XXH3_freeState) {
  XXH3_64bits_reset(state_.get());
}

void Fingerprint::add(std::span<const std::byte> bytes) {
  XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
}

std::string Fingerprint::text() const { return hex(XXH3_64bits_digest(state_.get())); }

std::string file_hash(const std::string& path) {
  Fingerprint print;
  for_each_piece(path, [&](const char* bytes, std::size_t size) {
    print.add(std::as_bytes(std::span(bytes, size)));
  });
  return print.text();
}

std::string text_hash(const std::string& text) {
  return hex(XXH3_64bits(text.data(), text.size()));
}

}  // namespace binderjet
