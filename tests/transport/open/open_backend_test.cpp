// SPDX-License-Identifier: GPL-3.0-or-later
// The table of schemes is all that there is to know of them.
#include "transport/open/open_backend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace binderjet {
namespace {

using testing::HasSubstr;

TEST(Schemes, AreChosenByTheWordBeforeTheColon) {
  for (const Scheme& scheme : schemes()) {
    SCOPED_TRACE(scheme.name);
    for (const std::string& form : scheme.forms) EXPECT_EQ(find_scheme(form), &scheme);
  }
  EXPECT_EQ(find_scheme("ftp://a"), nullptr);
  EXPECT_EQ(find_scheme("usb"), nullptr);
}

TEST(Schemes, AreWhatHelpAndErrorsName) {
  EXPECT_EQ(scheme_forms(), "usb:, usb://VID:PID/SERIAL, emulator:DIR, spool:DIR or file:PATH");
  EXPECT_EQ(scheme_forms(true), "usb:, usb://VID:PID/SERIAL, emulator:DIR or spool:DIR");
  EXPECT_THAT(open_backend("ftp://a").error().what, HasSubstr(scheme_forms()));
  EXPECT_EQ(open_backend("spool:").error().kind, FailureKind::kBadInput);
}

}  // namespace
}  // namespace binderjet
