// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/gauge_slots.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "slicer/model/effects/candidates.h"
#include "slicer/model/printer_model.h"

namespace binderjet {
namespace {

constexpr double kWidestMm = 5;  // no gauge that hides is wider

double predict(const PrinterModel& model, const Grid& grid, const GaugeReading& reading) {
  return reading.nominal_mm > 0
             ? print_gauge(model, grid, reading.kind, reading.axis, reading.nominal_mm).mean_mm
             : visible_from_mm(model, grid, reading.kind, reading.axis, kWidestMm);
}

std::vector<double> predict(const std::vector<EffectSpec>& effects, const Grid& grid,
                            const std::vector<GaugeReading>& readings) {
  const PrinterModel model(effects, grid);
  std::vector<double> predicted;
  for (const GaugeReading& reading : readings) predicted.push_back(predict(model, grid, reading));
  return predicted;
}

struct Misfit {
  double rms_mm = 0;
  double squares = 0;  // in units of each reading's uncertainty
  bool agrees = true;
};

Misfit misfit(const std::vector<GaugeReading>& readings, const std::vector<double>& predicted) {
  Misfit out;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double off = readings[i].measured_mm - predicted[i];
    const double of_uncertainty = off / readings[i].uncertainty_mm;
    out.rms_mm += off * off / static_cast<double>(readings.size());
    out.squares += of_uncertainty * of_uncertainty;
    out.agrees = out.agrees && std::abs(of_uncertainty) <= 1;
  }
  out.rms_mm = std::sqrt(out.rms_mm);
  return out;
}

// The place of the least value; a grid prints many values alike, and of those it is the middle one.
std::size_t min_of(const std::vector<double>& values) {
  const double least = *std::min_element(values.begin(), values.end());
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] <= least + 1e-9) places.push_back(i);
  }
  return places[places.size() / 2];
}

// predicted[value][reading]; each reading with the value that fits the others best.
double heldout_rms(const std::vector<GaugeReading>& readings,
                   const std::vector<std::vector<double>>& predicted) {
  double squares = 0;
  for (std::size_t left_out = 0; left_out < readings.size(); ++left_out) {
    std::vector<double> misfits;
    for (const std::vector<double>& one : predicted) {
      misfits.push_back(0);
      for (std::size_t i = 0; i < readings.size(); ++i) {
        const double off = (readings[i].measured_mm - one[i]) / readings[i].uncertainty_mm;
        misfits.back() += i == left_out ? 0 : off * off;
      }
    }
    const double error = readings[left_out].measured_mm - predicted[min_of(misfits)][left_out];
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(readings.size()));
}

Explanation explain(const GaugeChange& change, const Grid& grid,
                    const std::vector<GaugeReading>& readings) {
  std::vector<std::vector<double>> predicted(change.values.size());
  oneapi::tbb::parallel_for(std::size_t{0}, change.values.size(), [&](std::size_t i) {
    predicted[i] = predict(change.with(change.values[i]), grid, readings);
  });
  std::vector<Misfit> misfits;
  for (const std::vector<double>& one : predicted) misfits.push_back(misfit(readings, one));
  std::vector<double> squares;
  for (const Misfit& one : misfits) squares.push_back(one.squares);
  const auto best = misfits.begin() + static_cast<std::ptrdiff_t>(min_of(squares));
  Explanation out;
  out.kind = change.kind;
  out.value = change.values[static_cast<std::size_t>(best - misfits.begin())];
  out.text = change.text(out.value);
  out.effects = change.with(out.value);
  out.predicted_mm = predicted[static_cast<std::size_t>(best - misfits.begin())];
  out.heldout_rms_mm = heldout_rms(readings, predicted);
  out.rms_mm = best->rms_mm;
  out.agrees = best->agrees;
  out.changed_numbers = change.numbers;
  // As good as the best: agreeing with all readings, or else within one standard error of the best.
  const auto good = [&](const Misfit& m) {
    return best->agrees ? m.agrees : m.squares <= best->squares + 1;
  };
  out.low = out.high = out.value;
  for (auto m = best; good(*m); --m) {
    out.low = change.values[static_cast<std::size_t>(m - misfits.begin())];
    if (m == misfits.begin()) break;
  }
  for (auto m = best; m != misfits.end() && good(*m); ++m) {
    out.high = change.values[static_cast<std::size_t>(m - misfits.begin())];
  }
  return out;
}

std::vector<Discriminator> tell_apart(const std::vector<Explanation>& explanations,
                                      const Grid& grid) {
  constexpr double kOuterMm = 10;
  std::vector<PrinterModel> models;
  for (const Explanation& e : explanations) models.emplace_back(e.effects, grid);
  std::vector<Discriminator> out;
  const auto add = [&](const std::string& gauge, GaugeKind kind, int axis, double width) {
    Discriminator d{gauge, {}, 0};
    for (const PrinterModel& model : models) {
      d.predicted_mm.push_back(print_gauge(model, grid, kind, axis, width).mean_mm);
    }
    d.difference_mm = std::abs(d.predicted_mm[0] - d.predicted_mm[1]);
    out.push_back(std::move(d));
  };
  for (const int axis : {0, 1}) {
    const char name = static_cast<char>('x' + axis);
    add(fmt::format("outer width of {:g} mm in {}", kOuterMm, name), GaugeKind::kWall, axis,
        kOuterMm);
    for (const double width : {0.3, 0.5, 1.0, 1.5}) {
      add(fmt::format("wall of {:g} mm in {}", width, name), GaugeKind::kWall, axis, width);
    }
    for (const double width : {1.0, 1.5}) {
      add(fmt::format("slot of {:g} mm in {}", width, name), GaugeKind::kSlot, axis, width);
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Discriminator& a, const Discriminator& b) {
    return a.difference_mm > b.difference_mm + 1e-9;
  });
  return out;
}

}  // namespace

SlotFindings trace_slots(std::vector<GaugeReading> readings,
                         const std::vector<EffectSpec>& declared, const Grid& grid) {
  SlotFindings found;
  found.readings = std::move(readings);
  found.declared_mm = predict(declared, grid, found.readings);
  const Misfit before = misfit(found.readings, found.declared_mm);
  found.declared_rms_mm = before.rms_mm;
  found.declared_agrees = before.agrees;
  if (before.agrees) return found;
  for (const GaugeChange& change : all_gauge_changes(declared)) {
    found.explanations.push_back(explain(change, grid, found.readings));
  }
  // Of those that agree, the one that changes the least numbers: more could agree with anything.
  std::stable_sort(found.explanations.begin(), found.explanations.end(),
                   [](const Explanation& a, const Explanation& b) {
                     if (a.agrees != b.agrees) return a.agrees;
                     return a.agrees ? a.changed_numbers < b.changed_numbers : a.rms_mm < b.rms_mm;
                   });
  if (found.explanations.size() > 1) found.discriminators = tell_apart(found.explanations, grid);
  return found;
}

}  // namespace binderjet
