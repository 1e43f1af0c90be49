// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/zip_writer.h"

#include <minizip/zip.h>

#include <cassert>
#include <utility>

#include "slicer/base/whole_file.h"

namespace binderjet {

struct ZipWriter::State {
  explicit State(const std::string& path)
      : out(path), zip(zipOpen64(out.part().c_str(), APPEND_STATUS_CREATE)) {
    if (zip == nullptr) fail_to_write(path);
  }
  ~State() {
    if (zip != nullptr) zipClose(zip, nullptr);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  void demand(int answer) const {
    if (answer != ZIP_OK) fail_to_write(out.path());
  }

  WholeFile out;
  zipFile zip;
};

ZipWriter::ZipWriter(const std::string& path) : state_(std::make_unique<State>(path)) {}

ZipWriter::~ZipWriter() = default;

void ZipWriter::add(const std::string& name, std::span<const std::byte> bytes) {
  assert(bytes.size() < 0xffffffffU);
  zip_fileinfo info{};
  info.dosDate = 1U << 21 | 1U << 16;  // 1 January 1980, where ZIP's time begins
  constexpr int kStored = 0;
  state_->demand(zipOpenNewFileInZip64(state_->zip, name.c_str(), &info, nullptr, 0, nullptr, 0,
                                       nullptr, kStored, 0, 0));
  state_->demand(
      zipWriteInFileInZip(state_->zip, bytes.data(), static_cast<unsigned>(bytes.size())));
  state_->demand(zipCloseFileInZip(state_->zip));
}

void ZipWriter::add(const std::string& name, std::string_view text) {
  add(name, std::as_bytes(std::span(text)));
}

void ZipWriter::complete() {
  state_->demand(zipClose(std::exchange(state_->zip, nullptr), nullptr));
}

void ZipWriter::finish() {
  if (state_->zip != nullptr) complete();
  state_->out.keep();
}

}  // namespace binderjet
