// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Fig. 12 on a golf ball: the volume enhanced or not, the color enhanced or not, under
// diffuse light, where only color shows, and under a lamp, where shape does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "driver/job/mask_source.h"
#include "slicer/coupon/coupon.h"
#include "slicer/enhance/masks.h"
#include "slicer/model/printer_model.h"
#include "slicer/stack/png.h"
#include "tests/support/picture.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

// The printed ball from above: how high it is and what color is there, for each voxel column.
struct View {
  int width = 0;
  int height = 0;
  std::vector<int> top;        // layer; -1 is powder
  std::vector<double> bright;  // of the color there, 0 to 1

  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  // The half of the ball's width in the middle, where nothing is seen from the side.
  bool inside(int x, int y) const {
    return std::hypot(x - width / 2.0, (y - height / 2.0) * width / height) < width / 4.0;
  }
};

class PaperColor : public testing::Test {
 protected:
  PaperColor() { write_stl(coupon(CouponKind::kGolfBall), place_ / "ball.stl"); }

  View view(const std::vector<std::string>& options) const {
    std::vector<std::string> words = {"slice", place_ / "ball.stl",  "--scale", "0.3", "-p", "z450",
                                      "-o",    place_ / "ball.bjob", "-q"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(place_.run(words).status, 0);
    const MaskSource job = open_job(place_ / "ball.bjob", Console{});
    const PrinterModel model(job.header->profile.effects, job.header->grid);
    const auto& detail = job.header->grid.detail_vx;
    View view;
    view.width = job.size_px[0] * detail[0];
    view.height = job.size_px[1] * detail[1];
    view.top.assign(view.place(0, view.height), -1);
    view.bright.assign(view.top.size(), 1);
    for (int k = 0; k < job.size_px[2]; ++k) {
      const RunLayer printed = model.print(job.read(k));
      const std::vector<std::byte> color = job.color ? job.color(k) : std::vector<std::byte>();
      for (int y = 0; y < view.height; ++y) {
        const auto row = printed.row(y);
        for (std::size_t i = 0; i < row.size(); i += 2) {
          for (int x = row[i]; x < row[i + 1]; ++x) {
            view.top[view.place(x, y)] = k;
            if (color.empty()) continue;
            const auto pixel =
                static_cast<std::size_t>(y / detail[1] * job.size_px[0] + x / detail[0]);
            view.bright[view.place(x, y)] = std::to_integer<int>(color[3 * pixel]) / 255.0;
          }
        }
      }
    }
    grid_ = job.header->grid;
    return view;
  }

  // What a lamp on the left does to a surface of one color, 0 to 1; the slope is taken over a few
  // voxels, for layers are steps.
  double lamp(const View& view, int x, int y) const {
    constexpr int kSpan = 4;
    const auto high = [&](int dx, int dy) {
      return view.top[view.place(x + dx, y + dy)] * grid_.pitch_mm[2];
    };
    const double sx = (high(kSpan, 0) - high(-kSpan, 0)) / (2 * kSpan * grid_.voxel_mm(0));
    const double sy = (high(0, kSpan) - high(0, -kSpan)) / (2 * kSpan * grid_.voxel_mm(1));
    return std::clamp((0.7 - 0.7 * sx) / std::sqrt(sx * sx + sy * sy + 1), 0.0, 1.0);
  }

  // How much the light that comes back varies from place to place: its deviation over its mean.
  template <class Light>
  double contrast(const View& view, Light light) const {
    double sum = 0;
    double squares = 0;
    double count = 0;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        if (!view.inside(x, y)) continue;
        const double value = light(view, x, y);
        sum += value;
        squares += value * value;
        ++count;
      }
    }
    const double mean = sum / count;
    return std::sqrt(squares / count - mean * mean) / mean;
  }

  template <class Light>
  void draw(const View& view, const std::string& name, Light light) const {
    constexpr int kScale = 2;  // and a voxel's height is two thirds of its width
    const int width = kScale * view.width;
    const int height = kScale * view.height * 2 / 3;
    std::vector<std::byte> rgb;
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const int x = column / kScale;
        const int y = (height - 1 - row) * 3 / 2 / kScale;
        const double value = view.inside(x, y) ? light(view, x, y) : 1;
        rgb.insert(rgb.end(), 3, static_cast<std::byte>(std::lround(255 * value)));
      }
    }
    write_file(pictures::folder("fig_12") + "/" + name + ".png",
               encode_png_rgb(rgb, width, height, {0.1, 0.1}));
  }

  Workplace place_;
  mutable Grid grid_;
};

TEST_F(PaperColor, ShowsInDiffuseLightAndVolumeUnderALampAndBothInEither) {
  const auto diffuse = [](const View& view, int x, int y) { return view.bright[view.place(x, y)]; };
  const auto direct = [&](const View& view, int x, int y) {
    return diffuse(view, x, y) * lamp(view, x, y);
  };
  struct Panel {
    std::string name;
    std::vector<std::string> options;
    double diffuse = 0;
    double direct = 0;
  };
  std::vector<Panel> panels = {{"original", {"--enhance", "none"}},
                               {"color", {"--enhance", "none", "--color-enhance"}},
                               {"volume", {"--enhance", "paper"}},
                               {"both", {"--enhance", "paper", "--color-enhance"}}};
  std::cout << "contrast          diffuse   lamp\n";
  for (Panel& panel : panels) {
    const View seen = view(panel.options);
    panel.diffuse = contrast(seen, diffuse);
    panel.direct = contrast(seen, direct);
    std::cout << fmt::format("{:<16} {:8.4f} {:8.4f}\n", panel.name, panel.diffuse, panel.direct);
    draw(seen, panel.name + "_diffuse", diffuse);
    draw(seen, panel.name + "_lamp", direct);
  }
  const auto& [original, color, volume, both] =
      std::tie(panels[0], panels[1], panels[2], panels[3]);
  // White powder in even light shows nothing, whatever its shape.
  EXPECT_LT(original.diffuse, 1e-9);
  EXPECT_LT(volume.diffuse, 1e-9);
  EXPECT_GT(color.diffuse, 0.01);
  EXPECT_GT(both.diffuse, 0.01);
  EXPECT_GT(both.direct, original.direct);
  EXPECT_GT(both.direct, volume.direct);
}

}  // namespace
}  // namespace binderjet
