// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/profile/profile.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "driver/base/files.h"
#include "slicer/base/error.h"
#include "slicer/model/effects/catalogue.h"
#include "transport/usb/usb_quirks.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

// One table of the file; complains about what is missing, wrong or unknown, with its place.
class Table {
 public:
  Table(const toml::table& table, std::string path, std::string name)
      : table_(table), path_(std::move(path)), name_(std::move(name)) {}

  [[noreturn]] void fail(const toml::source_region& at, const std::string& what) const {
    throw Error(ErrorKind::kBadInput,
                fmt::format("{}:{}:{}", path_, at.begin.line, at.begin.column), what);
  }
  const toml::node& need(const std::string& key) {
    seen_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) fail(table_.source(), fmt::format("{} needs the key {}", name_, key));
    return *node;
  }
  std::string text(const std::string& key) {
    const toml::node& node = need(key);
    if (!node.is_string()) fail(node.source(), fmt::format("{} must be a text", key));
    return node.value_or(std::string());
  }
  // One number, or a list of `count` of them (0: one or more), each above `min` and at most `max`.
  std::vector<double> numbers(const std::string& key, std::size_t count, double min, double max) {
    const toml::node& node = need(key);
    std::vector<double> values = numbers_of(node, key);
    if (count == 0 ? values.empty() : values.size() != count) {
      fail(node.source(),
           count == 0 ? fmt::format("{} must not be empty", key)
                      : fmt::format("{} needs {} number{}", key, count, count == 1 ? "" : "s"));
    }
    for (const double value : values) {
      if (!(value > min && value <= max)) {
        fail(node.source(),
             fmt::format("{}: {} is not above {} and at most {}", key, value, min, max));
      }
    }
    return values;
  }
  // From 1 to `max`.
  int whole_number(const std::string& key, int max) {
    const double value = numbers(key, 1, 0, max).front();
    if (value != std::floor(value)) fail(need(key).source(), key + " must be a whole number");
    return static_cast<int>(value);
  }
  std::vector<double> numbers_of(const toml::node& node, const std::string& key) const {
    std::vector<double> values;
    const auto take = [&](const toml::node& one) {
      if (!one.is_number()) fail(one.source(), fmt::format("{} must be a number", key));
      values.push_back(one.value_or(0.0));
    };
    if (const toml::array* list = node.as_array()) {
      for (const toml::node& one : *list) take(one);
    } else {
      take(node);
    }
    return values;
  }
  Table table(const std::string& key) {
    const toml::node& node = need(key);
    if (!node.is_table()) fail(node.source(), fmt::format("[{}] must be a table", key));
    return {*node.as_table(), path_, fmt::format("[{}]", key)};
  }
  bool has(const std::string& key) const { return table_.contains(key); }
  const toml::table& raw() const { return table_; }
  const std::string& path() const { return path_; }
  // Call when all keys were asked for: a key nobody asked for is a slip of the pen.
  void no_other_keys() const {
    for (const auto& [key, node] : table_) {
      if (!seen_.contains(std::string(key.str()))) {
        fail(key.source(), fmt::format("unknown key {} in {}", key.str(), name_));
      }
    }
  }

 private:
  const toml::table& table_;
  std::string path_;
  std::string name_;
  std::set<std::string> seen_;
};

EffectSpec parse_effect(const Table& table) {
  EffectSpec spec;
  for (const auto& [key, node] : table.raw()) {
    const std::string name(key.str());
    if (name == "kind") {
      spec.kind = node.value_or(std::string());
    } else if (node.is_string()) {
      spec.words[name] = node.value_or(std::string());
    } else {
      spec.numbers[name] = table.numbers_of(node, name);
    }
  }
  const SpecFault fault = check_effect(spec);
  if (!fault.what.empty()) {
    const toml::node* node = table.raw().get(fault.key);
    table.fail(node == nullptr ? table.raw().source() : node->source(),
               fault.key.empty() || node == nullptr
                   ? fmt::format("effect {}: {}", spec.kind, fault.what)
                   : fmt::format("{}: {}", fault.key, fault.what));
  }
  return spec;
}

std::vector<EffectSpec> parse_effects(Table& root) {
  std::vector<EffectSpec> effects;
  const toml::node& node = root.need("effects");
  const toml::array* list = node.as_array();
  if (list == nullptr) root.fail(node.source(), "effects must be [[effects]] tables");
  for (const toml::node& one : *list) {
    if (!one.is_table()) root.fail(one.source(), "effects must be [[effects]] tables");
    effects.push_back(parse_effect(Table(*one.as_table(), root.path(), "[[effects]]")));
  }
  return effects;
}

void parse_device(Table table, Profile& profile) {
  profile.protocol = table.text("protocol");
  const toml::node& usb = table.need("usb");
  const toml::array* list = usb.as_array();
  if (list == nullptr) table.fail(usb.source(), "usb must be a list of \"vid:pid\"");
  for (const toml::node& one : *list) {
    if (!one.is_string()) table.fail(one.source(), "usb must be a list of \"vid:pid\"");
    profile.usb.push_back(one.value_or(std::string()));
    if (!parse_usb_model_words(profile.usb.back())) {
      table.fail(one.source(),
                 "usb needs \"vid:pid\" in hexadecimal, then quirks if any: "
                 "device-id-little-endian, no-device-id, soft-reset-1.0");
    }
  }
  table.no_other_keys();
}

MaskRules parse_mask(Table table) {
  MaskRules rules;
  constexpr int kMaxPx = 64;
  if (table.has("min_island_px")) rules.min_island_px = table.whole_number("min_island_px", kMaxPx);
  if (table.has("min_hole_px")) rules.min_hole_px = table.whole_number("min_hole_px", kMaxPx);
  table.no_other_keys();
  return rules;
}

StrengthRules parse_strength(Table table) {
  StrengthRules strength;
  constexpr double kMaxMm = 20;
  const auto rule = [&](const std::string& key) -> std::optional<double> {
    if (!table.has(key)) return std::nullopt;
    return table.numbers(key, 1, 0, kMaxMm).front();
  };
  strength.thinnest_mm = rule("thinnest_mm");
  strength.narrowest_mm = rule("narrowest_mm");
  table.no_other_keys();
  return strength;
}

ColorSettings parse_color(Table table) {
  ColorSettings color;
  if (table.has("depth_mm")) color.depth_mm = table.numbers("depth_mm", 1, -1e-9, 5).front();
  if (table.has("neighbors")) color.neighbors = table.whole_number("neighbors", 64);
  if (table.has("crease_strength")) {
    color.crease_strength = table.numbers("crease_strength", 1, -1e-9, 1).front();
  }
  if (table.has("crease_radius_mm")) {
    color.crease_radius_mm = table.numbers("crease_radius_mm", 1, 0, 100).front();
  }
  table.no_other_keys();
  return color;
}

template <std::size_t N>
std::array<double, N> fixed(const std::vector<double>& values) {
  std::array<double, N> out{};
  std::copy_n(values.begin(), N, out.begin());
  return out;
}

}  // namespace

Grid Profile::grid(std::optional<double> layer) const {
  double height = layer_mm.front();
  if (layer) {
    const auto found = std::find_if(layer_mm.begin(), layer_mm.end(),
                                    [&](double known) { return std::abs(known - *layer) < 1e-9; });
    if (found == layer_mm.end()) {
      throw Error(ErrorKind::kUsage, "--layer",
                  fmt::format("{} prints layers of {} mm, not {}", name,
                              fmt::join(layer_mm, " or "), *layer));
    }
    height = *found;
  }
  constexpr double kMmPerInch = 25.4;
  return {{kMmPerInch / dpi[0], kMmPerInch / dpi[1], height}, detail_vx};
}

// Those of the installation that the program is part of; and, before it is installed, those of the
// source.
std::vector<std::string> profile_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<std::string> folders;
  for (const fs::path& folder : {program.parent_path() / BINDERJET_INSTALLED_PROFILES,
                                 fs::path(BINDERJET_SOURCE_PROFILES)}) {
    if (fs::is_directory(folder, error)) folders.push_back(folder.lexically_normal().string());
  }
  return folders;
}

Profile load_profile(const std::string& name_or_path) {
  std::error_code error;
  std::string lower = name_or_path;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name_or_path.find('/') == std::string::npos) {
    for (const std::string& folder : profile_folders()) {
      const fs::path path = fs::path(folder) / (lower + ".toml");
      if (fs::exists(path, error)) return parse_profile(read_text(path.string()), path.string());
    }
  }
  if (fs::is_regular_file(name_or_path, error)) {
    return parse_profile(read_text(name_or_path), name_or_path);
  }
  throw Error(ErrorKind::kBadInput, name_or_path,
              "no such profile; `binderjet profile list` names those there are");
}

Profile parse_profile(const std::string& text, const std::string& path) {
  toml::table parsed;
  try {
    parsed = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw Error(
        ErrorKind::kBadInput,
        fmt::format("{}:{}:{}", path, error.source().begin.line, error.source().begin.column),
        std::string(error.description()));
  }

  constexpr double kManyMm = 10000;
  Profile profile;
  profile.path = path;
  profile.text = text;
  Table root(parsed, path, "the profile");
  profile.name = root.text("name");
  profile.source = root.text("source");

  Table grid = root.table("grid");
  profile.dpi = fixed<2>(grid.numbers("dpi", 2, 0.5, 10000));
  profile.layer_mm = grid.numbers("layer_mm", 0, 0.001, 10);
  const toml::node& detail = grid.need("detail_vx");
  const std::vector<double> detail_vx = grid.numbers("detail_vx", 3, 0, 16);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    profile.detail_vx[axis] = static_cast<int>(detail_vx[axis]);
    if (profile.detail_vx[axis] != detail_vx[axis]) {
      grid.fail(detail.source(), "detail_vx must be whole numbers");
    }
  }
  grid.no_other_keys();

  Table bed = root.table("bed");
  profile.bed_mm = fixed<3>(bed.numbers("size_mm", 3, 0, kManyMm));
  bed.no_other_keys();

  profile.effects = parse_effects(root);

  Table speed = root.table("speed");
  profile.layers_per_minute = fixed<2>(speed.numbers("layers_per_minute", 2, 0, kManyMm));
  profile.dry_minutes = speed.numbers("dry_minutes", 1, -1e-9, kManyMm).front();
  speed.no_other_keys();

  if (root.has("binder")) {
    Table binder = root.table("binder");
    profile.binder_per_powder = binder.numbers("per_powder", 1, 0, 1).front();
    binder.no_other_keys();
  }
  if (root.has("mask")) profile.mask = parse_mask(root.table("mask"));
  if (root.has("strength")) profile.strength = parse_strength(root.table("strength"));
  if (root.has("color")) profile.color = parse_color(root.table("color"));
  parse_device(root.table("device"), profile);
  root.no_other_keys();
  return profile;
}

}  // namespace binderjet
