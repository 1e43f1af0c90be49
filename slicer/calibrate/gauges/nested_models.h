// SPDX-License-Identifier: GPL-3.0-or-later
// Linear models that grow term by term, each judged on groups of readings that its fit did not see.
//
//   e0(g), e1(g)   the squared error of group g without and with the term, g left out of both fits
//   t = mean(e0 - e1) / (deviation of e0 - e1 / sqrt(groups))
//
// Groups are left out and not readings, because readings of one part lean together (one caliper,
// one layer that slipped) and would vouch for each other.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <string>
#include <vector>

namespace binderjet {

// A way to spell out a term: its columns, one row per reading.
struct TermForm {
  std::string name;  // "offset", "x", "3 to a column"
  Eigen::MatrixXd columns;
  std::vector<std::string> names;  // one per column
};

// A step of the ladder. Where a term has several forms, all with as many columns, the form is
// chosen anew for each group that is left out, from the others only, so that the choice is held out
// too.
struct Term {
  std::string name;
  std::vector<TermForm> forms;
  bool replaces = false;  // takes the place of what is in, rather than being added
};

// What a term did, on readings that the fit did not see.
struct Rung {
  std::string name;
  std::string form;    // the one that fits all readings best
  int parameters = 0;  // of the whole model so far
  double rms = 0;
  double median = 0;  // of absolute errors
  double t = 0;       // of the gain per group over the best model so far (paired)
  double p = 1;       // two-sided (Student)
  double gain = 0;    // share of the squared error gone
  bool accepted = false;
};

struct Ladder {
  double rms_without = 0;  // no model at all: the readings themselves
  double median_without = 0;
  std::vector<Rung> rungs;
  Eigen::MatrixXd design;  // of what was accepted
  struct Column {
    std::string term, name;
  };
  std::vector<Column> columns;      // of the design
  Eigen::VectorXd coefficients;     // fitted to all readings
  Eigen::VectorXd standard_errors;  // by groups (sandwich), so that readings of a part count once
  Eigen::VectorXd heldout;          // reading - prediction of the fit without its group
};

// Terms are taken in order; one stays if the gain over what is in has t >= 2 over the groups and is
// at least `min_gain` of the squared error (a practical floor fixed beforehand).
Ladder climb(const Eigen::VectorXd& readings, std::span<const int> groups,
             std::span<const Term> terms, double min_gain);

// reading - prediction, each group predicted from the others. Columns that the others do not
// determine count as nothing (least norm).
Eigen::VectorXd leave_group_out(const Eigen::MatrixXd& design, const Eigen::VectorXd& readings,
                                std::span<const int> groups);

double rms(const Eigen::VectorXd& errors);
double median_absolute(const Eigen::VectorXd& errors);

}  // namespace binderjet
