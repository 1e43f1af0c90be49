// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/html.h"

#include <fmt/format.h>

#include <cstdint>

namespace binderjet::html {
namespace {

constexpr const char* kStyle = R"(
:root { --before: #c4562a; --after: #1f6f9c; --floor: #8a8f94; --line: #dde1e4; --ink: #20262b; }
body { margin: 0; background: #f4f5f6; color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 1.5rem 1.25rem 3rem; }
h1 { font-size: 1.1rem; font-weight: 600; color: #5b646b; margin: 0 0 .4rem; }
h2 { font-size: 1.05rem; margin: 0 0 .6rem; }
section { background: #fff; border: 1px solid var(--line); border-radius: .5rem;
  padding: 1rem 1.25rem; margin-top: 1rem; overflow-x: auto; }
.verdict { font-size: 1.35rem; line-height: 1.4; margin: 0; }
.note { color: #5b646b; font-size: .9rem; margin: .5rem 0 0; }
.row { display: flex; flex-wrap: wrap; gap: 1.25rem; }
.row > * { flex: 1 1 18rem; min-width: 0; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(18rem, 1fr)); gap: 1rem; }
summary { cursor: pointer; color: #5b646b; }
table { border-collapse: collapse; font-size: .92rem; width: 100%; }
th, td { text-align: left; padding: .3rem .9rem .3rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
th { color: #5b646b; font-weight: 600; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; padding: .3rem 0 .3rem .9rem; }
figure { margin: 0; }
figure img { width: 100%; height: auto; border: 1px solid var(--line); display: block;
  image-rendering: pixelated; }
figcaption { font-size: .9rem; color: #5b646b; margin-top: .3rem; }
.key { display: inline-block; margin-right: 1.1rem; font-size: .9rem; }
.key i { display: inline-block; width: .85em; height: .85em; border-radius: 2px; margin-right: .4em; }
.swatch { border: 1px solid #b9bec2; }
svg { display: block; width: 100%; height: auto; }
svg text { font: 12px system-ui, sans-serif; fill: var(--ink); }
svg .faint { fill: #5b646b; }
.before { fill: var(--before); } .after { fill: var(--after); } .floor { fill: var(--floor); }
path.before, path.after, path.floor { fill: none; stroke-width: 2; stroke-linejoin: round; }
path.before { stroke: var(--before); } path.after { stroke: var(--after); } path.floor { stroke: var(--floor); }
i.before { background: var(--before); } i.after { background: var(--after); } i.floor { background: var(--floor); }
ul { margin: 0; padding-left: 1.2rem; }
@media print { body { background: #fff; } section { break-inside: avoid; } }
)";

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      three =
          three << 8 | (i + j < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + j]) : 0);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      out += i + j > bytes.size() ? '=' : kDigits[three >> (18 - 6 * j) & 63];
    }
  }
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out;
}

std::string page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}\n</main>\n</body>\n</"
      "html>\n",
      escaped(title), kStyle, body);
}

std::string section(const std::string& heading, const std::string& body) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", escaped(heading), body);
}

std::string note(const std::string& text) {
  return fmt::format("<p class=\"note\">{}</p>\n", escaped(text));
}

std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t numbers_from) {
  std::string out = "<table>\n";
  for (const std::vector<std::string>& row : rows) {
    const char* const cell = &row == &rows.front() ? "th" : "td";
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      out += fmt::format("<{0}{1}>{2}</{0}>", cell, i >= numbers_from ? " class=\"number\"" : "",
                         escaped(row[i]));
    }
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string picture(std::span<const std::byte> png, double width, double height,
                    const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"{0}\" style=\"aspect-ratio: {1:.3f} / {2:.3f}\" "
      "src=\"data:image/png;base64,{3}\"/><figcaption>{0}</figcaption></figure>\n",
      escaped(caption), width, height, base64(png));
}

}  // namespace binderjet::html
