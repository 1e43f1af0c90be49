// SPDX-License-Identifier: GPL-3.0-or-later
// check PART... -p PROFILE: what a print would lose, fuse and trap, before any powder is spent.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/job/estimate.h"
#include "driver/job/print_stream.h"
#include "driver/job/slice_plan.h"
#include "driver/report/located_faults.h"
#include "driver/verbs/verbs.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"
#include "slicer/score/thin_places.h"
#include "slicer/score/trapped_powder.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxNamed = 100;  // with --json
constexpr std::size_t kMaxTold = 8;     // to a person, of each kind

// How to say what is found.
struct Saying {
  std::string_view word;
  const char* one;
  const char* many;
  const char* meaning;
};

Saying saying(FaultKind kind) {
  switch (kind) {
    case FaultKind::kLost:
      return {word(kind), "feature lost", "features lost", "too thin to come out of the powder"};
    case FaultKind::kFused:
      return {word(kind), "gap fused", "gaps fused", "too narrow to stay open"};
    case FaultKind::kSpurious:
      return {word(kind), "spurious crumb", "spurious crumbs",
              "printed where the part has nothing"};
    case FaultKind::kLoose:
      return {word(kind), "loose piece", "loose pieces",
              "nothing printed holds them to their part"};
    case FaultKind::kJoined:
      break;
  }
  return {word(kind), "bridge joins parts", "bridges join parts", "printed where they are apart"};
}

// No fault of the masks: it is printed as it was wanted.
constexpr Saying kTrapped{"trapped", "pocket traps powder", "pockets trap powder",
                          "no way out for the powder in it"};

// All of a kind: how many, and where the largest are.
struct Kind {
  std::int64_t count = 0;
  LargestOf<Region> regions;

  void add(const Region& region) {
    ++count;
    regions.add(region);
  }
};

// What the profile's [strength] says of the target, the thinnest first; a rule of thumb.
struct Thin {
  std::int64_t count = 0;
  LargestOf<ThinPlace> places;
};
constexpr Saying kThin{"thin", "thin place", "thin places",
                       "may break when powder is brushed off; the profile's rule of thumb"};
constexpr Saying kNarrow{"narrow", "narrow gap", "narrow gaps",
                         "may keep its powder; the profile's rule of thumb"};

struct Checked {
  std::map<FaultKind, Kind> faults;
  Kind trapped;
  std::optional<Thin> thin;  // nothing: no rule, or none that the grid can tell
  std::optional<Thin> narrow;
  Totals totals;
  double excess = 0;
};

Checked check_plan(const SlicePlan& plan, const Console& console) {
  const JobHeader& header = plan.header;
  const Work work = console.work();
  const LayerRange all{0, header.layers()};
  const auto model = std::make_shared<const PrinterModel>(header.profile.effects, header.grid,
                                                          place_of(header.box, header.grid));
  const auto tally = std::make_shared<MaskTally>();
  const auto layers = score_layers(voxelize(plan.mesh, header.grid, header.box, all),
                                   printed_job(header, plan.mesh, model, tally, work).all_layers(),
                                   header.grid, all);
  Checked checked;
  Scorer scorer(header.grid, 0);
  TrappedPowder powder;
  const auto take = [&](const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) checked.faults[fault.kind].add(fault.region);
  };
  Stage stage(work, "checking", header.layers(), "layers");
  while (layers->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : layers->next(kBlockLayers)) {
      take(scorer.add(*layer));
      for (const Region& pocket : powder.add(*layer->layer.printed)) {
        checked.trapped.add(in_slices(pocket, header.grid.detail_vx[2]));
      }
      ++checked.totals.layers;
    }
    stage.reach(checked.totals.layers);
  }
  const JobScore score = scorer.finish();
  take(score.last_faults);
  checked.excess = score.voxels.excess();
  checked.totals.mask_px = tally->pixels;
  checked.totals.rules = tally->rules;
  checked.totals.target_vx = score.voxels.solid;
  return checked;
}

// Places of the target below a rule; says so where voxels are too coarse to tell.
std::optional<Thin> below_rule(SlicePlan& plan, const char* key, std::optional<double> rule_mm,
                               Matter matter, const Console& console) {
  if (!rule_mm) return std::nullopt;
  const JobHeader& header = plan.header;
  if (*rule_mm < least_rule_mm(header.grid)) {
    plan.warnings.push_back(fmt::format(
        "[strength] {} = {:g} is not looked at: this grid cannot tell less than {:.2f} mm, "
        "three of its coarsest voxels or layers; take a finer layer, or leave the key out",
        key, *rule_mm, least_rule_mm(header.grid)));
    console.warning(plan.warnings.back());
    return std::nullopt;
  }
  Thin thin;
  find_thin_places(voxel_layers(plan.mesh, header.grid, header.box, console.work()), header.grid,
                   *rule_mm, matter, console.work(), [&](const ThinPlace& place) {
                     ++thin.count;
                     thin.places.add(place);
                   });
  return thin;
}

std::string place_text(const Json& found) {
  return fmt::format("  at {:.1f}, {:.1f}, {:.1f} mm, {:.2f} x {:.2f} x {:.2f} mm, layers {} to {}",
                     found["at_mm"][0].get<double>(), found["at_mm"][1].get<double>(),
                     found["at_mm"][2].get<double>(), found["size_mm"][0].get<double>(),
                     found["size_mm"][1].get<double>(), found["size_mm"][2].get<double>(),
                     found["layers"][0].get<int>(), found["layers"][1].get<int>() - 1);
}

enum class Verdict { kAsItIs, kMayBreak, kLosesDetail, kDoubtfulSize, kNothingToPrint };

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAsItIs:
      return "prints as it is";
    case Verdict::kMayBreak:
      return "may break";
    case Verdict::kLosesDetail:
      return "loses detail";
    case Verdict::kDoubtfulSize:
      return "doubtful size";
    case Verdict::kNothingToPrint:
      break;
  }
  return "nothing to print";
}

Verdict verdict_on(const Checked& checked, bool doubtful_size) {
  if (checked.totals.target_vx == 0) return Verdict::kNothingToPrint;
  if (doubtful_size) return Verdict::kDoubtfulSize;
  const bool sound = checked.faults.empty() && checked.trapped.count == 0;
  if (!sound) return Verdict::kLosesDetail;
  return checked.thin && checked.thin->count > 0 ? Verdict::kMayBreak : Verdict::kAsItIs;
}

void check(const SliceOptions& options, const Console& console) {
  SlicePlan plan = plan_slices(options, console);
  const JobHeader& header = plan.header;
  Checked checked = check_plan(plan, console);
  const StrengthRules& strength = header.profile.strength;
  checked.thin = below_rule(plan, "thinnest_mm", strength.thinnest_mm, Matter::kPart, console);
  checked.narrow =
      below_rule(plan, "narrowest_mm", strength.narrowest_mm, Matter::kPowder, console);
  const std::string changed = rule_warning(checked.totals.rules, header.profile.mask);
  if (!changed.empty()) {
    console.warning(changed);
    plan.warnings.push_back(changed);
  }
  const std::string verdict = word(verdict_on(checked, plan.doubtful_size));
  const std::array<double, 3> origin_mm = {header.box.bed_px[0] * header.grid.pitch_mm[0],
                                           header.box.bed_px[1] * header.grid.pitch_mm[1], 0};

  Json json = {{"verdict", verdict}};
  Json all = Json::array();
  std::string text;
  const auto tell = [&](const Saying& say, const Kind& kind) {
    json[std::string(say.word)] = kind.count;
    if (kind.count == 0) return;
    text +=
        fmt::format("{} {} ({}):\n", kind.count, kind.count == 1 ? say.one : say.many, say.meaning);
    std::size_t told = 0;
    for (const Region& region : kind.regions.largest(kMaxNamed)) {
      all.push_back(located(say.word, region, origin_mm, header.grid));
      if (told++ < kMaxTold) text += place_text(all.back()) + "\n";
    }
    const std::int64_t untold = kind.count - static_cast<std::int64_t>(kMaxTold);
    if (untold > 0) text += fmt::format("  and {} smaller ones\n", untold);
  };
  for (const FaultKind kind : kFaultKinds) tell(saying(kind), checked.faults[kind]);
  tell(kTrapped, checked.trapped);
  const auto tell_thin = [&](const Saying& say, const std::optional<Thin>& thin) {
    json[std::string(say.word)] = thin ? Json(thin->count) : Json();
    if (!thin || thin->count == 0) return;
    text += fmt::format("{} {} ({}):\n", thin->count, thin->count == 1 ? say.one : say.many,
                        say.meaning);
    std::size_t told = 0;
    for (const ThinPlace& place : thin->places.largest(kMaxNamed)) {
      all.push_back(located(say.word, place.region, origin_mm, header.grid));
      all.back()["width_mm"] = place.width_mm;
      if (told++ < kMaxTold) {
        text += place_text(all.back()) + fmt::format(", {:.2f} mm at its widest\n", place.width_mm);
      }
    }
    const std::int64_t untold = thin->count - static_cast<std::int64_t>(kMaxTold);
    if (untold > 0) text += fmt::format("  and {} wider ones\n", untold);
  };
  tell_thin(kThin, checked.thin);
  tell_thin(kNarrow, checked.narrow);
  json["found"] = std::move(all);
  json["excess"] = checked.excess;
  const Estimate estimate = estimate_of(header, checked.totals);
  json["print_minutes"] = estimate.print_minutes;
  json["binder_ml"] = estimate.binder_ml;
  json["powder_ml"] = estimate.powder_ml;
  json["warnings"] = plan.warnings;
  text += fmt::format("{:.2f} % of the part's voxels will be wrong beyond the layers' height\n",
                      100 * checked.excess);
  text += text_of(estimate, header);
  text += fmt::format("\nverdict: {}", verdict);
  console.result(json, text);
}

}  // namespace

void add_check_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand(
      "check", "say what a print would lose, fuse and trap, before any powder is spent");
  auto options = std::make_shared<SliceOptions>();
  verb->add_option("PART", options->parts, "models: STL, PLY, OBJ, OFF, 3MF, glTF and others")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  add_slice_options(*verb, *options);
  verb->callback([options, console = add_console_options(*verb)] { check(*options, *console); });
}

}  // namespace binderjet
