// SPDX-License-Identifier: GPL-3.0-or-later
// Writing and believing a journal, line by line.
#include "transport/spool/journal.h"

#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "transport/base/bytes.h"

namespace binderjet {
namespace {

constexpr int kVersion = 1;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 26;  // half a million acknowledgements
constexpr std::size_t kChecksumDigits = 16;

std::string to_word(const std::string& text) {
  std::string word;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u <= ' ' || u == '%' || u == 0x7f) {
      word += fmt::format("%{:02X}", u);
    } else {
      word += c;
    }
  }
  return word.empty() ? "%" : word;  // a lone % is the empty text
}

template <class T>
bool parse(std::string_view text, T& value, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc() && end == text.data() + text.size();
}

bool from_word(std::string_view word, std::string& text) {
  text.clear();
  if (word == "%") return true;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] != '%') {
      text += word[i];
      continue;
    }
    unsigned char u = 0;
    if (i + 2 >= word.size() || !parse(word.substr(i + 1, 2), u, 16)) return false;
    text += static_cast<char>(u);
    i += 2;
  }
  return true;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t blank = line.find(' ');
    words.push_back(line.substr(0, blank));
    if (blank == std::string_view::npos) return words;
    line.remove_prefix(blank + 1);
  }
}

// False if the words make no sense where they stand.
bool take_line(const std::vector<std::string_view>& words, JournalState& state) {
  if (!state.started) {
    int version = 0;
    state.started = (words.size() == 5 || words.size() == 7) && words[0] == "start" &&
                    parse(words[1], version) && version == kVersion &&
                    parse(words[2], state.layer_count) && state.layer_count >= 0 &&
                    from_word(words[3], state.name) && from_word(words[4], state.source);
    if (words.size() == 7) {
      state.started =
          state.started && from_word(words[5], state.to) && parse(words[6], state.key, 16);
    }
    return state.started;
  }
  if ((words.size() == 3 || words.size() == 4) && words[0] == "ack") {
    return parse(words[1], state.acknowledged) && parse(words[2], state.bytes) &&
           (words.size() == 3 || parse(words[3], state.digest, 16));
  }
  if (words.size() == 2 && words[0] == "held") return from_word(words[1], state.held);
  if (words.size() == 1 && words[0] == "resumed") {
    state.held.clear();
    return true;
  }
  return false;
}

struct Believed {
  JournalState state;
  std::uint64_t end = 0;
  std::uint64_t checksum = 0;
};

Result<Believed> believe(const File& file, const std::string& path) {
  const Result<std::uint64_t> size = file_bytes(file, path);
  if (!size) return tl::unexpected(size.error());
  if (*size > kMaxBytes) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path, "too long for a journal"});
  }
  std::string text(static_cast<std::size_t>(*size), '\0');
  if (auto read = read_at(file, 0, std::as_writable_bytes(std::span(text)), path); !read) {
    return tl::unexpected(read.error());
  }
  Believed believed;
  while (true) {
    const std::size_t begin = static_cast<std::size_t>(believed.end);
    const std::size_t newline = text.find('\n', begin);
    if (newline == std::string::npos || newline - begin < kChecksumDigits + 1) return believed;
    const std::string_view line(text.data() + begin, newline - begin);
    const std::string_view words = line.substr(0, line.size() - kChecksumDigits - 1);
    std::uint64_t sum = 0;
    JournalState next = believed.state;
    if (line[words.size()] != ' ' || !parse(line.substr(words.size() + 1), sum, 16) ||
        sum != checksum(as_bytes(words), believed.checksum) || !take_line(split(words), next)) {
      return believed;
    }
    believed = {std::move(next), newline + 1, sum};
  }
}

}  // namespace

Result<Journal> Journal::create(const std::string& path, const JournalState& start) {
  Result<File> file = open_file(path, O_RDWR | O_CREAT | O_EXCL);
  if (!file) return tl::unexpected(file.error());
  if (flock(file->fd(), LOCK_EX | LOCK_NB) != 0) {
    return tl::unexpected(system_failure(errno, path, "cannot lock it"));
  }
  Journal journal;
  journal.file_ = std::move(*file);
  journal.path_ = path;
  journal.state_ = start;
  journal.state_.started = true;
  std::string line = fmt::format("start {} {} {} {}", kVersion, start.layer_count,
                                 to_word(start.name), to_word(start.source));
  if (!start.to.empty()) line += fmt::format(" {} {:x}", to_word(start.to), start.key);
  if (auto done = journal.append(line); !done) {
    return tl::unexpected(done.error());
  }
  return journal;
}

Result<std::optional<Journal>> Journal::open(const std::string& path) {
  Result<File> file = open_file(path, O_RDWR);
  if (!file) return tl::unexpected(file.error());
  if (flock(file->fd(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return std::optional<Journal>();
    return tl::unexpected(system_failure(errno, path, "cannot lock it"));
  }
  Result<Believed> believed = believe(*file, path);
  if (!believed) return tl::unexpected(believed.error());
  Journal journal;
  journal.file_ = std::move(*file);
  journal.path_ = path;
  journal.state_ = std::move(believed->state);
  journal.end_ = believed->end;
  journal.checksum_ = believed->checksum;
  return std::optional<Journal>(std::move(journal));
}

Result<JournalState> Journal::peek(const std::string& path) {
  const Result<File> file = open_file(path, O_RDONLY);
  if (!file) return tl::unexpected(file.error());
  Result<Believed> believed = believe(*file, path);
  if (!believed) return tl::unexpected(believed.error());
  return std::move(believed->state);
}

Result<void> Journal::append(const std::string& words) {
  // What an earlier write left torn would hide every line behind it.
  if (ftruncate(file_.fd(), static_cast<off_t>(end_)) != 0 ||
      lseek(file_.fd(), static_cast<off_t>(end_), SEEK_SET) < 0) {
    return tl::unexpected(system_failure(errno, path_, "cannot cut it to its right lines"));
  }
  const std::uint64_t sum = checksum(as_bytes(words), checksum_);
  const std::string line = fmt::format("{} {:016x}\n", words, sum);
  if (auto done = write_all(file_, as_bytes(line), path_); !done) return done;
  if (auto done = sync_file(file_, path_); !done) return done;
  end_ += line.size();
  checksum_ = sum;
  return {};
}

Result<void> Journal::acknowledge(int layers, std::uint64_t bytes) {
  auto done = append(fmt::format("ack {} {}", layers, bytes));
  if (done) {
    state_.acknowledged = layers;
    state_.bytes = bytes;
  }
  return done;
}

Result<void> Journal::acknowledge(int layers, std::uint64_t bytes, std::uint64_t digest) {
  auto done = append(fmt::format("ack {} {} {:x}", layers, bytes, digest));
  if (done) {
    state_.acknowledged = layers;
    state_.bytes = bytes;
    state_.digest = digest;
  }
  return done;
}

Result<void> Journal::held(const std::string& reason) {
  auto done = append("held " + to_word(reason));
  if (done) state_.held = reason;
  return done;
}

Result<void> Journal::resumed() {
  auto done = append("resumed");
  if (done) state_.held.clear();
  return done;
}

}  // namespace binderjet
