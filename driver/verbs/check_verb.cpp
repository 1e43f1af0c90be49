// SPDX-License-Identifier: GPL-3.0-or-later
// check PART... -p PROFILE: what a print would lose, fuse and trap, before any powder is spent.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "driver/job/estimate.h"
#include "driver/job/print_stream.h"
#include "driver/job/slice_plan.h"
#include "driver/report/located_faults.h"
#include "driver/verbs/verbs.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"
#include "slicer/score/trapped_powder.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostNamed = 100;  // with --json
constexpr std::size_t kMostTold = 8;     // to a person, of each kind

// What is found, and how to say it.
struct Kind {
  const char* word;
  const char* one;
  const char* many;
  const char* meaning;
};
constexpr Kind kKinds[] = {
    {"lost", "feature vanishes", "features vanish", "too thin to come out of the powder"},
    {"fused", "gap closes", "gaps close", "too narrow to stay open"},
    {"spurious", "loose crumb", "loose crumbs", "printed where the part has nothing"},
    {"separated", "piece comes off", "pieces come off", "nothing printed holds them to their part"},
    {"touching", "joint between parts", "joints between parts", "printed where they are apart"},
    {"trapped", "pocket traps powder", "pockets trap powder", "no way out for the powder in it"},
};

struct Findings {
  std::map<std::string, std::int64_t> counts;
  std::map<std::string, FoundRegions> regions;

  void add(const std::string& kind, const Region& region) {
    ++counts[kind];
    regions[kind].add({kind, region});
  }
};

struct Checked {
  Findings findings;
  Totals totals;
  double excess = 0;
};

Checked check_plan(const SlicePlan& plan, const Console& console) {
  const JobHeader& header = plan.header;
  const LayerRange all{0, header.layers()};
  const auto model = std::make_shared<const PrinterModel>(header.profile.effects, header.grid,
                                                          place_of(header.box, header.grid));
  const auto tally = std::make_shared<MaskTally>();
  const auto layers =
      score_layers(voxelize(plan.mesh, header.grid, header.box, all),
                   printed_job(header, plan.mesh, model, tally).all_layers(), header.grid, all);
  Checked checked;
  Score score(header.grid, 0);
  TrappedPowder powder;
  const auto take = [&](const std::vector<Feature>& features) {
    for (const Feature& feature : features) {
      checked.findings.add(word(feature.kind), feature.region);
    }
  };
  Progress progress(console, "checking", header.layers());
  while (layers->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : layers->next(kBlockLayers)) {
      take(score.add(*layer));
      for (const Region& pocket : powder.add(*layer->layer.printed)) {
        checked.findings.add("trapped", in_slices(pocket, header.grid.detail_vx[2]));
      }
      ++checked.totals.layers;
    }
    progress.advance(checked.totals.layers);
  }
  take(score.finish());
  for (const Region& piece : score.loose_pieces()) checked.findings.add("separated", piece);
  for (const Region& joint : score.joints()) checked.findings.add("touching", joint);
  checked.excess = score.voxels().excess();
  checked.totals.mask_px = tally->pixels;
  checked.totals.rules = tally->rules;
  checked.totals.target_vx = score.voxels().solid;
  return checked;
}

std::string place_text(const Json& found) {
  return fmt::format("  at {:.1f}, {:.1f}, {:.1f} mm, {:.2f} x {:.2f} x {:.2f} mm, layers {} to {}",
                     found["at_mm"][0].get<double>(), found["at_mm"][1].get<double>(),
                     found["at_mm"][2].get<double>(), found["size_mm"][0].get<double>(),
                     found["size_mm"][1].get<double>(), found["size_mm"][2].get<double>(),
                     found["layers"][0].get<int>(), found["layers"][1].get<int>() - 1);
}

void check(const SliceOptions& options, const Console& console) {
  SlicePlan plan = plan_slices(options, console);
  const JobHeader& header = plan.header;
  const Checked checked = check_plan(plan, console);
  const std::string changed = rule_warning(checked.totals.rules, header.profile.mask);
  if (!changed.empty()) {
    console.warning(changed);
    plan.warnings.push_back(changed);
  }
  const std::array<double, 3> origin_mm = {header.box.bed_px[0] * header.grid.pitch_mm[0],
                                           header.box.bed_px[1] * header.grid.pitch_mm[1], 0};

  Json json = {{"verdict", "prints as it is"}};
  Json all = Json::array();
  std::string text;
  for (const Kind& kind : kKinds) {
    const auto counted = checked.findings.counts.find(kind.word);
    const std::int64_t count = counted == checked.findings.counts.end() ? 0 : counted->second;
    json[kind.word] = count;
    if (count == 0) continue;
    json["verdict"] = "loses detail";
    text += fmt::format("{} {} ({}):\n", count, count == 1 ? kind.one : kind.many, kind.meaning);
    std::size_t told = 0;
    for (const Found& found : checked.findings.regions.at(kind.word).largest(kMostNamed)) {
      all.push_back(to_json(found, origin_mm, header.grid));
      if (told++ < kMostTold) text += place_text(all.back()) + "\n";
    }
    if (count > static_cast<std::int64_t>(kMostTold)) {
      text += fmt::format("  and {} smaller ones\n", count - static_cast<std::int64_t>(kMostTold));
    }
  }
  if (plan.doubtful_size) json["verdict"] = "doubtful size";
  if (checked.totals.target_vx == 0) json["verdict"] = "nothing to print";
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
  text += fmt::format("\nverdict: {}", json["verdict"].get<std::string>());
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
