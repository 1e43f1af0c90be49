// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/demand_apart.h"

#include <algorithm>
#include <filesystem>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

fs::path place(const std::string& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path clean = error ? fs::absolute(path).lexically_normal() : place;
  return clean.has_filename() ? clean : clean.parent_path();
}

// Whether `inner` is `outer` or lies in it.
bool holds(const fs::path& outer, const fs::path& inner) {
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace

void demand_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const fs::path out = place(outputs[i]);
    for (const std::string& input : inputs) {
      if (!holds(out, place(input))) continue;
      throw Error(ErrorKind::kUsage, outputs[i],
                  "would replace " + input + ", which is read here; name another place");
    }
    for (std::size_t k = 0; k < i; ++k) {
      const fs::path other = place(outputs[k]);
      if (!holds(out, other) && !holds(other, out)) continue;
      throw Error(ErrorKind::kUsage, outputs[i],
                  "would replace " + outputs[k] + ", which is written too; name another place");
    }
  }
}

}  // namespace binderjet
