// SPDX-License-Identifier: GPL-3.0-or-later
// Reads #include lines only, not C++: one behind an #if counts, one that a macro makes does not.
#include "tests/house/rooms.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace binderjet::house {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  return path.substr(0, std::min(path.size(), path.rfind('/')));
}

std::string top_of(const std::string& path) { return path.substr(0, path.find('/')); }

std::string name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::string place(const File& file, const Include& include) {
  return file.path + ":" + std::to_string(include.line) + ": ";
}

bool is_cpp(const std::string& path) {
  return path.ends_with(".h") || path.ends_with(".cpp") || path.ends_with(".cpp.in");
}

bool is_prose(const std::string& path) {
  return path.ends_with(".md") || name_of(path) == "CMakeLists.txt";
}

std::set<std::string> top_folders(const std::vector<Room>& rooms) {
  std::set<std::string> tops;
  for (const Room& room : rooms) tops.insert(top_of(room.name));
  return tops;
}

const Room* find_room(const std::vector<Room>& rooms, const std::string& name) {
  const auto it =
      std::find_if(rooms.begin(), rooms.end(), [&](const Room& room) { return room.name == name; });
  return it == rooms.end() ? nullptr : &*it;
}

bool stands_for(const std::string& use, const std::string& room) {
  return use == room || (use.ends_with("/*") && room.starts_with(use.substr(0, use.size() - 1)));
}

bool allows(const Room& room, const std::string& other) {
  return room.name == other ||
         std::any_of(room.uses.begin(), room.uses.end(),
                     [&](const std::string& use) { return stands_for(use, other); });
}

std::string cmake_lists_of(const std::string& room) { return top_of(room) + "/CMakeLists.txt"; }

// The path between quotes or angle brackets; none where the line includes nothing.
std::optional<std::string> included_path(const std::string& line) {
  std::istringstream words(line);
  char hash = 0;
  std::string include;
  if (!(words >> hash) || hash != '#' || !std::getline(words >> std::ws, include)) return {};
  if (!include.starts_with("include")) return {};
  const std::size_t open = include.find_first_of("\"<");
  const std::size_t close = include.find_first_of("\">", open + 1);
  if (open == std::string::npos || close == std::string::npos) return {};
  const std::string path = include.substr(open + 1, close - open - 1);
  // <vector> and <fmt/core.h> are nobody's room; in angle brackets ours would be found all the
  // same.
  const std::string top = top_of(path);
  const bool ours = top == "slicer" || top == "driver" || top == "transport" || top == "tests";
  return include[open] == '"' || ours ? std::optional(path) : std::nullopt;
}

std::vector<Include> includes_in(const fs::path& path) {
  std::vector<Include> includes;
  std::ifstream text(path);
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (line.find("include") == std::string::npos) continue;
    if (const auto included = included_path(line)) includes.push_back({number, *included});
  }
  return includes;
}

using Arrows = std::map<std::string, std::map<std::string, std::string>>;

// From room to room, with the place that makes the arrow: an include before a line of CMake.
Arrows arrows(const std::vector<File>& tree, const std::vector<Room>& rooms) {
  Arrows all;
  for (const File& file : tree) {
    const std::string from = folder_of(file.path);
    if (find_room(rooms, from) == nullptr) continue;
    for (const Include& include : file.includes) {
      const std::string to = folder_of(include.path);
      if (to == from || find_room(rooms, to) == nullptr) continue;
      all[from].emplace(to, place(file, include) + from + " includes " + include.path);
    }
  }
  for (const Room& room : rooms) {
    for (const std::string& use : room.uses) {
      if (find_room(rooms, use) == nullptr) continue;
      all[room.name].emplace(use, cmake_lists_of(room.name) + ": " + room.name + " uses " + use);
    }
  }
  return all;
}

class CycleSearch {
 public:
  explicit CycleSearch(const Arrows& arrows) : arrows_(arrows) {}

  void visit(const std::string& room) {
    if (finished_.contains(room)) return;
    const auto begin = std::find(way_.begin(), way_.end(), room);
    if (begin != way_.end()) {
      report({begin, way_.end()});
      return;
    }
    way_.push_back(room);
    if (const auto it = arrows_.find(room); it != arrows_.end()) {
      for (const auto& [to, at] : it->second) visit(to);
    }
    way_.pop_back();
    finished_.insert(room);
  }
  std::vector<std::string> found;

 private:
  void report(const std::vector<std::string>& rooms) {
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      const std::string& to = rooms[(i + 1) % rooms.size()];
      found.push_back(arrows_.at(rooms[i]).at(to) +
                      (i + 1 < rooms.size() ? ", and" : ", which closes a cycle of rooms"));
    }
  }

  const Arrows& arrows_;
  std::vector<std::string> way_;
  std::set<std::string> finished_;
};

}  // namespace

std::vector<Room> read_rooms(std::istream& text) {
  std::vector<Room> rooms;
  std::string line;
  while (std::getline(text, line)) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    Room room{line.substr(0, colon), {}};
    std::istringstream uses(line.substr(colon + 1));
    for (std::string use; uses >> use;) room.uses.push_back(use);
    rooms.push_back(room);
  }
  return rooms;
}

std::vector<File> read_tree(const fs::path& root, const std::vector<Room>& rooms) {
  std::vector<File> tree;
  for (const std::string& top : top_folders(rooms)) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file()) continue;
      const std::string path = entry.path().lexically_relative(root).generic_string();
      tree.push_back({path, is_cpp(path) ? includes_in(entry.path()) : std::vector<Include>{}});
    }
  }
  std::sort(tree.begin(), tree.end(), [](const File& a, const File& b) { return a.path < b.path; });
  return tree;
}

std::vector<std::string> includes_against_the_rule(const std::vector<File>& tree,
                                                   const std::vector<Room>& rooms) {
  std::set<std::string> paths;
  for (const File& file : tree) paths.insert(file.path);
  std::vector<std::string> wrong;
  for (const File& file : tree) {
    const Room* room = find_room(rooms, folder_of(file.path));
    if (room == nullptr) continue;  // strays() says so
    for (const Include& include : file.includes) {
      const std::string other = folder_of(include.path);
      if (!paths.contains(include.path)) {
        wrong.push_back(place(file, include) + include.path +
                        " is no file of a room; a path is written from the root of the tree");
      } else if (!allows(*room, other)) {
        wrong.push_back(place(file, include) + room->name + " may not include " + include.path +
                        ": its line in " + cmake_lists_of(room->name) + " does not use " + other);
      }
    }
  }
  return wrong;
}

std::vector<std::string> cycles(const std::vector<File>& tree, const std::vector<Room>& rooms) {
  const Arrows all = arrows(tree, rooms);
  CycleSearch search(all);
  for (const Room& room : rooms) search.visit(room.name);
  return search.found;
}

std::vector<std::string> strays(const std::vector<File>& tree, const std::vector<Room>& rooms) {
  std::vector<std::string> wrong;
  for (const File& file : tree) {
    const std::string folder = folder_of(file.path);
    const bool has_rooms = std::any_of(rooms.begin(), rooms.end(), [&](const Room& room) {
      return room.name.starts_with(folder + "/");
    });
    const bool loose = folder == top_of(folder) && has_rooms && name_of(file.path) != "main.cpp" &&
                       !is_prose(file.path);
    if (loose) {
      wrong.push_back(file.path + ":1: a loose file in " + folder + "/: put it into a room");
    } else if (is_cpp(file.path) && find_room(rooms, folder) == nullptr) {
      wrong.push_back(file.path + ":1: in no room: " + folder + " has no line in " +
                      cmake_lists_of(folder));
    }
  }
  return wrong;
}

std::vector<std::string> idle_uses(const std::vector<File>& tree, const std::vector<Room>& rooms) {
  std::vector<std::string> idle;
  for (const Room& room : rooms) {
    for (const std::string& use : room.uses) {
      const bool needed = std::any_of(tree.begin(), tree.end(), [&](const File& file) {
        return folder_of(file.path) == room.name &&
               std::any_of(file.includes.begin(), file.includes.end(), [&](const Include& include) {
                 return stands_for(use, folder_of(include.path));
               });
      });
      if (needed) continue;
      idle.push_back(cmake_lists_of(room.name) + ": " + room.name + " uses " + use +
                     ", of which no file of it includes anything");
    }
  }
  return idle;
}

std::vector<std::string> crowded_rooms(const std::vector<File>& tree,
                                       const std::vector<Room>& rooms, int most) {
  std::vector<std::string> crowded;
  for (const Room& room : rooms) {
    const auto files = std::count_if(tree.begin(), tree.end(), [&](const File& file) {
      return folder_of(file.path) == room.name && !is_prose(file.path);
    });
    if (files > most) crowded.push_back(room.name + " has " + std::to_string(files) + " files");
  }
  return crowded;
}

}  // namespace binderjet::house
