// SPDX-License-Identifier: GPL-3.0-or-later
// A disk that fills up, or that may not be written, in the middle of every verb that writes.
#include <cstdint>
#include <random>

#include "tests/trust/writing_verbs.h"

namespace binderjet::trust {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class Disk : public WritingVerbs {};

// As a tmpfs counts: whole pages of files.
std::uintmax_t bytes_in(const std::string& folder) {
  constexpr std::uintmax_t kPage = 4096;
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += (entry.file_size() + kPage - 1) / kPage * kPage;
  }
  return bytes;
}

TEST_F(Disk, ThatFillsUpEndsEveryVerbInStatus5AndKeepsNothingHalfWritten) {
  const unsigned seed = std::random_device()();
  std::cout << "seed " << seed << '\n';
  std::mt19937 random(seed);
  for (const Verb& verb : writing_verbs()) {
    SCOPED_TRACE(verb.name);
    const std::string whole = folder("whole-" + verb.name);
    const Ran unhindered = place_.run(words(verb, whole));
    ASSERT_EQ(unhindered.status, 0) << unhindered.err;
    const std::uintmax_t needed = bytes_in(whole);
    const double share = std::uniform_real_distribution(0.05, 0.9)(random);
    // A part of a page is a page.
    const auto room = static_cast<std::uintmax_t>(share * static_cast<double>(needed - 4096)) + 1;
    SCOPED_TRACE(std::to_string(room) + " bytes of " + std::to_string(needed));
    const SmallDisk disk(folder("disk"), room);
    if (!disk.mounted()) GTEST_SKIP() << "a small disk needs the right to mount one";
    const Ran ran = place_.run(words(verb, disk.folder()));
    EXPECT_EQ(ran.status, 5) << ran.err;
    EXPECT_EQ(error_lines(ran.err), 1) << ran.err;
    EXPECT_THAT(left_behind(disk.folder()), IsEmpty());
  }
}

TEST_F(Disk, ThatIsWriteProtectedIsNamedInOneLine) {
  for (const Verb& verb : writing_verbs()) {
    SCOPED_TRACE(verb.name);
    const SmallDisk disk(folder("disk"), 1 << 20);
    if (!disk.mounted() || !disk.write_protect()) {
      GTEST_SKIP() << "a write-protected disk needs the right to mount one";
    }
    const Ran ran = place_.run(words(verb, disk.folder()));
    EXPECT_TRUE(ran.status == 3 || ran.status == 4) << ran.status;
    EXPECT_EQ(error_lines(ran.err), 1) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(disk.folder()));
    EXPECT_THAT(ran.err, HasSubstr("Read-only file system"));
  }
}

}  // namespace
}  // namespace binderjet::trust
