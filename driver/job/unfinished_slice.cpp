// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/unfinished_slice.h"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>

#include "driver/base/files.h"
#include "driver/base/transport_errors.h"
#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "transport/job/job_scan.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPart = ".part";
constexpr const char* kTotals = ".totals";

// Of all that a slice's layers depend on. The program counts by its bytes: two builds of one
// version may differ.
std::string key_of(const SlicePlan& plan, LayerRange layers) {
  std::string program;
  try {
    program = file_hash("/proc/self/exe");
  } catch (const Error&) {  // the version, in the header, must do
  }
  return text_hash(fmt::format("{}\n{}\n{}\n{}:{}", to_text(plan.header), plan.fingerprint, program,
                               layers.first, layers.last));
}

// A line of the totals, and the layer whose it is.
std::string line_of(int layer, const EncodedLayer& of) {
  return fmt::format("{} {} {} {} {}\n", layer, of.mask_px, of.target_vx,
                     of.rule_changes.islands_erased, of.rule_changes.holes_filled);
}
std::optional<EncodedLayer> parse_line(const std::string& line, int layer) {
  std::istringstream words(line);
  int number = -1;
  EncodedLayer of;
  words >> number >> of.mask_px >> of.target_vx >> of.rule_changes.islands_erased >>
      of.rule_changes.holes_filled;
  if (words.fail() || number != layer || line_of(layer, of) != line + "\n") return std::nullopt;
  return of;
}

// Layers from `first` on of which all that a job needs is there.
int whole_layers(const JobReader& part, int first, bool color) {
  int layer = first;
  while (part.contains(RecordKind::kMask, layer) &&
         (!color || part.contains(RecordKind::kColor, layer))) {
    ++layer;
  }
  return layer - first;
}

bool is_locked(const std::string& stem) {
  const Result<File> totals = open_file(stem + kTotals, O_RDONLY);
  return totals && flock(totals->fd(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

bool is_part(const std::string& path) {
  const Result<File> file = open_file(path, O_RDONLY | O_NOFOLLOW);
  const Result<std::uint64_t> size = file ? file_bytes(*file, path) : tl::unexpected(file.error());
  return size && (*size == 0 || read_job_front(*file, *size, path));
}

bool are_totals(const std::string& path) {
  std::istringstream lines(read_text(path));
  std::string line;
  if (!std::getline(lines, line)) return true;
  int layer = -1;
  std::istringstream(line) >> layer;
  return parse_line(line, layer).has_value();
}

// Somebody's file may be called as ours are; only what begins as ours do is removed. The totals are
// the first to come and the last to go, so that they always tell of a part.
void remove_left(const std::string& stem) {
  std::error_code error;
  if (is_part(stem + kPart)) fs::remove(stem + kPart, error);
  if (!path_exists(stem + kPart) && are_totals(stem + kTotals)) fs::remove(stem + kTotals, error);
}

}  // namespace

UnfinishedSlice::UnfinishedSlice(const std::string& out, const SlicePlan& plan, LayerRange layers,
                                 bool restart, const Console& console)
    : out_(out),
      layers_(layers),
      job_layers_(plan.header.layers()),
      stem_(out + "." + key_of(plan, layers)),
      synced_(Clock::now()) {
  const std::string path = stem_ + kTotals;
  struct stat there = {};
  do {
    totals_file_ = value_or_throw(open_file(path, O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW));
    if (flock(totals_file_.fd(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      throw Error(ErrorKind::kUsage, out,
                  "is being sliced by another process, the same way; wait for it or name another "
                  "output");
    }
    // Who had the lock before may have finished and removed the file that was opened here.
  } while (fstat(totals_file_.fd(), &there) == 0 && there.st_nlink == 0);
  find_others(console);
  const std::string header = to_text(plan.header);
  if (!restart) take_up(header, plan.header.color);
  if (writer_) {
    console.note(
        fmt::format("{}: goes on after layer {} of {}, which an interrupted slice left; "
                    "--restart begins anew",
                    out, rest().first - 1, job_layers_));
    return;
  }
  std::error_code error;
  if (fs::remove(stem_ + kPart, error) && !restart) {
    console.note(out + ": begins anew, for what an interrupted slice left holds no whole layer");
  }
  if (ftruncate(totals_file_.fd(), 0) != 0) {
    throw Error(ErrorKind::kBadInput, path, "cannot be emptied; remove it");
  }
  Result<JobWriter> writer = JobWriter::create_kept(stem_ + kPart, out, header);
  if (!writer) fs::remove(path, error);
  writer_ = value_or_throw(std::move(writer));
  // Before the first layer they are of no use to anybody.
  note_unfinished(stem_ + kPart);
  note_unfinished(path);
  value_or_throw(sync_folder(folder_of(out)));
}

void UnfinishedSlice::take_up(const std::string& header, bool color) {
  const std::string part = stem_ + kPart;
  if (!path_exists(part)) return;
  const Result<JobReader> reader = JobReader::open(part);
  if (!reader || reader->header() != header) return;
  const int in_part = whole_layers(*reader, layers_.first, color);
  std::istringstream lines(read_text(stem_ + kTotals));
  Totals totals;
  off_t counted = 0;  // bytes of the lines that are believed
  std::string line;
  while (totals.layers < std::min(in_part, layers_.size()) && std::getline(lines, line)) {
    const auto layer = parse_line(line, layers_.first + totals.layers);
    if (!layer) break;
    totals.add(*layer);
    counted += static_cast<off_t>(line.size()) + 1;
  }
  if (totals.layers == 0) return;
  const auto last = static_cast<std::uint32_t>(layers_.first + totals.layers - 1);
  const auto end = std::find_if(reader->entries().begin(), reader->entries().end(),
                                [last](const auto& entry) { return entry.layer > last; });
  if (ftruncate(totals_file_.fd(), counted) != 0) return;
  writer_ = value_or_throw(JobWriter::reopen_kept(part, out_, std::prev(end)->end()));
  totals_ = totals;
}

void UnfinishedSlice::find_others(const Console& console) {
  const std::string begin = fs::path(out_).filename().string() + ".";
  std::error_code error;
  for (fs::directory_iterator i(folder_of(out_), error), last; !error && i != last;
       i.increment(error)) {
    const std::string name = i->path().filename().string();
    constexpr std::size_t kDigits = 16;
    if (!name.starts_with(begin) || !name.ends_with(kTotals) ||
        name.size() != begin.size() + kDigits + std::strlen(kTotals) ||
        name.find_first_not_of("0123456789abcdef", begin.size()) != begin.size() + kDigits) {
      continue;
    }
    const std::string stem = out_ + name.substr(begin.size() - 1, kDigits + 1);
    if (stem == stem_ || is_locked(stem)) continue;
    others_.push_back(stem);
    if (!path_exists(stem + kPart)) continue;
    console.note(
        fmt::format("{}{}: begun with another model, profile, option or program, so this "
                    "slice does not go on with it; it is removed once this one is done",
                    stem, kPart));
  }
}

UnfinishedSlice::~UnfinishedSlice() {
  if (!writer_ || totals_.layers > 0) return;
  writer_.reset();
  std::error_code error;
  fs::remove(stem_ + kPart, error);
  fs::remove(stem_ + kTotals, error);
  forget_unfinished(stem_ + kPart);
  forget_unfinished(stem_ + kTotals);
}

void UnfinishedSlice::append(const std::vector<Shared<EncodedLayer>>& next) {
  std::string lines;
  std::vector<std::byte> records;
  int layer = rest().first;
  for (const Shared<EncodedLayer>& each : next) {
    lines += line_of(layer++, *each);
    records.insert(records.end(), each->record.begin(), each->record.end());
  }
  if (totals_.layers == 0) {
    forget_unfinished(stem_ + kPart);
    forget_unfinished(stem_ + kTotals);
  }
  // A layer is whole once its records are, so its line is there before.
  value_or_throw(write_all(totals_file_, std::as_bytes(std::span(lines)), stem_ + kTotals));
  value_or_throw(writer_->append(records));
  for (const Shared<EncodedLayer>& each : next) totals_.add(*each);
  constexpr auto kMostLost = std::chrono::seconds(5);
  if (Clock::now() - synced_ < kMostLost) return;
  value_or_throw(sync_file(totals_file_, stem_ + kTotals));
  value_or_throw(writer_->sync());
  synced_ = Clock::now();
}

void UnfinishedSlice::finish() {
  value_or_throw(writer_->finish());
  std::error_code error;
  fs::remove(stem_ + kTotals, error);
  for (const std::string& other : others_) {
    if (!is_locked(other)) remove_left(other);
  }
}

std::string UnfinishedSlice::kept() const {
  if (totals_.layers == 0 || !path_exists(stem_ + kPart)) return "";
  return fmt::format(
      "; layers {} to {} of {} are kept in {}{}: the same command goes on from there",
      layers_.first, rest().first - 1, job_layers_, stem_, kPart);
}

}  // namespace binderjet
