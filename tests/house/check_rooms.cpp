// SPDX-License-Identifier: GPL-3.0-or-later
// binderjet_check_rooms ROOT ROOMS.TXT: what the build runs before it compiles the rooms. Prints
// each include against the rule, each cycle and each stray file, and fails if there is one.
#include <fstream>
#include <iostream>

#include "tests/house/rooms.h"

int main(int argc, char** argv) {
  using namespace binderjet::house;
  if (argc != 3) return 2;
  std::ifstream text(argv[2]);
  const std::vector<Room> rooms = read_rooms(text);
  if (rooms.empty()) {
    std::cerr << argv[2] << ": no room in it\n";
    return 2;
  }
  const std::vector<File> tree = read_tree(argv[1], rooms);
  // One after the other: a cycle is mostly what an include against the rule brings with it.
  for (const auto& check : {strays, includes_against_the_rule, cycles}) {
    const std::vector<std::string> wrong = check(tree, rooms);
    for (const std::string& line : wrong) std::cerr << line << '\n';
    if (!wrong.empty()) return 1;
  }
  return 0;
}
