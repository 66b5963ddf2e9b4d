// SPDX-License-Identifier: MIT
/// Plots: panels with axes, curves, bars, named points and marks. All pictures of the project use them. Names are drawn
/// outside of a panel, so that they never cover its curves.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "record/plot_axis.hpp"

namespace hapticd::record {

/// A curve through points in their order; a NaN interrupts it. If many points fall into the same column of pixels,
/// their range is drawn, so that no peak is lost.
struct Curve {
  std::string name;  ///< name in the legend; "" for none
  std::string colour;
  std::vector<double> x, y;
  double width = 1.6;
  bool dots = false;  ///< true: draws a dot for each point, and no line
};

/// A histogram: a bar of height counts[i] from edges[i] to edges[i + 1].
struct Bars {
  std::string colour;
  std::vector<double> edges, counts;
};

/// A named line across the panel: at a moment (on the x axis) or at a bound (on the y axis).
struct Mark {
  double at = 0;
  std::string name, colour = "#c0392b";
};

/// A named point. Its label is drawn beside it, and its name is in the legend.
struct NamedPoint {
  double x = 0, y = 0;
  std::string label, name, colour = "#222";
  double half = 3.5;             ///< [px] half of its size
  double x_low = 0, x_high = 0;  ///< an interval of x, drawn if it has a length
};

/// An interval of the x axis in which something is true, drawn as a strip at the bottom of the panel.
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
  std::vector<Mark> moments{}, bounds{};  ///< moments: marks at values of x; bounds: marks at values of y
  std::vector<Span> spans{};              ///< spans with the same name are in the legend once
  double height = 200;                    ///< [px] height of the area between the axes
};

/// Returns one of several colours, which repeat for larger indices.
const std::string& colourOf(size_t index);

class Picture {
 public:
  /// @param widths [px] widths of the columns; panels fill the columns row by row
  Picture(std::string title, std::vector<double> widths) : title_(std::move(title)), widths_(std::move(widths)) {}
  void add(Panel panel) { panels_.push_back(std::move(panel)); }
  std::string svg() const;

 private:
  std::string title_;
  std::vector<double> widths_;
  std::vector<Panel> panels_;
};

}  // namespace hapticd::record
