// SPDX-License-Identifier: GPL-3.0-or-later
// binderjet_calibrate_trials [small|full] [catalogue|half|nameless|pairs|null] [NAME] [SEEDS]:
// hidden printers, calibrated on one part and judged on another; a table of what was found.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "slicer/calibrate/calibrate.h"
#include "tests/hidden_printers/hidden_printer.h"
#include "tests/support/listener.h"

namespace {

using namespace binderjet;
using namespace binderjet::hidden;

struct Tally {
  int right = 0;
  int total = 0;
  int gone = 0;
};

bool is_right(const Printer& printer, const std::vector<FoundEffect>& effects) {
  if (printer.kinds.empty() && printer.axes.empty()) return effects.empty();
  return std::any_of(effects.begin(), effects.end(), [&](const FoundEffect& effect) {
    const auto has = [](const auto& list, const auto& one) {
      return std::find(list.begin(), list.end(), one) != list.end();
    };
    return has(printer.kinds, effect.kind) || has(printer.axes, effect.covariate.axis);
  });
}

void run(const Printer& printer, bool small, unsigned seed, Tally& tally) {
  const std::array<double, 3> size_a =
      small ? std::array<double, 3>{12, 12, 2.1} : std::array<double, 3>{24, 24, 4.1};
  const std::array<double, 3> size_b =
      small ? std::array<double, 3>{11, 12, 1.9} : std::array<double, 3>{20, 22, 3.5};
  MeasuredJob a = part("a", size_a, 0);
  print(printer, a, seed);
  print(printer, a, seed + 1000);
  MeasuredJob b = part("b", size_b, 1);
  print(printer, b, seed + 2000);
  MeasuredJob truth = b;
  truth.prints.clear();
  print(printer, truth, 0);
  std::int64_t best = 0;
  std::int64_t solid = 0;
  for (std::size_t k = 0; k < b.masks.size(); ++k) {
    for (int y = 0; y < truth.prints[0][k]->height(); ++y) {
      for (int x = 0; x < truth.prints[0][k]->width(); ++x) {
        best += truth.prints[0][k]->at(x, y) != b.prints[0][k]->at(x, y) ? 1 : 0;
      }
    }
    solid += b.prints[0][k]->count();
  }
  const auto start = std::chrono::steady_clock::now();
  Listener listener;
  if (std::getenv("BINDERJET_TALK") != nullptr) {
    listener.on_note = [](const std::string& what) { fmt::print("    {}\n", what); };
  }
  a.work = Work(listener);
  const Calibration found = calibrate(a, {b}, declared(), {});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string list;
  for (const FoundEffect& effect : found.effects) {
    list += fmt::format(" {}({} {}; p {:.3f}", effect.kind, word(effect.covariate.axis),
                        word(effect.covariate.form), effect.p);
    for (const auto& [name, values] : effect.parameters) {
      list += fmt::format(" {}={:.4g}", name, fmt::join(values, ","));
    }
    list += ")";
    for (const std::string& rival : effect.rivals) list += " or " + rival;
  }
  const double floor = static_cast<double>(best) / static_cast<double>(solid);
  const PrintError& before = found.scores[0].before;
  const PrintError& after = found.scores[0].after;
  const double avoidable = before.wrong - floor;
  const double gone = avoidable <= 0 ? 1 : (before.wrong - after.wrong) / avoidable;
  const bool right = is_right(printer, found.effects);
  ++tally.total;
  tally.right += right ? 1 : 0;
  tally.gone += gone >= 0.8 ? 1 : 0;
  fmt::print("{:5} {:20} {:11} {:.4f} -> {:.4f} (best {:.4f}) gone {:5.2f}  {:5.1f} s {}\n",
             right ? "right" : "WRONG", printer.name, word(found.verdict), before.wrong,
             after.wrong, floor, gone, seconds, list);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i, const char* otherwise) {
    return std::string(argc > i ? argv[i] : otherwise);
  };
  const bool small = argument(1, "small") == "small";
  const std::string set = argument(2, "catalogue");
  const std::string name = argument(3, "");
  const int seeds = std::stoi(argument(4, "1"));
  std::vector<Printer> printers;
  if (set == "catalogue") printers = catalogue(1);
  if (set == "half") printers = catalogue(0.5);
  if (set == "nameless") printers = nameless();
  if (set == "pairs") printers = pairs();
  if (set == "null") printers.emplace_back().name = "nothing";
  Tally tally;
  for (const Printer& printer : printers) {
    if (!name.empty() && printer.name.find(name) == std::string::npos) continue;
    for (int seed = 1; seed <= seeds; ++seed)
      run(printer, small, static_cast<unsigned>(seed), tally);
  }
  fmt::print("{} of {} right; in {} at least 80 % of the avoidable error is gone\n", tally.right,
             tally.total, tally.gone);
}
