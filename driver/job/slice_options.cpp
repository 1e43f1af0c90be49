// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/slice_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

// "A:B" as numbers; either may be empty.
template <class Number>
std::vector<std::optional<Number>> split(const std::string& option, const std::string& text,
                                         char separator, std::size_t count) {
  std::vector<std::optional<Number>> values;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    const std::string piece = text.substr(begin, end - begin);
    Number value{};
    if (piece.empty()) {
      values.emplace_back();
    } else if (CLI::detail::lexical_cast(piece, value)) {
      values.emplace_back(value);
    } else {
      throw Error(ErrorKind::kUsage, option, "\"" + piece + "\" is not a number");
    }
    if (end == text.size()) break;
    begin = end + 1;
  }
  if (values.size() != count) {
    throw Error(ErrorKind::kUsage, option,
                fmt::format("needs {} values between \"{}\", got \"{}\"", count, separator, text));
  }
  return values;
}

// Unlike CLI::Range it refuses nan.
CLI::Validator between(double least, double most) {
  return {[least, most](const std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) {
              return std::string();
            }
            return fmt::format("\"{}\" is no number from {:g} to {:g}", text, least, most);
          },
          "POSITIVE", "between"};
}

}  // namespace

std::optional<double> unit_of(const SliceOptions& options) {
  const std::string& word = options.units;
  if (word.empty()) return std::nullopt;
  const std::optional<double> unit_mm = unit_from_word(word);
  if (!unit_mm) {
    throw Error(ErrorKind::kUsage, "--units",
                "\"" + word + "\" is not one of um, mm, cm, m, in, ft");
  }
  return unit_mm;
}

std::array<double, 2> bed_place(const std::string& at) {
  const auto place = split<double>("--at", at, ',', 2);
  if (!place[0] || !place[1]) throw Error(ErrorKind::kUsage, "--at", "needs X,Y in mm");
  return {*place[0], *place[1]};
}

LayerRange layer_range(const std::string& text, int layers) {
  if (text.empty()) return {0, layers};
  const auto ends = split<int>("--layers", text, ':', 2);
  const LayerRange range{ends[0].value_or(0), ends[1].value_or(layers)};
  if (range.first < 0 || range.last > layers || range.first >= range.last) {
    throw Error(ErrorKind::kUsage, "--layers",
                fmt::format("{} is empty or beyond the part's {} layers", text, layers));
  }
  return range;
}

void add_slice_options(CLI::App& verb, SliceOptions& options) {
  const auto choose = [&options](const std::string& word) {
    options.enhance = enhancement_of(word).value();
  };
  verb.add_option_function<std::string>("--enhance", choose, "how masks answer the printer's blur")
      ->check(CLI::IsMember(enhancement_words()))
      ->default_str(word(options.enhance));
  verb.add_option("--passes", options.passes, "passes of the paper's rule")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb.add_flag("--robust,!--no-robust", options.robust,
                "inverse: masks for a printer that may be a little off (default), not for the "
                "profile's model alone");
  verb.add_option("--layer", options.layer_mm, "layer height in mm, one the printer has");
  CLI::Option* scale = verb.add_option("--scale", options.placement.scale, "scale factor")
                           ->check(between(kLeastScale, kMostScale))
                           ->capture_default_str();
  verb.add_option("--size", options.size_mm,
                  "instead: scale each part so that its largest side is so many mm")
      ->check(between(1e-6, 1e6))
      ->excludes(scale);
  verb.add_option("--units", options.units,
                  "the model's unit: mm, cm, m, um, in, ft (default: what the file says, else mm)");
  verb.add_option("--rotate", options.placement.rotate_deg,
                  "turn about x, then y, then z, in degrees")
      ->delimiter(',');
  verb.add_option("--at", options.at,
                  "X,Y in mm: the part's lower corner on the bed; once per part")
      ->allow_extra_args(false);
  verb.add_option("--wall", options.placement.wall_mm,
                  "give a surface that encloses nothing, as of a scan, a wall this thick, in mm")
      ->check(between(1e-6, kMostWallMm));
  verb.add_option("--texture", options.texture,
                  "the image for a model whose file has a place in it but names none");
  verb.add_flag("--color-enhance", options.color_enhance,
                "darken creases, so that detail shows in diffuse light");
}

}  // namespace binderjet
