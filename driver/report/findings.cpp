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

constexpr const char* kSound = "prints as it is";

std::string region_text(const Json& found) {
  return fmt::format("  at {:.1f}, {:.1f}, {:.1f} mm, {:.2f} x {:.2f} x {:.2f} mm, layers {} to {}",
                     found["at_mm"][0].get<double>(), found["at_mm"][1].get<double>(),
                     found["at_mm"][2].get<double>(), found["size_mm"][0].get<double>(),
                     found["size_mm"][1].get<double>(), found["size_mm"][2].get<double>(),
                     found["layers"][0].get<int>(), found["layers"][1].get<int>() - 1);
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
    thin = thin || place.kind == WrongKind::kThin;
    thick = thick || place.kind == WrongKind::kThick;
  }
  if (thin || thick) {
    words.push_back(fmt::format("is {} in places", thin && thick ? "too thin and too thick"
                                                   : thin        ? "too thin"
                                                                 : "too thick"));
  }
  const bool sound = words.empty();
  if (trapped_.count > 0) words.emplace_back(kTrapped.verdict);
  if (!sound) return listed(words);
  return words.empty() ? kSound : fmt::format("{}, but {}", kSound, words.front());
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
  Json found = Json::array();
  const auto tell = [&](const Saying& say, std::int64_t count, const Kind* kind) {
    json[std::string(say.word)] = count;
    if (kind == nullptr) return;
    for (const Region& region : kind->regions.largest(kMaxNamed)) {
      found.push_back(located(say.word, region, origin_mm_, grid_));
    }
  };
  for (const FaultKind kind : kFaultKinds) {
    const auto all = faults_.find(kind);
    tell(saying(kind), count(kind), all == faults_.end() ? nullptr : &all->second);
  }
  tell(kTrapped, trapped_.count, &trapped_);
  json["found"] = std::move(found);
  json["worst_places"] = worst_places();
  return json;
}

std::string Findings::text() const {
  std::string text;
  const auto tell = [&](const Saying& say, const Kind& kind) {
    if (kind.count == 0) return;
    text +=
        fmt::format("{} {} ({}):\n", kind.count, kind.count == 1 ? say.one : say.many, say.meaning);
    for (const Region& region : kind.regions.largest(kMaxTold)) {
      text += region_text(located(say.word, region, origin_mm_, grid_)) + "\n";
    }
    const std::int64_t untold = kind.count - static_cast<std::int64_t>(kMaxTold);
    if (untold > 0) text += fmt::format("  and {} smaller ones\n", untold);
  };
  for (const auto& [kind, all] : faults_) tell(saying(kind), all);
  tell(kTrapped, trapped_);
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
  const auto tell = [&](const Saying& say, const Kind& kind) {
    for (const Region& region : kind.regions.largest(kMaxShown)) {
      const Json found = located(say.word, region, origin_mm_, grid_);
      const int first = found["layers"][0].get<int>();
      const int last = found["layers"][1].get<int>() - 1;
      places.push_back({{"say", say.one},
                        {"at_mm", found["at_mm"]},
                        {"layer", (first + last) / 2},
                        {"size_mm", {found["size_mm"][0], found["size_mm"][1]}}});
    }
  };
  for (const auto& [kind, all] : faults_) tell(saying(kind), all);
  tell(kTrapped, trapped_);
  return places;
}

}  // namespace binderjet
