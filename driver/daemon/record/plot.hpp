// SPDX-License-Identifier: MIT
/// Plots: panels with axes, curves, bars, named points and marks. All pictures of the project are made of them. Names
/// stand around a panel, never on top of what is drawn in it.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "record/plot_axis.hpp"

namespace hapticd::record {

/// Points in order; a NaN interrupts the line. Where many points share a pixel column their range is drawn, so that no
/// peak is lost.
struct Curve {
  std::string name;  ///< "": not in the legend
  std::string colour;
  std::vector<double> x, y;
  double width = 1.6;
  bool dots = false;  ///< draws one dot per point and no line
};

/// A histogram: counts[i] from edges[i] to edges[i + 1].
struct Bars {
  std::string colour;
  std::vector<double> edges, counts;
};

/// A named line across the panel, at a moment or a bound.
struct Mark {
  double at = 0;
  std::string name, colour = "#c0392b";
};

/// A named point; its label stands beside it, its name in the legend.
struct NamedPoint {
  double x = 0, y = 0;
  std::string label, name, colour = "#222";
  double half = 3.5;             ///< [px]
  double x_low = 0, x_high = 0;  ///< an interval of x, drawn if it has a length
};

/// A part of the x axis during which something holds, drawn as a strip at the foot of the panel.
struct Span {
  double from = 0, to = 0;
  std::string name, colour;
};

struct Panel {
  Panel() = default;
  Panel(std::string title_of_it, Axis x_axis, Axis y_axis, std::vector<Curve> curves_in_it = {})
      : title(std::move(title_of_it)), x(std::move(x_axis)), y(std::move(y_axis)), curves(std::move(curves_in_it)) {}

  std::string title;
  Axis x, y;
  std::vector<Curve> curves{};
  std::vector<Bars> bars{};
  std::vector<NamedPoint> points{};
  std::vector<Mark> moments{}, bounds{};  ///< along x, along y
  std::vector<Span> spans{};              ///< only one of the same name is in the legend
  double height = 200;                    ///< [px] of the area between the axes
};

/// A colour for each of a few things.
const std::string& colourOf(size_t index);

class Picture {
 public:
  /// @param widths of the columns [px]; panels fill them row by row
  Picture(std::string title, std::vector<double> widths) : title_(std::move(title)), widths_(std::move(widths)) {}
  void add(Panel panel) { panels_.push_back(std::move(panel)); }
  std::string svg() const;

 private:
  std::string title_;
  std::vector<double> widths_;
  std::vector<Panel> panels_;
};

}  // namespace hapticd::record
