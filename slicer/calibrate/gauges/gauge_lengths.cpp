// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/gauge_lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "slicer/base/error.h"
#include "slicer/calibrate/gauges/length_blocks.h"

namespace binderjet {
namespace {

// What the steps of the ladder are called.
const std::string kGrowth = "growth";
const std::string kLayerShift = "layer shift";
const std::string kBedPlace = "place on the bed";
const std::string kScale = "scale";  // a form of growth

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The readings of the blocks one by one, axis by axis.
struct Readings {
  std::vector<const LengthBlock*> block;
  std::vector<std::size_t> axis;
  VectorXd error;
  std::vector<int> part;  // the group that is held out: a part of a batch

  Readings(const std::vector<LengthBlock>& blocks, const std::vector<std::size_t>& axes) {
    std::map<std::pair<std::string, std::string>, int> parts;
    for (const LengthBlock& b : blocks) {
      const int group =
          parts.try_emplace({b.batch, b.part}, static_cast<int>(parts.size())).first->second;
      for (const std::size_t a : axes) {
        block.push_back(&b);
        axis.push_back(a);
        part.push_back(group);
      }
    }
    error.resize(static_cast<Eigen::Index>(block.size()));
    for (std::size_t i = 0; i < block.size(); ++i) {
      error[static_cast<Eigen::Index>(i)] = block[i]->error[axis[i]];
    }
  }
  int parts() const { return part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1; }

  // One column per value of a label, holding `value` where the label is that; "" is in no column.
  TermForm form(const std::string& name,
                const std::function<std::string(const LengthBlock&, std::size_t)>& label,
                const std::function<double(const LengthBlock&, std::size_t)>& value) const {
    TermForm out{name, {}, {}};
    std::vector<std::optional<Eigen::Index>> places;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const std::string key = label(*block[i], axis[i]);
      places.emplace_back();
      if (key.empty()) continue;
      const auto known = std::find(out.names.begin(), out.names.end(), key);
      places.back() = known - out.names.begin();
      if (known == out.names.end()) out.names.push_back(key);
    }
    out.columns = MatrixXd::Zero(error.size(), static_cast<Eigen::Index>(out.names.size()));
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (const auto place = places[i]) {
        out.columns(static_cast<Eigen::Index>(i), *place) = value(*block[i], axis[i]);
      }
    }
    return out;
  }
};

double one(const LengthBlock&, std::size_t) { return 1; }
double nominal(const LengthBlock& block, std::size_t axis) { return block.nominal[axis]; }
std::string batch_label(const LengthBlock& block, std::size_t) { return "batch " + block.batch; }
std::string axis_label(const LengthBlock&, std::size_t axis) { return kAxisNames[axis]; }

// Which reading, on one axis only; the first is what the others are compared with.
std::function<std::string(const LengthBlock&, std::size_t)> reading_label(
    std::size_t wanted, const std::string& first) {
  return [=](const LengthBlock& block, std::size_t axis) {
    if (axis != wanted || block.reading == first) return std::string();
    return fmt::format("{}, reading {} against {}", kAxisNames[axis], block.reading, first);
  };
}

// Less the mean over its batch and axis, so that a column cannot stand in for growth.
TermForm centered(TermForm form, const Readings& readings) {
  std::map<std::pair<std::string, std::size_t>, std::vector<Eigen::Index>> cells;
  for (std::size_t i = 0; i < readings.block.size(); ++i) {
    cells[{readings.block[i]->batch, readings.axis[i]}].push_back(static_cast<Eigen::Index>(i));
  }
  for (const auto& [cell, rows] : cells) {
    const MatrixXd own = form.columns(rows, Eigen::all);
    form.columns(rows, Eigen::all) = own.rowwise() - own.colwise().mean();
  }
  return form;
}

Term reading_term(const Readings& readings, const std::vector<std::size_t>& axes,
                  const std::string& first, bool per_batch) {
  Term term{per_batch ? kLayerShift + " per batch" : kLayerShift, {}};
  for (const std::size_t a : axes) {
    const auto label = reading_label(a, first);
    const auto per = [=](const LengthBlock& block, std::size_t axis) {
      const std::string key = label(block, axis);
      return key.empty() || !per_batch ? key : key + ", batch " + block.batch;
    };
    term.forms.push_back(
        centered(readings.form(fmt::format("along {}", kAxisNames[a]), per, one), readings));
  }
  return term;
}

// Where the part lay: measured, or its number counted into columns or rows of every length.
std::vector<TermForm> position_forms(const Readings& readings) {
  std::vector<TermForm> forms;
  const auto add = [&](const std::string& name,
                       const std::function<double(const LengthBlock&)>& place) {
    VectorXd all(readings.error.size());
    for (std::size_t i = 0; i < readings.block.size(); ++i) {
      all[static_cast<Eigen::Index>(i)] = place(*readings.block[i]);
    }
    const double mean = all.mean();
    if ((all.array() - mean).abs().maxCoeff() < 1e-9) return;
    forms.push_back(readings.form(name, axis_label, [&](const LengthBlock& block, std::size_t) {
      return place(block) - mean;
    }));
  };
  const auto all_have = [&](auto has) {
    return std::all_of(readings.block.begin(), readings.block.end(),
                       [&](const LengthBlock* block) { return has(*block); });
  };
  for (std::size_t a = 0; a < 2; ++a) {
    if (!all_have([&](const LengthBlock& b) { return b.position_mm[a].has_value(); })) continue;
    add(fmt::format("pos_{}", kAxisNames[a]),
        [a](const LengthBlock& b) { return *b.position_mm[a]; });
  }
  if (!forms.empty() || !all_have([](const LengthBlock& b) { return b.number.has_value(); }))
    return forms;
  constexpr int kLongest = 5;  // parts in a column; longer ones look like the number itself
  for (int n = 2; n <= kLongest; ++n) {
    add(fmt::format("{} parts to a column", n),
        [n](const LengthBlock& b) { return std::floor((*b.number - 1) / n); });
    add(fmt::format("{} parts to a row", n),
        [n](const LengthBlock& b) { return std::fmod(*b.number - 1, n); });
  }
  return forms;
}

std::vector<BatchGrowth> growth_by_batch(const std::vector<LengthBlock>& blocks,
                                         const std::vector<std::size_t>& axes,
                                         const std::string& first_reading) {
  std::vector<BatchGrowth> all;
  for (const std::string& batch : batches_of(blocks)) {
    std::vector<LengthBlock> own;
    std::copy_if(blocks.begin(), blocks.end(), std::back_inserter(own),
                 [&](const LengthBlock& block) { return block.batch == batch; });
    const Readings readings(own, axes);
    if (readings.parts() < 3) continue;
    // Of several readings the later ones may lie where layers slipped; that is not growth.
    const auto rms_with = [&](const std::function<double(const LengthBlock&, std::size_t)>& value) {
      const MatrixXd growth = readings.form("", batch_label, value).columns;
      const MatrixXd slipped =
          readings.form("", reading_label(axes.front(), first_reading), one).columns;
      MatrixXd design(growth.rows(), growth.cols() + slipped.cols());
      design << growth, slipped;
      return rms(leave_group_out(design, readings.error, readings.part));
    };
    all.push_back({batch, rms_with(one), rms_with(nominal)});
  }
  return all;
}

// Mean residual over the readings that share a label.
LengthFindings::Profile profile(
    const std::string& name, const Readings& readings, const VectorXd& after,
    const std::function<std::string(const LengthBlock&, std::size_t)>& label) {
  LengthFindings::Profile out{name, {}, {}, {}, {}};
  const TermForm labels = readings.form(name, label, one);
  out.labels = labels.names;
  for (Eigen::Index i = 0; i < labels.columns.cols(); ++i) {
    const VectorXd column = labels.columns.col(i);
    out.before_mm.push_back(column.dot(readings.error) / column.sum());
    out.after_mm.push_back(column.dot(after) / column.sum());
    out.readings.push_back(static_cast<int>(std::lround(column.sum())));
  }
  return out;
}

double spread_of_readings(const Readings& readings) {
  std::map<std::pair<int, std::size_t>, std::vector<double>> same;
  for (std::size_t i = 0; i < readings.block.size(); ++i) {
    same[{readings.part[i], readings.axis[i]}].push_back(
        readings.error[static_cast<Eigen::Index>(i)]);
  }
  double squares = 0;
  double freedom = 0;
  for (const auto& [key, errors] : same) {
    double mean = 0;
    for (const double e : errors) mean += e / static_cast<double>(errors.size());
    for (const double e : errors) squares += (e - mean) * (e - mean);
    freedom += static_cast<double>(errors.size()) - 1;
  }
  return freedom > 0 ? std::sqrt(squares / freedom) : 0;
}

}  // namespace

std::optional<LengthTerm> length_term(const Rung& rung) {
  if (rung.name.starts_with(kGrowth)) {
    return rung.form == kScale ? LengthTerm::kScale : LengthTerm::kOffset;
  }
  if (rung.name.starts_with(kLayerShift)) return LengthTerm::kLayerShift;
  if (rung.name == kBedPlace) return LengthTerm::kBedPlace;
  return std::nullopt;
}

bool has_lengths(const GaugeTable& table) { return !axes_in(table).empty(); }

int LengthFindings::offset_batches() const {
  return static_cast<int>(std::count_if(growth.begin(), growth.end(), [](const BatchGrowth& b) {
    return b.offset_rms < b.scale_rms;
  }));
}

LengthFindings trace_lengths(const GaugeTable& table, const LengthRules& rules) {
  LengthFindings found;
  const std::vector<std::size_t> axes = axes_in(table);
  std::vector<LengthBlock> blocks = blocks_of(table);
  found.rows = static_cast<int>(blocks.size());
  drop_broken(blocks, rules.drop_mm, found.dropped);
  const std::string first_reading = blocks.empty() ? "" : blocks.front().reading;
  found.growth = growth_by_batch(blocks, axes, first_reading);
  keep_one_layout(blocks, found.dropped);
  found.used_rows = static_cast<int>(blocks.size());
  const Readings readings(blocks, axes);
  if (readings.parts() < 3) {
    throw Error(ErrorKind::kBadInput, table.path,
                "has too few usable parts to hold one out; at least three are needed");
  }
  std::vector<Term> terms;
  terms.push_back(
      {kGrowth + " per batch",
       {readings.form("offset", batch_label, one), readings.form(kScale, batch_label, nominal)}});
  terms.push_back({kGrowth + " per batch and axis",
                   {readings.form(
                       "offset",
                       [](const LengthBlock& block, std::size_t axis) {
                         return fmt::format("batch {}, {}", block.batch, kAxisNames[axis]);
                       },
                       one)},
                   true});
  Term shift = reading_term(readings, axes, first_reading, false);
  const bool several_readings = shift.forms.front().columns.cols() > 0;
  if (several_readings) terms.push_back(std::move(shift));
  std::vector<TermForm> positions = position_forms(readings);
  if (!positions.empty()) terms.push_back({kBedPlace, std::move(positions)});
  if (several_readings && batches_of(blocks).size() > 1) {
    terms.push_back(reading_term(readings, axes, first_reading, true));
  }
  found.ladder = climb(readings.error, readings.part, terms, rules.min_gain);
  found.floor_rms = spread_of_readings(readings);
  const VectorXd& after = found.ladder.heldout;
  found.profiles.push_back(profile("axis", readings, after, axis_label));
  found.profiles.push_back(profile("batch", readings, after, batch_label));
  for (const std::size_t shown : axes) {
    const std::string axis_name = kAxisNames[shown];
    found.profiles.push_back(profile(
        "reading, " + axis_name, readings, after, [&](const LengthBlock& block, std::size_t axis) {
          return axis == shown && !block.reading.empty() ? "reading " + block.reading
                                                         : std::string();
        }));
    found.profiles.push_back(profile(
        "part, " + axis_name, readings, after, [&](const LengthBlock& block, std::size_t axis) {
          return axis == shown && block.number ? "part " + block.part : std::string();
        }));
  }
  return found;
}

}  // namespace binderjet
