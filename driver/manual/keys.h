// SPDX-License-Identifier: GPL-3.0-or-later
// What every key of the program's JSON and every column of its CSV means, for the man pages.
#pragma once

#include <string>
#include <vector>

namespace binderjet {

// A name is the way to a value: "found[].at_mm" is at_mm of each object of the list "found"; NAME
// stands for any name.
struct Key {
  std::string name;
  std::string meaning;  // with the unit, where the name does not say it
};

// One section of a page.
struct KeyTable {
  std::string title;  // "RESULT", or the file's name
  std::string about;  // when it is written or read
  std::vector<Key> keys;
};

// Those of a verb's page, the result of --json first.
std::vector<KeyTable> key_tables(const std::string& verb);

}  // namespace binderjet
