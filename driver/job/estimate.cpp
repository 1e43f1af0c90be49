// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/estimate.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace binderjet {
namespace {

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string hours_and_minutes(double minutes) {
  const long whole = std::lround(minutes);
  return whole < 60 ? fmt::format("{} min", whole)
                    : fmt::format("{} h {:02} min", whole / 60, whole % 60);
}

}  // namespace

Estimate estimate_of(const JobHeader& header, const Totals& totals) {
  const Profile& profile = header.profile;
  const double rate = (profile.layers_per_minute[0] + profile.layers_per_minute[1]) / 2;
  const auto& pitch = header.grid.pitch_mm;
  constexpr double kMm3PerMl = 1000;
  Estimate estimate;
  estimate.print_minutes = header.layers() / rate + profile.dry_minutes;
  estimate.powder_ml =
      static_cast<double>(totals.mask_px) * pitch[0] * pitch[1] * pitch[2] / kMm3PerMl;
  estimate.binder_ml = estimate.powder_ml * profile.binder_per_powder;
  return estimate;
}

std::string text_of(const Estimate& estimate, const JobHeader& header) {
  const Profile& profile = header.profile;
  return fmt::format(
      "printing takes about {} ({:g} to {:g} layers a minute, {} to dry), "
      "about {:.1f} ml of binder for {:.1f} ml of powder",
      hours_and_minutes(estimate.print_minutes), profile.layers_per_minute[0],
      profile.layers_per_minute[1], hours_and_minutes(profile.dry_minutes), estimate.binder_ml,
      estimate.powder_ml);
}

void report(const JobHeader& header, const Totals& totals, const std::string& out,
            std::vector<std::string> warnings, const Console& console) {
  const std::string changed = rule_warning(totals.rules, header.profile.mask);
  if (!changed.empty()) {
    console.warning(changed);
    warnings.push_back(changed);
  }
  const Estimate estimate = estimate_of(header, totals);
  const nlohmann::ordered_json json = {{"job", out},
                                       {"layers", totals.layers},
                                       {"kept_layers", totals.kept},
                                       {"size_px", header.box.size_px},
                                       {"solid_voxels", totals.target_vx},
                                       {"mask_pixels", totals.mask_px},
                                       {"seconds", totals.seconds},
                                       {"peak_rss_mb", peak_rss_mb()},
                                       {"print_minutes", estimate.print_minutes},
                                       {"binder_ml", estimate.binder_ml},
                                       {"warnings", warnings}};
  console.result(json, fmt::format("{}: {} layers of {} x {} pixels, {:.2f} s\n{}", out,
                                   totals.layers, header.box.size_px[0], header.box.size_px[1],
                                   totals.seconds, text_of(estimate, header)));
}

}  // namespace binderjet
