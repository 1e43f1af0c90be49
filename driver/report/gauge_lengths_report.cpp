// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths: the ladder of models, what each step brings on parts it did not see, and what is left.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "driver/base/html.h"
#include "driver/report/calibration_report.h"
#include "driver/report/gauge_report.h"
#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;
using html::Series;

std::string thousandths(double value) { return fmt::format("{:.3f}", value); }

const Rung* last_accepted(const Ladder& ladder) {
  const Rung* last = nullptr;
  for (const Rung& rung : ladder.rungs) {
    if (rung.accepted) last = &rung;
  }
  return last;
}

// A term that another one took the place of has no columns any more.
bool has_columns(const Rung& rung, const Ladder& ladder) {
  return std::any_of(ladder.columns.begin(), ladder.columns.end(),
                     [&](const auto& column) { return column.term == rung.name; });
}

// Names the kind of effect that would cause the term, and its rivals.
void name_cause(LengthTerm term, FoundEffect& effect) {
  for (const EffectKind& kind : effect_kinds()) {
    for (const LengthCause& cause : kind.length_causes) {
      if (cause.term != term) continue;
      if (cause.named) effect.kind = kind.name;
      if (!cause.named) effect.rivals.push_back(kind.name);
    }
  }
  // Faces that lie further out by the same everywhere: powder binds at a lower dose, or the driver
  // takes too thin a shell off, which is no effect of the printer; lengths alone cannot tell.
  if (term == LengthTerm::kOffset) effect.rivals.emplace_back("bleed_shell");
}

// A term of the ladder as the effect that it is in the catalogue.
FoundEffect effect_of(const Rung& rung, const Ladder& ladder) {
  FoundEffect effect;
  effect.kind = nameless_word();
  const std::optional<LengthTerm> term = length_term(rung);
  effect.named = term.has_value();
  if (term) name_cause(*term, effect);
  if (term == LengthTerm::kLayerShift) {
    effect.covariate = {Covariate::Axis::kLayer, Covariate::Form::kTrend};
  } else if (term == LengthTerm::kBedPlace) {
    effect.covariate = {Covariate::Axis::kPosition, Covariate::Form::kTrend};
  }
  effect.p = rung.p;
  effect.heldout_gain = rung.gain;
  for (std::size_t i = 0; i < ladder.columns.size(); ++i) {
    if (ladder.columns[i].term != rung.name) continue;
    const auto at = static_cast<Eigen::Index>(i);
    effect.parameters[ladder.columns[i].name] = {ladder.coefficients[at],
                                                 ladder.standard_errors[at]};
  }
  return effect;
}

// What stayed in; what a replaced term brought counts for its successor.
std::vector<FoundEffect> effects_of(const Ladder& ladder) {
  std::vector<FoundEffect> effects;
  double p = 1;
  double left = 1;
  for (const Rung& rung : ladder.rungs) {
    if (!rung.accepted) continue;
    p = std::min(p, rung.p);
    left *= 1 - rung.gain;
    if (!has_columns(rung, ladder)) continue;
    FoundEffect effect = effect_of(rung, ladder);
    effect.p = p;
    effect.heldout_gain = 1 - left;
    effects.push_back(std::move(effect));
    p = left = 1;
  }
  return effects;
}

std::string verdict(const LengthFindings& found) {
  const Ladder& ladder = found.ladder;
  const Rung* last = last_accepted(ladder);
  if (last == nullptr) return "The readings are the nominal lengths, as far as they can tell.";
  std::vector<std::string> names;
  for (const Rung& rung : ladder.rungs) {
    if (rung.accepted && has_columns(rung, ladder)) {
      names.push_back(fmt::format("{} ({})", rung.name, rung.form));
    }
  }
  names.front().front() = static_cast<char>(std::toupper(names.front().front()));
  return fmt::format(
      "Parts are off by {} mm (rms; median {}). {} bring{} that to {} mm (median {}) on parts that "
      "the fit did not see; readings of one dimension of one part scatter by {} mm.",
      thousandths(ladder.rms_without), thousandths(ladder.median_without), fmt::join(names, ", "),
      names.size() == 1 ? "s" : "", thousandths(last->rms), thousandths(last->median),
      thousandths(found.floor_rms));
}

std::vector<std::vector<std::string>> ladder_rows(const Ladder& ladder) {
  std::vector<std::vector<std::string>> rows = {
      {"model", "form", "verdict", "numbers", "rms, mm", "median, mm", "t", "p"}};
  rows.push_back({"nominal lengths", "", "", "0", thousandths(ladder.rms_without),
                  thousandths(ladder.median_without), "", ""});
  for (const Rung& rung : ladder.rungs) {
    rows.push_back({"+ " + rung.name, rung.form, rung.accepted ? "kept" : "rejected",
                    std::to_string(rung.parameters), thousandths(rung.rms),
                    thousandths(rung.median), fmt::format("{:.1f}", rung.t),
                    rung.p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", rung.p)});
  }
  return rows;
}

// The numbers of what was kept, but for growth, of which there is one per batch.
std::vector<std::vector<std::string>> coefficient_rows(const Ladder& ladder) {
  std::vector<std::vector<std::string>> rows = {{"term", "which", "mm", "standard error"}};
  for (std::size_t i = 0; i < ladder.columns.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    rows.push_back({ladder.columns[i].term, ladder.columns[i].name,
                    fmt::format("{:+.3f}", ladder.coefficients[at]),
                    thousandths(ladder.standard_errors[at])});
  }
  return rows;
}

std::vector<std::vector<std::string>> growth_rows(const LengthFindings& found) {
  std::vector<std::vector<std::string>> rows = {
      {"batch", "better", "as offset, mm", "as scale, mm"}};
  for (const BatchGrowth& batch : found.growth) {
    rows.push_back({batch.batch, batch.offset_rms < batch.scale_rms ? "offset" : "scale",
                    thousandths(batch.offset_rms), thousandths(batch.scale_rms)});
  }
  return rows;
}

Json to_json(const LengthFindings& found) {
  const Ladder& ladder = found.ladder;
  Json json = {
      {"format", "calibration"},
      {"version", 1},
      {"verdict", word(last_accepted(ladder) != nullptr ? Verdict::kEffect : Verdict::kNone)}};
  Json effects = Json::array();
  for (const FoundEffect& effect : effects_of(ladder)) {
    Json covariate = Json::object();
    if (effect.covariate.axis != Covariate::Axis::kNone) {
      covariate = {{"axis", word(effect.covariate.axis)}, {"form", word(effect.covariate.form)}};
    }
    effects.push_back({{"kind", effect.kind},
                       {"parameters", effect.parameters},
                       {"covariate", covariate},
                       {"rivals", effect.rivals},
                       {"p", effect.p},
                       {"heldout_gain", effect.heldout_gain}});
  }
  json["effects"] = effects;
  const Rung* last = last_accepted(ladder);
  json["before"] = {{"rms_mm", ladder.rms_without}, {"median_mm", ladder.median_without}};
  json["after"] = {{"rms_mm", last != nullptr ? last->rms : ladder.rms_without},
                   {"median_mm", last != nullptr ? last->median : ladder.median_without}};
  json["floor"] = {{"rms_mm", found.floor_rms}};
  Json rungs = Json::array();
  for (const Rung& rung : ladder.rungs) {
    rungs.push_back({{"model", rung.name},
                     {"form", rung.form},
                     {"parameters", rung.parameters},
                     {"rms_mm", rung.rms},
                     {"median_mm", rung.median},
                     {"t", rung.t},
                     {"p", rung.p},
                     {"heldout_gain", rung.gain},
                     {"accepted", rung.accepted}});
  }
  json["ladder"] = rungs;
  json["rows"] = found.rows;
  json["used_rows"] = found.used_rows;
  json["dropped"] = found.dropped;
  json["offset_batches"] = found.offset_batches();
  json["batches"] = found.growth.size();
  return json;
}

std::string profile_chart(const LengthFindings::Profile& profile) {
  std::vector<double> x;
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < profile.labels.size(); ++i) {
    x.push_back(static_cast<double>(i));
    const std::string& label = profile.labels[i];
    labels.push_back(label.substr(label.find_last_of(' ') + 1));
  }
  return html::lines("by " + profile.name, profile.name, "error, mm", x,
                     {{Series::kBefore, profile.before_mm}, {Series::kAfter, profile.after_mm}},
                     labels);
}

std::string page_of(const LengthFindings& found, const GaugeTable& table) {
  const Ladder& ladder = found.ladder;
  const Rung* last = last_accepted(ladder);
  std::string body = "<h1>Calibration from " + html::escaped(table.path) +
                     "</h1>\n<section><p class=\"verdict\">" + html::escaped(verdict(found)) +
                     "</p></section>\n";
  std::string dropped;
  for (const std::string& line : found.dropped) dropped += "<li>" + html::escaped(line) + "</li>\n";
  body += html::section("What was measured",
                        fmt::format("<p>{} rows, {} used.</p>\n", found.rows, found.used_rows) +
                            (dropped.empty() ? "" : "<ul>\n" + dropped + "</ul>\n"));
  std::vector<html::BarGroup> groups = {
      {"rms", {{Series::kBefore, ladder.rms_without, thousandths(ladder.rms_without) + " mm"}}},
      {"median",
       {{Series::kBefore, ladder.median_without, thousandths(ladder.median_without) + " mm"}}}};
  if (last != nullptr) {
    groups[0].bars.push_back({Series::kAfter, last->rms, thousandths(last->rms) + " mm"});
    groups[1].bars.push_back({Series::kAfter, last->median, thousandths(last->median) + " mm"});
  }
  if (found.floor_rms > 0) {
    groups[0].bars.push_back(
        {Series::kFloor, found.floor_rms, thousandths(found.floor_rms) + " mm"});
  }
  body +=
      html::section("The error, before and after",
                    html::legend({{Series::kBefore, "nominal lengths"},
                                  {Series::kAfter, "all that was kept, held out by part"},
                                  {Series::kFloor, "readings of the same dimension (the floor)"}}) +
                        html::bars(groups));
  body += html::section(
      "Step by step",
      html::table(ladder_rows(ladder), 3) +
          html::note("Errors are of parts that the fit did not see: each part is left "
                     "out in turn, and where a step has several forms, so is the "
                     "choice. t: the gain per part over the best model so far, "
                     "paired. A step is kept from t = 2 on, if it takes away half a "
                     "per cent of the squared error or more. rms follows the worst "
                     "parts, the median the usual ones; a step may help one and "
                     "hurt the other."));
  std::string charts;
  for (const LengthFindings::Profile& profile : found.profiles) {
    if (profile.labels.size() > 1) charts += profile_chart(profile);
  }
  body += html::section("What the error follows", "<div class=\"charts\">\n" + charts + "</div>\n");
  if (!ladder.columns.empty()) {
    body += html::section("What the parts lacked",
                          effects_table(effects_of(ladder)) +
                              html::note("Numbers are millimetres, each with its standard error. "
                                         "Held-out gain: share of the squared error gone in parts "
                                         "that the fit did not see."));
    body +=
        html::section("The numbers", "<details><summary>" + std::to_string(ladder.columns.size()) +
                                         " numbers of what was kept</summary>\n" +
                                         html::table(coefficient_rows(ladder), 2) + "</details>\n");
  }
  body += html::section(
      fmt::format("Growth is an offset in {} of {} batches", found.offset_batches(),
                  found.growth.size()),
      html::table(growth_rows(found), 2) +
          html::note(
              "Each batch told as so many millimetres on every length, and as so many per cent; "
              "rms on parts held out."));
  return gauge_page(std::move(body), table);
}

}  // namespace

GaugeSummary summarize(const LengthFindings& found, const GaugeTable& table) {
  std::string text = verdict(found);
  for (const std::string& line : found.dropped) text += "\ndropped: " + line;
  text += fmt::format("\ngrowth is an offset rather than a scale in {} of {} batches",
                      found.offset_batches(), found.growth.size());
  text += fmt::format("\n{:<28}{:<22}{:>7}{:>8}{:>7}", "held out by part, mm", "form", "rms",
                      "median", "t");
  text += fmt::format("\n{:<28}{:<22}{:>7.3f}{:>8.3f}", "nominal lengths", "",
                      found.ladder.rms_without, found.ladder.median_without);
  for (const Rung& rung : found.ladder.rungs) {
    text += fmt::format("\n{:<28}{:<22}{:>7.3f}{:>8.3f}{:>7.1f}  {}", "+ " + rung.name, rung.form,
                        rung.rms, rung.median, rung.t, rung.accepted ? "kept" : "rejected");
  }
  return {to_json(found), text, page_of(found, table)};
}

}  // namespace binderjet
