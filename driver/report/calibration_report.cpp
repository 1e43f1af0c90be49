// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "driver/base/html.h"
#include "driver/export/layer_pictures.h"
#include "driver/job/print_colors.h"

namespace binderjet {
namespace {

using html::Series;

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

std::string numbers_text(const std::map<std::string, std::vector<double>>& numbers) {
  std::string text;
  for (const auto& [name, values] : numbers) {
    std::vector<std::string> rounded;
    for (const double value : values) rounded.push_back(fmt::format("{:.4g}", value));
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, fmt::join(rounded, " "));
  }
  return text;
}

std::string readable(std::string kind) {
  std::replace(kind.begin(), kind.end(), '_', ' ');
  return kind;
}

std::string name_of(const FoundEffect& effect) {
  std::string name = effect.named
                         ? readable(effect.kind)
                         : "one without a name, which follows " + text_of(effect.covariate);
  if (effect.rivals.empty()) return name;
  for (const std::string& rival : effect.rivals) name += " or " + readable(rival);
  return name + " (this print cannot tell)";
}

std::string text_of(const EffectSpec& effect) {
  std::string text = readable(effect.kind);
  for (const auto& [name, word] : effect.words) text += ", " + word;
  const std::string numbers = numbers_text(effect.numbers);
  return numbers.empty() ? text : text + ": " + numbers;
}

std::string verdict(const Calibration& calibration) {
  std::string text;
  if (calibration.verdict == Verdict::kNone) {
    text = "The print is what the declared model says, as far as this measurement can tell.";
  } else if (calibration.verdict == Verdict::kUnexplained) {
    text = "The print differs from the declared model, and nothing that was tried explains it.";
  } else {
    std::vector<std::string> names;
    for (const FoundEffect& effect : calibration.effects) names.push_back(name_of(effect));
    text = fmt::format("The declared model lacks {}: {}.",
                       names.size() == 1 ? "one effect" : fmt::format("{} effects", names.size()),
                       fmt::join(names, "; "));
  }
  if (calibration.scores.empty()) return text;
  const BeforeAfter& first = calibration.scores.front();
  text += fmt::format(" On {}, wrong voxels {} {} to {}", first.name,
                      first.after.wrong < first.before.wrong ? "fall from" : "go from",
                      percent(first.before.wrong), percent(first.after.wrong));
  if (first.floor) {
    text += fmt::format("; two prints of the same job differ by {}", percent(first.floor->wrong));
  }
  return text + ".";
}

using html::note;
using html::section;

std::string scores_section(const Calibration& calibration) {
  std::vector<html::BarGroup> wrong;
  std::vector<html::BarGroup> edges;
  for (const BeforeAfter& score : calibration.scores) {
    html::BarGroup a{score.name, {}};
    html::BarGroup b{score.name, {}};
    const auto add = [&](Series series, const PrintError& error) {
      a.bars.push_back({series, error.wrong, percent(error.wrong)});
      b.bars.push_back({series, error.mean_mm, fmt::format("{:.4f} mm", error.mean_mm)});
    };
    add(Series::kBefore, score.before);
    add(Series::kAfter, score.after);
    if (score.floor) add(Series::kFloor, *score.floor);
    wrong.push_back(std::move(a));
    edges.push_back(std::move(b));
  }
  return section("The error, before and after",
                 html::legend({{Series::kBefore, "declared model"},
                               {Series::kAfter, "calibrated model"},
                               {Series::kFloor, "one print against another (the floor)"}}) +
                     "<h2>Wrong voxels, share of the solid ones</h2>\n" + html::bars(wrong) +
                     "<h2>Edges off, mean</h2>\n" + html::bars(edges) +
                     note("Both models predict the same data, which the fit did not see."));
}

std::string swatch(const Rgb& color, const std::string& text) {
  return fmt::format(
      "<span class=\"key\"><i class=\"swatch\" style=\"background: rgb({}, {}, {})\"></i>{}</span>",
      color[0], color[1], color[2], html::escaped(text));
}

std::string pictures_section(const Calibration& calibration, const MeasuredJob& job) {
  const LayerPictures pictures =
      picture_layer(job, calibration.before_model, calibration.after_model);
  const auto one = [&](const std::vector<std::byte>& png, const std::string& caption) {
    return html::picture(png, pictures.width_mm, pictures.height_mm, caption);
  };
  return section(fmt::format("Layer {}, where the change shows most", pictures.layer),
                 "<div class=\"row\">\n" +
                     one(pictures.before,
                         "Against the declared model: wrong " + percent(pictures.wrong_before)) +
                     one(pictures.after,
                         "Against the calibrated model: wrong " + percent(pictures.wrong_after)) +
                     "</div>\n<p class=\"note\">" + swatch(kCorrectColor, "printed as predicted") +
                     swatch(kMissingColor, "missing: predicted, not printed") +
                     swatch(kExtraColor, "extra: printed, not predicted") + "</p>\n" +
                     note("x to the right, y down, as in the stack's images."));
}

std::string profiles_section(const Calibration& calibration) {
  std::string charts;
  for (const ResidualProfile& profile : calibration.profiles) {
    charts +=
        html::lines("by " + readable(profile.name),
                    profile.unit.empty() ? readable(profile.name) : profile.unit, "residual, mm",
                    profile.centers,
                    {{Series::kBefore, profile.before_mm}, {Series::kAfter, profile.after_mm}});
  }
  return section("What the residual follows",
                 note("How much further out the surface lies than predicted. A flat line at 0 is a "
                      "model that misses nothing along this axis.") +
                     "<div class=\"charts\">\n" + charts + "</div>\n");
}

std::string remaining_section(const Calibration& calibration) {
  if (!calibration.remaining)
    return section("What remains", note("Nothing that could be told from noise."));
  return section("What remains", note(fmt::format("{:.0f} % of what is left follows {}.",
                                                  100 * calibration.remaining->share,
                                                  text_of(calibration.remaining->covariate))));
}

std::string measured_section(const MeasuredJob& job) {
  double height_mm = job.layers() * job.grid.pitch_mm[2];
  std::string text = fmt::format(
      "{}: {} layers, {:.1f} x {:.1f} x {:.1f} mm, measured on {} print{}, compared at voxels of "
      "{:.4f} x {:.4f} mm.",
      job.name, job.layers(), job.place.size_mm[0], job.place.size_mm[1], height_mm,
      job.prints.size(), job.prints.size() == 1 ? "" : "s", job.grid.voxel_mm(0),
      job.grid.voxel_mm(1));
  if (job.scanned) {
    text += " They are scans: what is left of their shift, turn and blur is fitted along.";
  }
  return section("What was measured", "<p>" + html::escaped(text) + "</p>\n");
}

}  // namespace

std::string text_of(const Covariate& covariate) {
  if (covariate.axis == Covariate::Axis::kNone) return "everywhere alike";
  std::string text = readable(word(covariate.axis));
  if (covariate.form != Covariate::Form::kConstant) text += ", " + word(covariate.form);
  const std::string numbers = numbers_text(covariate.numbers);
  return numbers.empty() ? text : text + " (" + numbers + ")";
}

std::string effects_table(const std::vector<FoundEffect>& effects) {
  std::vector<std::vector<std::string>> rows = {
      {"effect", "it follows", "parameters", "could also be", "p", "held-out gain"}};
  for (const FoundEffect& effect : effects) {
    std::vector<std::string> rivals;
    for (const std::string& rival : effect.rivals) rivals.push_back(readable(rival));
    constexpr std::size_t kMaxNumbers = 8;  // more are for a list of their own
    rows.push_back({readable(effect.kind), text_of(effect.covariate),
                    effect.parameters.size() <= kMaxNumbers
                        ? numbers_text(effect.parameters)
                        : fmt::format("{} numbers", effect.parameters.size()),
                    rivals.empty() ? "-" : fmt::format("{}", fmt::join(rivals, ", ")),
                    effect.p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", effect.p),
                    fmt::format("{:.0f} %", 100 * effect.heldout_gain)});
  }
  return html::table(rows, 4);
}

std::string models_table(const std::vector<EffectSpec>& before,
                         const std::vector<EffectSpec>& after) {
  std::vector<std::vector<std::string>> rows = {{"declared model", "calibrated model"}};
  for (std::size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
    rows.push_back(
        {i < before.size() ? text_of(before[i]) : "", i < after.size() ? text_of(after[i]) : ""});
  }
  return html::table(rows, 2);
}

std::string calibration_report(const Calibration& calibration, const MeasuredJob& job,
                               const std::string& title) {
  std::string body = fmt::format("<h1>{}</h1>\n<section><p class=\"verdict\">{}</p></section>\n",
                                 html::escaped(title), html::escaped(verdict(calibration)));
  body += measured_section(job);
  if (!calibration.scores.empty()) body += scores_section(calibration);
  if (!calibration.effects.empty()) {
    body +=
        section("What the model lacked",
                effects_table(calibration.effects) +
                    note("p: how often this much would be found in a print without any effect, "
                         "over all that was tried. Held-out gain: share of the residual gone in "
                         "data that the fit did not see. What could also be it explains this "
                         "print as well."));
  }
  if (!job.prints.empty() && job.layers() > 0) body += pictures_section(calibration, job);
  if (!calibration.profiles.empty()) body += profiles_section(calibration);
  body += remaining_section(calibration);
  body += section("The models", models_table(calibration.before_model, calibration.after_model) +
                                    note("binderjet " BINDERJET_VERSION));
  return html::page(title, body);
}

}  // namespace binderjet
