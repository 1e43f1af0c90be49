// SPDX-License-Identifier: GPL-3.0-or-later
// The installed udev rule gives the printer to group lp, and only the printer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <umockdev.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "tests/transport/sample_job.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> piece{};
  while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), pipe)) {
    text.append(piece.data(), got);
  }
  pclose(pipe);
  return text;
}

TEST(Install, PutsTheRuleAndTheQuirkWhereTheSystemLooks) {
  const TempFolder root;
  const std::string install = "DESTDIR=" + root.path() + " cmake --install " BINDERJET_BUILD_DIR;
  const std::string said = output_of(install);
  EXPECT_EQ(file_text(root / (BINDERJET_UDEV_RULES_DIR "/60-binderjet.rules")),
            file_text(BINDERJET_SOURCE_DIR "/udev/60-binderjet.rules"))
      << said;
  EXPECT_THAT(file_text(root / (BINDERJET_CUPS_DIR "/binderjet.usb-quirks")),
              HasSubstr("\n0x1209 0x0001 blacklist\n"));
}

// What udev makes of a device with these ids and interfaces.
std::string udev_says(const std::string& vendor, const std::string& product,
                      const std::string& interfaces) {
  // udev remembers the tags of a device from one event to the next, by its number: this one is
  // nobody's.
  std::error_code none;
  std::filesystem::remove("/run/udev/data/c189:1048575", none);
  UMockdevTestbed* testbed = umockdev_testbed_new();
  const std::string text =
      "P: /devices/usb1/1-1\nN: bus/usb/001/002\n"
      "E: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\n"
      "E: ID_USB_INTERFACES=" +
      interfaces +
      "\n"
      "E: MAJOR=189\nE: MINOR=1048575\nA: idVendor=" +
      vendor + "\\n\nA: idProduct=" + product + "\\n\n";
  GError* error = nullptr;
  EXPECT_TRUE(umockdev_testbed_add_from_string(testbed, text.c_str(), &error));
  setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
  const std::string said = output_of("udevadm test --action=add /devices/usb1/1-1");
  unsetenv("LD_PRELOAD");
  g_object_unref(testbed);
  return said;
}

TEST(UdevRule, GivesThePrinterToGroupLpAndNothingElse) {
  // udev reads rules in /run; only root can put one there.
  const std::string rule = "/run/udev/rules.d/60-binderjet.rules";
  std::error_code error;
  std::filesystem::create_directories("/run/udev/rules.d", error);
  std::filesystem::copy_file(BINDERJET_SOURCE_DIR "/udev/60-binderjet.rules", rule,
                             std::filesystem::copy_options::overwrite_existing, error);
  if (error) GTEST_SKIP() << "needs to put a rule into /run/udev/rules.d";
  const std::string printer = udev_says("1209", "0001", ":070102:");
  const std::string mouse = udev_says("046d", "0001", ":030102:");
  std::filesystem::remove(rule, error);
  EXPECT_THAT(printer, HasSubstr("60-binderjet.rules"));
  EXPECT_THAT(printer, testing::Not(HasSubstr("Unknown")));
  // Nobody gets it for sitting at the screen: that is a tag, which the system's rules set by
  // others.
  EXPECT_THAT(printer, testing::Not(testing::ContainsRegex("TAGS=[^\n]*uaccess")));
  EXPECT_THAT(printer, testing::Not(HasSubstr("'uaccess'")));
  EXPECT_THAT(printer, testing::ContainsRegex("60-binderjet.rules:[0-9]+ GROUP"));
  EXPECT_THAT(printer, testing::ContainsRegex("60-binderjet.rules:[0-9]+ MODE 0660"));
  EXPECT_THAT(mouse, testing::Not(testing::ContainsRegex("60-binderjet.rules:[0-9]+ GROUP")));
}

}  // namespace
}  // namespace binderjet
