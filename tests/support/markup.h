// SPDX-License-Identifier: GPL-3.0-or-later
// A strict look at a page of ours: every tag closed in its turn, nothing fetched from elsewhere.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace binderjet {

// What is wrong with the page; empty if nothing is.
inline std::string markup_fault(const std::string& page) {
  for (const char* const foreign :
       {"http:", "https:", "<script", "<link", "@import", "url(", "src=\"/"}) {
    if (page.find(foreign) != std::string::npos) return std::string("refers outside: ") + foreign;
  }
  for (std::size_t at = page.find("src=\""); at != std::string::npos;
       at = page.find("src=\"", at + 1)) {
    if (page.compare(at + 5, 5, "data:") != 0) return "a picture is not inline";
  }
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "a tag never ends";
    const std::string tag = page.substr(at + 1, end - at - 1);
    if (tag.front() == '!') continue;
    if (tag.find('<') != std::string::npos) return "a tag within a tag: " + tag.substr(0, 40);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0)
      return "an open quote in " + tag.substr(0, 40);
    if (tag.back() == '/') continue;
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (name.front() != '/') {
      open.push_back(name);
      continue;
    }
    if (open.empty() || name.substr(1) != open.back()) return "closes out of turn: " + name;
    open.pop_back();
  }
  if (!open.empty()) return "never closes " + open.back();
  for (std::size_t at = page.find('&'); at != std::string::npos; at = page.find('&', at + 1)) {
    const std::string entity = page.substr(at, page.find(';', at) - at);
    if (entity != "&amp" && entity != "&lt" && entity != "&gt" && entity != "&quot") {
      return "a bare &";
    }
  }
  return {};
}

}  // namespace binderjet
