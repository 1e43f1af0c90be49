// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/gauge_report.h"

#include "driver/base/html.h"

namespace binderjet {

std::string gauge_page(std::string body, const GaugeTable& table) {
  std::string remarks;
  for (const std::string& remark : table.remarks) remarks += html::note(remark);
  body += html::section("Where the readings come from",
                        remarks + html::note("binderjet " BINDERJET_VERSION));
  return html::page("Calibration from gauges", body);
}

}  // namespace binderjet
