// SPDX-License-Identifier: GPL-3.0-or-later
// A table of caliper readings of a made-up printer, with the errors that one asks for.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <random>
#include <string>

namespace binderjet {

// What a made-up printer does to 20 x 15 x 10 mm blocks, four batches of eight.
struct MeasuredBlocks {
  double offset_mm = 0.5;
  double scale = 0;
  double slip_y_mm = 0;   // of the third reading
  double column_mm = 0;   // in x, per column of four parts
  double part_mm = 0.05;  // standard deviations
  double reading_mm = 0.05;
};

inline void write_readings(const std::string& path, const MeasuredBlocks& blocks, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::ofstream file(path);
  file << "# made up\nbatch,part,rep,nominal_x,nominal_y,nominal_z,meas_x,meas_y,meas_z\n";
  for (int batch = 1; batch <= 4; ++batch) {
    for (int part = 1; part <= 8; ++part) {
      const double part_error = blocks.part_mm * normal(random);
      for (int rep = 1; rep <= 3; ++rep) {
        const double nominal[] = {20, 15, 10};
        double measured[3];
        for (int a = 0; a < 3; ++a) {
          measured[a] = nominal[a] * (1 + blocks.scale) + blocks.offset_mm + 0.1 * batch +
                        part_error + blocks.reading_mm * normal(random);
        }
        measured[0] += blocks.column_mm * ((part - 1) / 4);
        measured[1] += rep == 3 ? blocks.slip_y_mm : 0;
        file << fmt::format("{},{},{},20,15,10,{:.3f},{:.3f},{:.3f}\n", batch, part, rep,
                            measured[0], measured[1], measured[2]);
      }
    }
  }
}

}  // namespace binderjet
