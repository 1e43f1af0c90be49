// SPDX-License-Identifier: GPL-3.0-or-later
// Files that stand under their name whole or not at all.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace binderjet {

// A place beside `path` to write to; keep() gives it its name, and without that it vanishes.
class WholeFile {
 public:
  // Error{kUsage} if something other than a plain file has the name: it would be replaced.
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  // Where to write; no other process writes there.
  const std::string& part() const { return part_; }
  const std::string& path() const { return path_; }
  // Once the disk has it.
  void keep();

 private:
  std::string path_;
  std::string part_;  // empty once kept
};

// A folder to write into, made with its parents. If it is new and nothing comes into it, it goes
// again. Fails as files do.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::string path_;
  bool is_new_;
};

// The temporary names of files and folders under way: a program that must end at once takes them
// along. Who is about to give one its name forgets it first.
void note_unfinished(const std::string& path);
void forget_unfinished(const std::string& path);
// For who ends the process then: whoever is about to give a name waits from here on.
void remove_unfinished();

// errno as the Error of a file that cannot be written: kNoRoom if the disk is full, else kBadInput.
[[noreturn]] void fail_to_write(const std::string& path);

// Waits until the disk has what was written: a file, or a folder's names; the folder that holds
// `path`, after its name has changed. A file system that cannot do the last is left to its ways.
void sync_file(const std::string& path);
void sync_folder_of(const std::string& path);

// Makes a folder and its parents, unless they are there; fails as files do.
void make_folders(const std::string& path);
// Writes the bytes to `path` itself, for a file of a folder that is still under way.
void write_file(const std::string& path, std::span<const std::byte> bytes);
// Writes the file whole or not at all.
void write_whole_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace binderjet
