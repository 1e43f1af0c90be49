// SPDX-License-Identifier: GPL-3.0-or-later
// Every verb that writes, with inputs of its own, for whatever may happen to it in the middle.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet::trust {

// Words with %IN for the folder of inputs and %OUT for an empty folder to write to.
struct Verb {
  std::string name;
  std::vector<std::string> words;
};

inline std::vector<Verb> writing_verbs() {
  const std::string job = "%IN/a.bjob";
  return {
      {"slice", {"slice", "%IN/ball.obj", "-p", "z450", "-o", "%OUT/a.bjob"}},
      {"inverse",
       {"slice", "%IN/ball.obj", "-p", "z450", "--enhance", "inverse", "-o", "%OUT/a.bjob"}},
      {"masks", {"export", job, "-o", "%OUT/stack"}},
      {"color", {"export", job, "-o", "%OUT/stack", "--what", "color"}},
      {"target", {"export", job, "-o", "%OUT/stack", "--what", "target"}},
      {"printed", {"export", job, "-o", "%OUT/stack", "--what", "printed"}},
      {"inks", {"export", job, "-o", "%OUT/inks", "--separate", "cmy"}},
      {"cuberille", {"export", job, "--cuberille", "%OUT/a.ply"}},
      {"html", {"export", job, "--html", "%OUT/a.html"}},
      {"3mf", {"export", job, "--3mf", "%OUT/a.3mf"}},
      {"zip", {"export", job, "--zip", "%OUT/a.zip"}},
      {"simulate", {"simulate", job, "-p", "z450", "-o", "%OUT/printed"}},
      {"map", {"score", job, "--target", "%IN/ball.obj", "--map", "%OUT/map"}},
      {"join", {"join", "%IN/low.bjob", "%IN/high.bjob", "-o", "%OUT/a.bjob"}},
      {"spool", {"print", job, "--to", "spool:%OUT"}},
      {"file", {"print", job, "--to", "file:%OUT/a.bjob"}},
      {"streamed", {"print", "%IN/ball.obj", "-p", "z450", "--to", "spool:%OUT"}},
      {"coupon", {"coupon", "--kind", "golfball", "-o", "%OUT/a.stl"}},
      {"calibrate",
       {"calibrate", "-p", "z450", "--job", "%IN/masks", "--measured", "%IN/print", "-o",
        "%OUT/out"}},
      {"gauges", {"calibrate", "-p", "z450", "--gauges", "%IN/slots.csv", "-o", "%OUT/out"}},
  };
}

// What a verb may leave where it could not finish: folders, of a job on its way to a spool what
// spool.h says, and of a slice what unfinished_slice.h says. Nothing under a final name.
inline std::vector<std::string> left_behind(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    const std::string name = entry.path().string().substr(folder.size() + 1);
    const bool of_a_spool = name == "last-id" || name.starts_with("held/");
    const bool of_a_slice =
        std::regex_match(name, std::regex("a\\.bjob\\.[0-9a-f]{16}\\.(part|totals)"));
    if (!of_a_spool && !of_a_slice) files.push_back(name);
  }
  return files;
}

class WritingVerbs : public testing::Test {
 protected:
  WritingVerbs() {
    const Workplace& in = place_;
    const Mesh ball = models::golf_ball(2.5, 4);
    std::ofstream file(in / "ball.obj");
    for (const Point& p : ball.points) {
      file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << (p[1] < 0 ? " 1 0 0\n" : " 0 0 1\n");
    }
    for (const Triangle& t : ball.triangles) {
      file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
    file.close();
    std::ofstream(in / "slots.csv") << kSlots;
    const std::vector<std::string> slice = {"slice", in / "ball.obj", "-p", "z450", "-q", "-o"};
    const auto run = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
      words.insert(words.end(), more.begin(), more.end());
      const Ran ran = in.run(words);
      ASSERT_EQ(ran.status, 0) << ran.err;
    };
    run(slice, {in / "a.bjob"});
    run(slice, {in / "low.bjob", "--layers", ":20"});
    run(slice, {in / "high.bjob", "--layers", "20:"});
    models::write_obj(models::golf_ball(1.2, 4), in / "small.obj");
    run({"slice", in / "small.obj", "-p", "z450", "-q"}, {"-o", in / "small.bjob"});
    run({"export", in / "small.bjob", "-o", in / "masks"}, {"-q"});
    run({"simulate", in / "masks", "-p", "z450-fig3", "-o", in / "print"}, {"-q"});
  }

  std::vector<std::string> words(const Verb& verb, const std::string& out) const {
    std::vector<std::string> filled;
    for (std::string word : verb.words) {
      for (const auto& [mark, folder] : {std::pair("%IN", place_ / "."), std::pair("%OUT", out)}) {
        const std::size_t at = word.find(mark);
        if (at != std::string::npos) word.replace(at, std::string(mark).size(), folder);
      }
      filled.push_back(word);
    }
    return filled;
  }
  // A new folder.
  std::string folder(const std::string& name) const {
    std::filesystem::create_directories(place_ / name);
    return place_ / name;
  }
  // One line says what is wrong, beside warnings.
  static int error_lines(const std::string& err) {
    int lines = 0;
    for (std::size_t at = err.find("binderjet: "); at != std::string::npos;
         at = err.find("binderjet: ", at + 1)) {
      lines += err.compare(at, 19, "binderjet: warning:") != 0;
    }
    return lines;
  }

  // What a person saw on a print of the slots coupon.
  static constexpr const char* kSlots =
      "axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nx,0.6,0.7\ny,0.3,0.3\nz,0.1,0."
      "1\n";
  Workplace place_;
};

// A disk of so many bytes in a folder; not there where nobody may mount.
class SmallDisk {
 public:
  SmallDisk(const std::string& folder, std::size_t bytes) : folder_(folder) {
    std::filesystem::create_directories(folder_);
    const std::string size = "size=" + std::to_string(bytes);
    mounted_ = mount("tmpfs", folder_.c_str(), "tmpfs", 0, size.c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  bool write_protect() const {
    return mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  bool mounted_ = false;
};

}  // namespace binderjet::trust
