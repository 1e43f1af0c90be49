// SPDX-License-Identifier: GPL-3.0-or-later
// Reports as one HTML file that needs no other: text, tables, SVG charts, pictures inline.
//
// Every function returns well-formed markup; what comes from files is escaped in here, so that no
// caller has to think of it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace binderjet::html {

std::string escaped(const std::string& text);

std::string base64(std::span<const std::byte> bytes);

// A whole page around `body`, which is markup.
std::string page(const std::string& title, const std::string& body);

// `heading` and `text` are plain text, `body` is markup.
std::string section(const std::string& heading, const std::string& body);
std::string note(const std::string& text);

// Cells are plain text; the first row is the header. Cells from column `numbers_from` on are
// aligned to the right.
std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t numbers_from);

// A PNG of width : height as given (mm, say), as wide as its column.
std::string picture(std::span<const std::byte> png, double width, double height,
                    const std::string& caption);

// What a bar or line stands for; each has a color of its own in all charts of a page.
enum class Series { kBefore, kAfter, kFloor };
std::string legend(const std::vector<std::pair<Series, std::string>>& series);

struct Bar {
  Series series;
  double value;
  std::string text;  // what stands at its end
};
struct BarGroup {
  std::string label;
  std::vector<Bar> bars;
};
// Horizontal bars from 0, all groups to one scale.
std::string bars(const std::vector<BarGroup>& groups);

struct Line {
  Series series;
  std::vector<double> y;
};
// Lines over ascending x with a line at 0; `labels`, if any, stand for the x (one each).
std::string lines(const std::string& title, const std::string& x_label, const std::string& y_label,
                  const std::vector<double>& x, const std::vector<Line>& lines,
                  const std::vector<std::string>& labels = {});

}  // namespace binderjet::html
