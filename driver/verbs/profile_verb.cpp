// SPDX-License-Identifier: GPL-3.0-or-later
// profile list | show NAME | check FILE
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "driver/base/console.h"
#include "driver/profile/profile.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/byte_text.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

nlohmann::ordered_json to_json(const StrengthRules& strength) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  if (strength.thinnest_mm) out["thinnest_mm"] = *strength.thinnest_mm;
  if (strength.narrowest_mm) out["narrowest_mm"] = *strength.narrowest_mm;
  return out;
}

nlohmann::ordered_json to_json(const Profile& profile) {
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const EffectSpec& effect : profile.effects) {
    nlohmann::ordered_json one = {{"kind", effect.kind}};
    for (const auto& [name, value] : effect.words) one[name] = value;
    for (const auto& [name, values] : effect.numbers) {
      one[name] = values.size() == 1 ? nlohmann::ordered_json(values.front())
                                     : nlohmann::ordered_json(values);
    }
    effects.push_back(one);
  }
  return {{"name", profile.name},
          {"path", profile.path},
          {"source", profile.source},
          {"dpi", profile.dpi},
          {"layer_mm", profile.layer_mm},
          {"detail_vx", profile.detail_vx},
          {"bed_mm", profile.bed_mm},
          {"effects", effects},
          {"strength", to_json(profile.strength)},
          {"protocol", profile.protocol}};
}

void list_profiles(const Console& console) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  std::set<std::string> names;
  for (const std::string& folder : profile_folders()) {
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".toml") files.insert(entry.path());
    }
    for (const std::filesystem::path& file : files) {
      if (!names.insert(file.stem().string()).second) continue;
      Profile profile;
      try {
        profile = load_profile(file.string());
      } catch (const Error& error) {
        console.warning(error.what());  // the others are as good as before
        continue;
      }
      list.push_back({{"name", file.stem().string()}, {"path", file.string()}});
      text +=
          fmt::format("{}{:<16} {:g} x {:g} dpi, bed {:g} x {:g} x {:g} mm",
                      text.empty() ? "" : "\n", visible_line(file.stem().string()), profile.dpi[0],
                      profile.dpi[1], profile.bed_mm[0], profile.bed_mm[1], profile.bed_mm[2]);
    }
  }
  console.result({{"profiles", list}}, text);
}

}  // namespace

void add_profile_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("profile", "list, show or check printer profiles");
  verb->require_subcommand(1);

  CLI::App* list = verb->add_subcommand("list", "the profiles that -p knows by name");
  list->callback([console = add_console_options(*list)] { list_profiles(*console); });

  auto name = std::make_shared<std::string>();
  CLI::App* show = verb->add_subcommand("show", "a profile, with the source of every number");
  show->add_option("NAME", *name, "a profile's name or path")->required();
  show->callback([console = add_console_options(*show), name] {
    const Profile profile = load_profile(*name);
    const bool ends = profile.text.ends_with('\n');  // as what is printed does anyway
    console->result(to_json(profile), profile.text.substr(0, profile.text.size() - ends));
  });

  CLI::App* check = verb->add_subcommand("check", "read a profile strictly and say what is wrong");
  check->add_option("FILE", *name, "a profile's path or name")->required();
  check->callback([console = add_console_options(*check), name] {
    const Profile profile = load_profile(*name);
    console->result(to_json(profile), fmt::format("{}: good", profile.path));
  });
}

}  // namespace binderjet
