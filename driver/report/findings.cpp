// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/findings.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxNamed = 100;  // in JSON, of each kind
constexpr std::size_t kMaxTold = 8;     // to a person, of each kind
constexpr std::size_t kMaxShown = 3;    // on a page, of each kind
constexpr std::size_t kMaxPlaces = 5;

// How to say what is found.
struct Saying {
  std::string_view word;
  const char* one;
  const char* many;
  const char* meaning;
  const char* verdict;
  const char* rest = "smaller";  // than those that are named
};

Saying saying(FaultKind kind) {
  switch (kind) {
    case FaultKind::kLost:
      return {word(kind), "feature lost", "features lost", "too thin to come out of the powder",
              "loses detail"};
    case FaultKind::kFused:
      return {word(kind), "gap fused", "gaps fused", "too narrow to stay open", "closes gaps"};
    case FaultKind::kSpurious:
      return {word(kind), "spurious crumb", "spurious crumbs", "printed where the part has nothing",
              "leaves crumbs"};
    case FaultKind::kLoose:
      return {word(kind), "loose piece", "loose pieces", "nothing printed holds them to their part",
              "comes apart"};
    case FaultKind::kJoined:
      break;
  }
  return {word(kind), "bridge joins parts", "bridges join parts", "printed where they are apart",
          "joins parts that are apart"};
}

// No fault of the masks: it is printed as it was wanted.
constexpr Saying kTrapped{"trapped", "pocket traps powder", "pockets trap powder",
                          "no way out for the powder in it", "keeps powder inside"};

// Rules of thumb about the model. A gap that keeps its powder is cleaned by hand, so no verdict.
constexpr Saying kThin{
    "thin",        "thin place",
    "thin places", "may break when powder is brushed off; the profile's rule of thumb",
    "may break",   "wider"};
constexpr Saying kNarrow{
    "narrow", "narrow gap", "narrow gaps", "may keep its powder; the profile's rule of thumb",
    "",       "wider"};

constexpr const char* kSound = "prints as it is";

std::string found_text(const Json& found) {
  std::string text =
      fmt::format("  at {:.1f}, {:.1f}, {:.1f} mm, {:.2f} x {:.2f} x {:.2f} mm, layers {} to {}",
                  found["at_mm"][0].get<double>(), found["at_mm"][1].get<double>(),
                  found["at_mm"][2].get<double>(), found["size_mm"][0].get<double>(),
                  found["size_mm"][1].get<double>(), found["size_mm"][2].get<double>(),
                  found["layers"][0].get<int>(), found["layers"][1].get<int>() - 1);
  if (found.contains("widest_mm")) {
    text += fmt::format(", {:.2f} mm at its widest", found["widest_mm"].get<double>());
  }
  return text;
}

// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

Findings::Findings(const Grid& grid, const std::array<double, 3>& origin_mm, int first_layer)
    : grid_(grid), origin_mm_(origin_mm), first_layer_(first_layer), scorer_(grid, first_layer) {}

void Findings::take(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) faults_[fault.kind].add(fault.region);
}

void Findings::add(const LayerScore& layer) {
  take(scorer_.add(layer));
  for (Region pocket : powder_.add(*layer.layer.printed)) {
    pocket.low[2] += first_layer_;
    pocket.high[2] += first_layer_;
    trapped_.add(in_slices(pocket, grid_.detail_vx[2]));
  }
}

void Findings::finish() {
  score_ = scorer_.finish();
  take(score_.last_faults);
}

std::string Findings::verdict() const {
  const VoxelCounts& voxels = score_.voxels;
  if (voxels.solid > 0 && voxels.missing == voxels.solid) return "nothing of it prints";
  std::vector<std::string> words;
  for (const FaultKind kind : kFaultKinds) {
    if (count(kind) > 0) words.emplace_back(saying(kind).verdict);
  }
  bool thin = false;
  bool thick = false;
  for (const WrongPlace& place : score_.depths.places(kMaxPlaces)) {
    thin = thin || place.kind == WrongKind::kMissing;
    thick = thick || place.kind == WrongKind::kExtra;
  }
  if (thin || thick) {
    words.push_back(fmt::format("is {} in places", thin && thick ? "too thin and too thick"
                                                   : thin        ? "too thin"
                                                                 : "too thick"));
  }
  // What is lost is thin too: of a thin place that is printed the verdict is that of a sound print.
  const bool sound = words.empty();
  if (sound && thin_ && thin_->count > 0) words.emplace_back(kThin.verdict);
  if (trapped_.count > 0) words.emplace_back(kTrapped.verdict);
  if (!sound) return listed(words);
  return words.empty() ? kSound : fmt::format("{}, but {}", kSound, listed(words));
}

template <class Tell>
void Findings::for_each_kind(const Tell& tell) const {
  for (const auto& [kind, found] : faults_) tell(saying(kind), found);
  if (trapped_.count > 0) tell(kTrapped, trapped_);
  if (thin_ && thin_->count > 0) tell(kThin, *thin_);
  if (narrow_ && narrow_->count > 0) tell(kNarrow, *narrow_);
}

Json Findings::worst_places() const {
  Json places = Json::array();
  for (const WrongPlace& place : score_.depths.places(kMaxPlaces)) {
    places.push_back(located(place, origin_mm_, grid_));
  }
  return places;
}

Json Findings::to_json() const {
  Json json;
  for (const FaultKind kind : kFaultKinds) json[std::string(word(kind))] = count(kind);
  json[std::string(kTrapped.word)] = trapped_.count;
  json[std::string(kThin.word)] = thin_ ? Json(thin_->count) : Json();
  json[std::string(kNarrow.word)] = narrow_ ? Json(narrow_->count) : Json();
  json["found"] = Json::array();
  for_each_kind([&](const Saying& say, const auto& kind) {
    for (const auto& place : kind.places.largest(kMaxNamed)) {
      json["found"].push_back(located(say.word, place, origin_mm_, grid_));
    }
  });
  json["worst_places"] = worst_places();
  return json;
}

std::string Findings::text() const {
  std::string text;
  for_each_kind([&](const Saying& say, const auto& kind) {
    text +=
        fmt::format("{} {} ({}):\n", kind.count, kind.count == 1 ? say.one : say.many, say.meaning);
    for (const auto& place : kind.places.largest(kMaxTold)) {
      text += found_text(located(say.word, place, origin_mm_, grid_)) + "\n";
    }
    const std::int64_t untold = kind.count - static_cast<std::int64_t>(kMaxTold);
    if (untold > 0) text += fmt::format("  and {} {} ones\n", untold, say.rest);
  });
  const Json places = worst_places();
  if (places.empty()) {
    text +=
        fmt::format("nothing is wrong deeper than {:.2f} mm, the largest side of a printed pixel\n",
                    score_.depths.named_mm());
  } else {
    text += "worst places (how far from the model's surface):\n";
    for (const Json& place : places) text += "  " + place_text(place) + "\n";
  }
  return text;
}

Json Findings::to_look_at() const {
  Json places = Json::array();
  for (const Json& place : worst_places()) {
    places.push_back({{"say", wrong_text(place)},
                      {"at_mm", place["at_mm"]},
                      {"layer", place["layer"]},
                      {"size_mm", {0, 0}}});
  }
  for_each_kind([&](const Saying& say, const auto& kind) {
    for (const auto& place : kind.places.largest(kMaxShown)) {
      const Json found = located(say.word, place, origin_mm_, grid_);
      const int first = found["layers"][0].get<int>();
      const int last = found["layers"][1].get<int>() - 1;
      places.push_back({{"say", say.one},
                        {"at_mm", found["at_mm"]},
                        {"layer", (first + last) / 2},
                        {"size_mm", {found["size_mm"][0], found["size_mm"][1]}}});
    }
  });
  return places;
}

}  // namespace binderjet
