// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/calibration_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;
using Numbers = std::map<std::string, std::vector<double>>;

// A list of one number is that number.
void put(Json& json, const Numbers& numbers) {
  for (const auto& [name, values] : numbers) {
    if (values.size() == 1) {
      json[name] = values.front();
    } else {
      json[name] = values;
    }
  }
}

Json to_json(const Covariate& covariate) {
  Json json = {{"axis", word(covariate.axis)}};
  if (covariate.form != Covariate::Form::kConstant) json["form"] = word(covariate.form);
  put(json, covariate.numbers);
  return json;
}

Json to_json(const FoundEffect& effect) {
  Json parameters = Json::object();
  put(parameters, effect.parameters);
  return {{"kind", effect.kind},
          {"parameters", parameters},
          {"covariate", to_json(effect.covariate)},
          {"rivals", effect.rivals},
          {"p", effect.p},
          {"heldout_gain", effect.heldout_gain}};
}

// `unavoidable` is what two prints of one job differ by: no model can do better than about that.
Json to_json(const PrintError& error, double unavoidable) {
  return {{"wrong", error.wrong},
          {"excess", std::max(0.0, error.wrong - unavoidable)},
          {"epe_mm", {{"mean", error.mean_mm}, {"p95", error.p95_mm}, {"max", error.max_mm}}}};
}

}  // namespace

Json calibration_json(const Calibration& calibration, const std::string& profile,
                      const std::string& report) {
  Json json = {{"format", "calibration"}, {"version", 1}, {"verdict", word(calibration.verdict)}};
  json["effects"] = Json::array();
  for (const FoundEffect& effect : calibration.effects) json["effects"].push_back(to_json(effect));
  if (calibration.remaining) {
    json["remaining"] = to_json(calibration.remaining->covariate);
    json["remaining"]["share"] = calibration.remaining->share;
  } else {
    json["remaining"] = nullptr;
  }
  // The floor between replicates is known where there are two of them.
  const PrintError* floors = nullptr;
  for (const BeforeAfter& score : calibration.scores) {
    if (score.floor && floors == nullptr) floors = &*score.floor;
  }
  const double floor = floors == nullptr ? 0 : floors->wrong;
  const BeforeAfter& first = calibration.scores.front();
  json["data"] = first.name;
  json["before"] = to_json(first.before, floor);
  json["after"] = to_json(first.after, floor);
  json["floor"] = floors == nullptr ? Json() : to_json(*floors, floor);
  json["scores"] = Json::array();
  for (const BeforeAfter& score : calibration.scores) {
    json["scores"].push_back({{"data", score.name},
                              {"before", to_json(score.before, floor)},
                              {"after", to_json(score.after, floor)}});
  }
  json["profile"] = profile;
  json["report"] = report;
  return json;
}

}  // namespace binderjet
