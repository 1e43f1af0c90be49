// SPDX-License-Identifier: GPL-3.0-or-later
// The charts of a report, drawn as SVG.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "driver/base/html.h"

namespace binderjet::html {
namespace {

const char* word(Series series) {
  switch (series) {
    case Series::kBefore:
      return "before";
    case Series::kAfter:
      return "after";
    case Series::kFloor:
      break;
  }
  return "floor";
}

// The next 1, 2 or 5 times a power of ten.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

// An axis of a chart: values to pixels, and round values to write at it.
struct Axis {
  double low, high;
  double from_px, to_px;

  double px(double value) const {
    return from_px + (value - low) / (high - low) * (to_px - from_px);
  }
  std::vector<double> ticks(int most) const {
    const double step = round_step((high - low) / most);
    std::vector<double> out;
    for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
      out.push_back(i * step);
    }
    return out;
  }
};

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* style = "faint") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>\n",
                     x, y, anchor, style, escaped(text));
}

std::string rule(double x0, double y0, double x1, double y1, const char* color) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1,
      y1, color);
}

// A label's end, which is where names of files differ.
std::string shortened(const std::string& label) {
  constexpr std::size_t kMost = 26;
  return label.size() <= kMost ? label : "\u2026" + label.substr(label.size() - kMost);
}

std::string number(double value) {
  return fmt::format("{:g}", std::abs(value) < 1e-12 ? 0 : value);
}

}  // namespace

std::string legend(const std::vector<std::pair<Series, std::string>>& series) {
  std::string out = "<p class=\"note\">";
  for (const auto& [one, text] : series) {
    out +=
        fmt::format("<span class=\"key\"><i class=\"{}\"></i>{}</span>", word(one), escaped(text));
  }
  return out + "</p>\n";
}

std::string bars(const std::vector<BarGroup>& groups) {
  constexpr double kWidth = 720, kLabel = 190, kValue = 90, kBar = 16, kGap = 14;
  double most = 0;
  double height = kGap;
  for (const BarGroup& group : groups) {
    for (const Bar& bar : group.bars) most = std::max(most, bar.value);
    height += kBar * static_cast<double>(group.bars.size()) + kGap;
  }
  std::string out = fmt::format("<svg viewBox=\"0 0 {:g} {:g}\" role=\"img\">\n", kWidth, height);
  double y = kGap;
  for (const BarGroup& group : groups) {
    const double middle = y + kBar * static_cast<double>(group.bars.size()) / 2 + 4;
    out += text_at(kLabel - 10, middle, "end", shortened(group.label), "");
    for (const Bar& bar : group.bars) {
      const double length =
          most > 0 ? std::max(1.0, bar.value / most * (kWidth - kLabel - kValue)) : 1;
      out += fmt::format(
          "<rect x=\"{:g}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\" rx=\"2\" "
          "class=\"{}\"/>\n",
          kLabel, y + 1, length, kBar - 2, word(bar.series));
      out += text_at(kLabel + length + 6, y + kBar - 4, "start", bar.text, "");
      y += kBar;
    }
    y += kGap;
  }
  return out + "</svg>\n";
}

std::string lines(const std::string& title, const std::string& x_label, const std::string& y_label,
                  const std::vector<double>& x, const std::vector<Line>& all,
                  const std::vector<std::string>& labels) {
  constexpr double kWidth = 360, kHeight = 210;
  double low = 0;
  double high = 0;
  for (const Line& line : all) {
    for (const double y : line.y) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  if (high - low < 1e-9) high = low + 1;
  const double air = 0.06 * (high - low);
  const bool point = x.size() < 2;
  const Axis across{point ? 0 : x.front(), point ? 1 : x.back(), 52, kWidth - 10};
  const Axis up{low - air, high + air, kHeight - 38, 26};
  std::string out = fmt::format("<svg viewBox=\"0 0 {:g} {:g}\" role=\"img\">\n", kWidth, kHeight);
  out += text_at(0, 14, "start", title, "");
  out += text_at(kWidth - 10, 14, "end", y_label);
  for (const double tick : up.ticks(4)) {
    out += rule(across.from_px, up.px(tick), across.to_px, up.px(tick), "#eceeef");
    out += text_at(across.from_px - 6, up.px(tick) + 4, "end", number(tick));
  }
  out += rule(across.from_px, up.px(0), across.to_px, up.px(0), "#8a8f94");
  if (labels.empty()) {
    for (const double tick : across.ticks(6)) {
      out += text_at(across.px(tick), kHeight - 22, "middle", number(tick));
    }
  } else {
    for (std::size_t i = 0; i < x.size(); ++i) {
      out += text_at(across.px(x[i]), kHeight - 22, "middle", labels[i]);
    }
  }
  out += text_at((across.from_px + across.to_px) / 2, kHeight - 6, "middle", x_label);
  for (const Line& line : all) {
    std::string path;
    for (std::size_t i = 0; i < line.y.size(); ++i) {
      path +=
          fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : " L", across.px(x[i]), up.px(line.y[i]));
    }
    out += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", word(line.series), path);
    if (x.size() > 24) continue;
    for (std::size_t i = 0; i < line.y.size(); ++i) {
      out += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n",
                         word(line.series), across.px(x[i]), up.px(line.y[i]));
    }
  }
  return out + "</svg>\n";
}

}  // namespace binderjet::html
