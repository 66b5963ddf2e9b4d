// SPDX-License-Identifier: MIT
/// Places and draws the parts of one panel: names above it, axis ticks beside it, and the legend below it.
#pragma once
#include <string>
#include <vector>

#include "record/plot.hpp"
#include "record/svg.hpp"

namespace hapticd::record {

class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, double width);
  double height() const;  ///< [px] height of the panel with names and legend
  void draw(Svg& svg, double left, double top) const;

 private:
  struct Entry {
    std::string name, colour, label;
    enum class Kind { kLine, kDot, kDash, kBlock, kText } kind = Kind::kLine;
  };
  struct Placed {
    size_t index;
    double x;
    size_t row;
  };
  struct Box {
    double left, top, right, bottom;
    bool meets(const Box& o) const { return left < o.right && o.left < right && top < o.bottom && o.top < bottom; }
  };

  double x(double value) const;
  double y(double value) const;
  double inner() const { return width_ - kLeft - kRight; }
  void placeLegend();
  void placeMoments();
  void drawAxes(Svg& svg) const;
  void drawLegend(Svg& svg, double top) const;
  void drawMoments(Svg& svg) const;
  void drawCurve(Svg& svg, const Curve& curve) const;
  void drawDots(Svg& svg, const Curve& curve) const;
  void drawBars(Svg& svg, const Bars& bars) const;
  void drawPoints(Svg& svg) const;

  static constexpr double kLeft = 62, kRight = 20, kRow = 15, kSize = 11;
  const Panel& panel_;
  double width_;
  std::vector<Entry> entries_;
  std::vector<Placed> legend_, moments_;
  size_t legend_rows_ = 0, moment_rows_ = 0;
  mutable double left_ = 0, top_ = 0;  // [px] corner of the area between the axes, while it is drawn
};

}  // namespace hapticd::record
