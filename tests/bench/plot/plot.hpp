// SPDX-License-Identifier: MIT
/// Plots of the benches: panels with axes, curves, bars and a legend, in one SVG file.
#pragma once
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "record/svg.hpp"

namespace hapticd::plot {

struct Axis {
  std::string label;
  double low = 0, high = 1;
  bool logarithmic = false;

  /// 0 at the low end, 1 at the high one.
  double place(double value) const {
    if (!logarithmic) return (value - low) / (high - low);
    return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
  }
  std::vector<double> ticks() const {
    std::vector<double> at;
    if (logarithmic) {
      for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high * 1.001; decade *= 10)
        for (const double factor : {1.0, 2.0, 5.0})
          if (decade * factor >= low * 0.999 && decade * factor <= high * 1.001) at.push_back(decade * factor);
      return at;
    }
    const double raw = (high - low) / 6, power = std::pow(10, std::floor(std::log10(raw)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0})
      if (raw <= factor * power) step = factor * power;
    for (double v = std::ceil(low / step - 1e-9) * step; v <= high + step * 1e-6; v += step)
      at.push_back(std::abs(v) < step * 1e-6 ? 0 : v);
    return at;
  }
};

/// Points of a curve; a not-a-number lifts the pen.
struct Curve {
  std::string name;  ///< "": not in the legend
  std::string colour;
  std::vector<double> x, y;
  double width = 1.6;
  bool dots = false;  ///< a dot a point and no line
};

inline const std::vector<std::string>& colours() {
  static const std::vector<std::string> list{"#1f5fa8", "#d1495b", "#2a9d5c", "#8a5fbf", "#e08a1e", "#3aa6b9", "#777"};
  return list;
}

class Picture {
 public:
  static constexpr double kLeft = 62, kBelow = 44, kAbove = 30, kGap = 22;

  Picture(const std::string& title, int columns, int rows, double width = 420, double height = 260)
      : columns_(columns), width_(width), height_(height), svg_(columns * width + kGap, rows * height + 34) {
    svg_.label(14, 22, title, "start", "#222", 15);
  }

  /// Draws the next panel, row by row.
  void panel(const std::string& title, const Axis& x, const Axis& y, const std::vector<Curve>& curves,
             bool legend_right = true) {
    begin(title, x, y);
    double line = top_ + 14;
    for (const Curve& curve : curves) {
      if (curve.dots) {
        dots(curve, x, y);
      } else {
        lines(curve, x, y);
      }
      if (curve.name.empty()) continue;
      const double at = legend_right ? left_ + inner_ - 8 : left_ + 8;
      svg_.label(at, line, curve.name, legend_right ? "end" : "start", curve.colour.c_str(), 11);
      line += 14;
    }
  }

  /// A histogram: counts[i] in the bin from low + i * width on.
  void histogram(const std::string& title, const Axis& x, const Axis& y, double low, double bin,
                 const std::vector<double>& counts, const char* colour) {
    begin(title, x, y);
    for (size_t i = 0; i < counts.size(); ++i) {
      const double x0 = left_ + inner_ * x.place(low + bin * static_cast<double>(i));
      const double x1 = left_ + inner_ * x.place(low + bin * static_cast<double>(i + 1));
      const double h = deep_ * std::clamp(y.place(counts[i]), 0.0, 1.0);
      if (h > 0) svg_.rectangle(x0, top_ + deep_ - h, std::max(0.5, x1 - x0 - 0.6), h, colour);
    }
  }

  /// Throws where the file cannot be written.
  void save(const std::string& file) const {
    std::ofstream out(file, std::ios::binary);
    if (!(out << svg_.finished()) || !out.flush()) throw std::runtime_error(file + ": cannot be written");
  }

 private:
  void begin(const std::string& title, const Axis& x, const Axis& y) {
    const int column = next_ % columns_, row = next_ / columns_;
    ++next_;
    left_ = column * width_ + kLeft, top_ = row * height_ + 34 + kAbove;
    inner_ = width_ - kLeft - kGap, deep_ = height_ - kAbove - kBelow;
    svg_.label(left_, top_ - 10, title, "start", "#222", 13);
    for (const double v : x.ticks()) {
      const double at = left_ + inner_ * x.place(v);
      svg_.line(at, top_, at, top_ + deep_, "#e4e4e4");
      svg_.label(at, top_ + deep_ + 14, text(v), "middle", "#444", 10);
    }
    for (const double v : y.ticks()) {
      const double at = top_ + deep_ * (1 - y.place(v));
      svg_.line(left_, at, left_ + inner_, at, "#e4e4e4");
      svg_.label(left_ - 5, at + 3, text(v), "end", "#444", 10);
    }
    svg_.line(left_, top_ + deep_, left_ + inner_, top_ + deep_, "#888");
    svg_.line(left_, top_, left_, top_ + deep_, "#888");
    svg_.label(left_ + inner_ / 2, top_ + deep_ + 30, x.label, "middle", "#444", 11);
    svg_.label(left_ + inner_, top_ - 10, y.label, "end", "#444", 11);
  }

  static std::string text(double v) {
    if (std::abs(v) >= 1e4) return fmt::format("{:g}k", v / 1e3);
    return fmt::format("{:g}", v);
  }

  void lines(const Curve& curve, const Axis& x, const Axis& y) {
    std::vector<double> pen;
    const auto lift = [&] {
      if (pen.size() >= 4) svg_.curve(pen, curve.colour.c_str(), curve.width);
      pen.clear();
    };
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
        lift();
        continue;
      }
      pen.push_back(left_ + inner_ * std::clamp(x.place(curve.x[i]), 0.0, 1.0));
      pen.push_back(top_ + deep_ * (1 - std::clamp(y.place(curve.y[i]), 0.0, 1.0)));
    }
    lift();
  }

  void dots(const Curve& curve, const Axis& x, const Axis& y) {
    for (size_t i = 0; i < curve.x.size(); ++i) {
      const double px = x.place(curve.x[i]), py = y.place(curve.y[i]);
      if (px < 0 || px > 1 || py < 0 || py > 1 || !std::isfinite(px + py)) continue;
      svg_.rectangle(left_ + inner_ * px - curve.width, top_ + deep_ * (1 - py) - curve.width, 2 * curve.width,
                     2 * curve.width, curve.colour.c_str());
    }
  }

  int columns_, next_ = 0;
  double width_, height_, left_ = 0, top_ = 0, inner_ = 0, deep_ = 0;
  record::Svg svg_;
};

}  // namespace hapticd::plot
