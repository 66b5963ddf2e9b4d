// SPDX-License-Identifier: MIT
#include "record/plot.hpp"

#include <algorithm>

#include "record/plot_panel.hpp"

namespace hapticd::record {

namespace {

constexpr double kTop = 36;  ///< [px] height for the picture's title

}  // namespace

const std::string& colourOf(size_t index) {
  static const std::vector<std::string> kColours{"#1f5fa8", "#d1495b", "#2a9d5c", "#8a5fbf",
                                                 "#e08a1e", "#3aa6b9", "#777"};
  return kColours[index % kColours.size()];
}

std::string Picture::svg() const {
  double width = 0, height = kTop;
  for (const double column : widths_) width += column;
  std::vector<double> rows;
  for (size_t i = 0; i < panels_.size(); ++i) {
    if (i % widths_.size() == 0) rows.push_back(0);
    rows.back() = std::max(rows.back(), PanelDrawing(panels_[i], widths_[i % widths_.size()]).height());
  }
  for (const double row : rows) height += row;
  Svg svg(width, height + 6);
  svg.label(14, 22, title_, "start", "#222", 15);
  double top = kTop;
  for (size_t row = 0; row < rows.size(); top += rows[row++]) {
    double left = 0;
    for (size_t column = 0; column < widths_.size() && row * widths_.size() + column < panels_.size(); ++column) {
      PanelDrawing(panels_[row * widths_.size() + column], widths_[column]).draw(svg, left, top);
      left += widths_[column];
    }
  }
  return svg.finished();
}

}  // namespace hapticd::record
