// SPDX-License-Identifier: MIT
/// A small writer of SVG with the functions that plots need. Coordinates are in pixels, and y points down.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

namespace hapticd::record {

class Svg {
 public:
  Svg(double width, double height)
      : text_(fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
            "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\">\n"
            "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
            width, height)) {}

  void line(double x1, double y1, double x2, double y2, const char* colour, double width = 1) {
    text_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x1, y1,
        x2, y2, colour, width);
  }
  void dashes(double x1, double y1, double x2, double y2, const char* colour) {
    text_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-dasharray=\"5 3\"/>\n", x1,
        y1, x2, y2, colour);
  }
  void rectangle(double x, double y, double width, double height, const char* fill) {
    text_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", x, y,
                         width, height, fill);
  }
  /// Writes a text. @param anchor start, middle or end: the part of the text that is at x
  void label(double x, double y, const std::string& words, const char* anchor = "start", const char* colour = "#444",
             int size = 12) {
    text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\" font-size=\"{}\">{}</text>\n",
                         x, y, anchor, colour, size, escaped(words));
  }
  /// Draws a polyline through the points x0, y0, x1, y1, ...
  void curve(const std::vector<double>& xy, const char* colour, double width = 1) {
    text_ += fmt::format(
        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" points=\"", colour, width);
    for (size_t i = 0; i + 1 < xy.size(); i += 2) text_ += fmt::format("{:.1f},{:.1f} ", xy[i], xy[i + 1]);
    text_ += "\"/>\n";
  }
  std::string finished() const { return text_ + "</svg>\n"; }

 private:
  static std::string escaped(const std::string& words) {
    std::string safe;
    for (const char c : words) safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return safe;
  }
  std::string text_;
};

}  // namespace hapticd::record
