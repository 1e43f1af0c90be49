// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms of the tree, and which includes are against the rule.
//
// A room is a folder with a line in a CMakeLists.txt, `slicer_room(score USES layers voxels)`.
// Arrows point downwards: a file may include headers of its own room and of those that the line
// lists, and no way along the arrows leads back to where it began.
//
//        score ──▶ voxels ──▶ mesh ──▶ base
//           └────────┴──────▶ layers
//
// The build asks this before it compiles a room (check_rooms.cpp), for the linker alone sees
// neither an include of a header without a .cpp nor a cycle of static libraries.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace binderjet::house {

struct Room {
  std::string name;               // its folder: slicer/enhance/paper
  std::vector<std::string> uses;  // names of rooms; slicer/* stands for all rooms below slicer/
};

struct Include {
  int line = 0;      // from 1
  std::string path;  // as it is written
};

struct File {
  std::string path;               // from the root of the tree
  std::vector<Include> includes;  // those of our own headers; empty for what is no C++
};

// Lines as CMake writes them into build/rooms.txt, "slicer/score: slicer/layers slicer/voxels".
std::vector<Room> read_rooms(std::istream& text);

// All files below the top folders of the rooms (slicer, driver, transport), sorted by their paths.
std::vector<File> read_tree(const std::filesystem::path& root, const std::vector<Room>& rooms);

// Each returns one line for each thing that is wrong, "slicer/layers/rows.h:9: ...".
std::vector<std::string> includes_against_the_rule(const std::vector<File>& tree,
                                                   const std::vector<Room>& rooms);
// A cycle's arrows, each with an include that makes it or the CMake line that only lists it.
std::vector<std::string> cycles(const std::vector<File>& tree, const std::vector<Room>& rooms);
// C++ in a folder that is no room; a file directly in a top folder that has rooms in it, unless it
// starts the program or documents the folder.
std::vector<std::string> strays(const std::vector<File>& tree, const std::vector<Room>& rooms);

// Rooms that a CMake line lists for no include. They do no harm, but mislead who reads the line.
std::vector<std::string> idle_uses(const std::vector<File>& tree, const std::vector<Room>& rooms);
// Rooms with more than `most` files, CMakeLists.txt and prose not counted.
std::vector<std::string> crowded_rooms(const std::vector<File>& tree,
                                       const std::vector<Room>& rooms, int most);

}  // namespace binderjet::house
