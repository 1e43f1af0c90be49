// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/calibrate_gauges.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "driver/base/files.h"
#include "driver/base/json_text.h"
#include "driver/profile/profile.h"
#include "driver/profile/write_profile.h"
#include "driver/report/gauge_report.h"
#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

std::string slots_profile(const Profile& declared, const SlotFindings& found,
                          const GaugeTable& table) {
  const Explanation& first = found.explanations.front();
  std::vector<std::string> notes = {
      fmt::format("Calibrated by binderjet {} from {} ({}); declared: {} ({}).", BINDERJET_VERSION,
                  fs::path(table.path).filename().string(), file_hash(table.path), declared.name,
                  text_hash(declared.text)),
      fmt::format(
          "{}: {}; all gauges agree from {:.2f} to {:.2f}. rms {:.2f} mm before, {:.2f} after "
          "({:.2f} where each gauge is predicted from the others).",
          first.kind, first.text, first.low, first.high, found.declared_rms_mm, first.rms_mm,
          first.heldout_rms_mm)};
  for (std::size_t i = 1; i < found.explanations.size(); ++i) {
    const Explanation& rival = found.explanations[i];
    if (!rival.agrees) continue;
    notes.push_back(fmt::format("Could as well be {}: {} ({:.2f} to {:.2f} times).", rival.kind,
                                rival.text, rival.low, rival.high));
  }
  for (const std::string wanted : {"wall", "outer width"}) {
    const auto d =
        std::find_if(found.discriminators.begin(), found.discriminators.end(),
                     [&](const Discriminator& one) { return one.gauge.rfind(wanted, 0) == 0; });
    if (d == found.discriminators.end()) continue;
    notes.push_back(fmt::format("To tell: a print's {} is {:.2f} mm here, {:.2f} mm there.",
                                d->gauge, d->predicted_mm[0], d->predicted_mm[1]));
  }
  return calibrated_profile(
      declared, declared.name + " calibrated",
      declared.source + "; calibrated on " + fs::path(table.path).filename().string(), notes,
      first.effects);
}

}  // namespace

void calibrate_gauges(const std::string& profile, const std::string& gauges,
                      const std::string& folder, const Console& console) {
  const Profile declared = load_profile(profile);
  const GaugeTable table = read_gauge_table(gauges);
  const OutputFolder out(folder);
  GaugeSummary summary;
  std::string written;
  std::vector<TextFile> files;
  const Stage stage(console.work(), "tracing gauges");
  if (has_slots(table)) {
    const SlotFindings found =
        trace_slots(read_slots(table), declared.effects, declared.grid(std::nullopt));
    summary = summarize(found, table, declared.effects);
    if (!found.explanations.empty() && found.explanations.front().agrees) {
      written = calibrated_file_name(declared);
      files.push_back({folder + "/" + written, slots_profile(declared, found, table)});
    }
  } else if (has_lengths(table)) {
    summary = summarize(trace_lengths(table, {}), table);
  } else {
    throw Error(ErrorKind::kBadInput, gauges + ":1",
                "has neither nominal_x and meas_x (or y, z), nor gauge, axis and nominal_mm, nor "
                "axis and first_visible_slot_mm_low");
  }
  summary.json["profile"] = nullptr;
  if (!written.empty()) summary.json["profile"] = written;
  summary.json["report"] = "report.html";
  files.push_back({folder + "/report.html", summary.page});
  files.push_back({folder + "/calibration.json", to_json_text(summary.json, 1) + "\n"});
  write_texts(files);
  console.result(summary.json, summary.text +
                                   (written.empty() ? "" : "\nprofile: " + folder + "/" + written) +
                                   "\nreport: " + folder + "/report.html");
}

}  // namespace binderjet
