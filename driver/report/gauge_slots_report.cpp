// SPDX-License-Identifier: GPL-3.0-or-later
// Slots and walls: what the declared model predicts of them, and which change of it agrees.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "driver/base/html.h"
#include "driver/report/calibration_report.h"
#include "driver/report/gauge_report.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;
using html::Series;

std::string hundredths(double value) { return fmt::format("{:.2f}", value); }

// The explanations that agree as well as the first: this gauge cannot tell them apart.
std::vector<Explanation> rivals_of(const SlotFindings& found) {
  std::vector<Explanation> rivals;
  for (std::size_t i = 1; i < found.explanations.size(); ++i) {
    if (found.explanations[i].agrees == found.explanations[0].agrees) {
      rivals.push_back(found.explanations[i]);
    }
  }
  return rivals;
}

std::string range(const Explanation& e) { return fmt::format("{:.2f} to {:.2f}", e.low, e.high); }

std::string verdict(const SlotFindings& found) {
  if (found.declared_agrees) {
    return "The declared model predicts every gauge within its uncertainty.";
  }
  if (found.explanations.empty() || !found.explanations.front().agrees) {
    return "The declared model misses the gauges, and no single number of it mends that.";
  }
  std::string text =
      fmt::format("The declared model is off by {} mm (rms). ", hundredths(found.declared_rms_mm)) +
      "It agrees with every gauge if " + found.explanations.front().text;
  for (const Explanation& rival : rivals_of(found)) text += "; or if " + rival.text;
  return text + (rivals_of(found).empty() ? "." : ". These gauges cannot tell which.");
}

std::string tell_apart_text(const SlotFindings& found) {
  if (found.discriminators.empty()) return {};
  const Discriminator& best = found.discriminators.front();
  return fmt::format(
      "To tell: print a {}. It comes out {} mm wide in the first case and {} in the second, {} mm "
      "apart.",
      best.gauge, hundredths(best.predicted_mm[0]),
      best.predicted_mm[1] > 0 ? hundredths(best.predicted_mm[1]) + " mm" : "not at all",
      hundredths(best.difference_mm));
}

Json to_json(const SlotFindings& found) {
  const bool explained = !found.explanations.empty() && found.explanations.front().agrees;
  Json json = {{"format", "calibration"},
               {"version", 1},
               {"verdict", word(found.declared_agrees ? Verdict::kNone
                                : explained           ? Verdict::kEffect
                                                      : Verdict::kUnexplained)},
               {"effects", Json::array()}};
  Json readings = Json::array();
  for (std::size_t i = 0; i < found.readings.size(); ++i) {
    const GaugeReading& r = found.readings[i];
    Json one = {{"gauge", r.name},
                {"measured_mm", r.measured_mm},
                {"uncertainty_mm", r.uncertainty_mm},
                {"declared_mm", found.declared_mm[i]},
                {"residual_mm", r.measured_mm - found.declared_mm[i]}};
    if (explained) {
      one["after_mm"] = found.explanations.front().predicted_mm[i];
      one["residual_after_mm"] = r.measured_mm - found.explanations.front().predicted_mm[i];
    }
    readings.push_back(one);
  }
  json["readings"] = readings;
  json["before"] = {{"rms_mm", found.declared_rms_mm}};
  if (!explained) return json;
  const Explanation& first = found.explanations.front();
  Json rivals = Json::array();
  for (const Explanation& rival : rivals_of(found)) {
    rivals.push_back({{"kind", rival.kind},
                      {"value", rival.value},
                      {"from", rival.low},
                      {"to", rival.high},
                      {"text", rival.text}});
  }
  const double gain =
      1 - std::pow(first.heldout_rms_mm / std::max(1e-12, found.declared_rms_mm), 2);
  json["effects"].push_back(
      {{"kind", first.kind},
       {"parameters", {{"value", first.value}, {"from", first.low}, {"to", first.high}}},
       {"covariate", Json::object()},
       {"rivals", rivals},
       {"p", nullptr},  // so few readings have no distribution to be judged against
       {"heldout_gain", gain}});
  json["after"] = {{"rms_mm", first.heldout_rms_mm}, {"fitted_rms_mm", first.rms_mm}};
  Json apart = Json::array();
  for (const Discriminator& d : found.discriminators) {
    apart.push_back(
        {{"gauge", d.gauge}, {"predicted_mm", d.predicted_mm}, {"difference_mm", d.difference_mm}});
  }
  json["tell_apart"] = apart;
  return json;
}

std::string readings_table(const SlotFindings& found) {
  std::vector<std::vector<std::string>> rows = {
      {"gauge", "measured, mm", "declared model", "residual"}};
  for (const Explanation& e : found.explanations) {
    rows[0].push_back(e.kind);
    rows[0].push_back("residual");
  }
  for (std::size_t i = 0; i < found.readings.size(); ++i) {
    const GaugeReading& r = found.readings[i];
    rows.push_back({r.name, fmt::format("{:.2f} \u00b1 {:.2f}", r.measured_mm, r.uncertainty_mm),
                    hundredths(found.declared_mm[i]),
                    fmt::format("{:+.2f}", r.measured_mm - found.declared_mm[i])});
    for (const Explanation& e : found.explanations) {
      rows.back().push_back(hundredths(e.predicted_mm[i]));
      rows.back().push_back(fmt::format("{:+.2f}", r.measured_mm - e.predicted_mm[i]));
    }
  }
  return html::table(rows, 1);
}

std::string apart_table(const SlotFindings& found) {
  std::vector<std::vector<std::string>> rows = {
      {"gauge to print", found.explanations[0].kind, found.explanations[1].kind, "apart, mm"}};
  for (const Discriminator& d : found.discriminators) {
    rows.push_back({d.gauge, hundredths(d.predicted_mm[0]), hundredths(d.predicted_mm[1]),
                    hundredths(d.difference_mm)});
  }
  return html::table(rows, 1);
}

std::string page_of(const SlotFindings& found, const GaugeTable& table,
                    const std::vector<EffectSpec>& declared) {
  std::string body = "<h1>Calibration from " + html::escaped(table.path) +
                     "</h1>\n<section><p class=\"verdict\">" + html::escaped(verdict(found)) +
                     "</p></section>\n";
  html::BarGroup bars{
      "rms over the gauges",
      {{Series::kBefore, found.declared_rms_mm, hundredths(found.declared_rms_mm) + " mm"}}};
  if (!found.explanations.empty()) {
    const Explanation& first = found.explanations.front();
    bars.bars.push_back(
        {Series::kAfter, first.heldout_rms_mm, hundredths(first.heldout_rms_mm) + " mm"});
  }
  body += html::section(
      "The error, before and after",
      html::legend(
          {{Series::kBefore, "declared model"}, {Series::kAfter, "calibrated model, held out"}}) +
          html::bars({bars}) + readings_table(found) +
          html::note(
              "A first visible width is known to lie between the widest gauge that was not "
              "seen and the narrowest that was. Residual: measured less predicted. Held out: "
              "each gauge predicted from the others."));
  if (!found.explanations.empty()) {
    std::vector<std::vector<std::string>> rows = {{"kind", "explanation", "from ... to", "agrees"}};
    for (const Explanation& e : found.explanations) {
      rows.push_back({e.kind, e.text, range(e), e.agrees ? "with every gauge" : "no"});
    }
    body += html::section("What the model may lack", html::table(rows, 4));
    body += html::section("The models", models_table(declared, found.explanations.front().effects));
  }
  if (!found.discriminators.empty()) {
    body += html::section("What print would tell",
                          html::note(tell_apart_text(found)) + apart_table(found));
  }
  return gauge_page(std::move(body), table);
}

}  // namespace

GaugeSummary summarize(const SlotFindings& found, const GaugeTable& table,
                       const std::vector<EffectSpec>& declared) {
  std::string text = verdict(found);
  for (std::size_t i = 0; i < found.readings.size(); ++i) {
    const GaugeReading& r = found.readings[i];
    text += fmt::format("\n{}: measured {} +- {} mm, declared model {}, residual {:+.2f}", r.name,
                        hundredths(r.measured_mm), hundredths(r.uncertainty_mm),
                        hundredths(found.declared_mm[i]), r.measured_mm - found.declared_mm[i]);
    if (!found.explanations.empty()) {
      text += fmt::format(", after {:+.2f}", r.measured_mm - found.explanations[0].predicted_mm[i]);
    }
  }
  for (const Explanation& e : found.explanations) {
    text += fmt::format("\n{}: {} ({}), rms {} mm, held out {} mm", e.kind, e.text, range(e),
                        hundredths(e.rms_mm), hundredths(e.heldout_rms_mm));
  }
  const std::string apart = tell_apart_text(found);
  if (!apart.empty()) text += "\n" + apart;
  return {to_json(found), text, page_of(found, table, declared)};
}

}  // namespace binderjet
