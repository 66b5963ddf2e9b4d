// SPDX-License-Identifier: MIT
#include "record/plot_panel.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace hapticd::record {

namespace {

constexpr const char *kGrid = "#e4e4e4", *kInk = "#444", *kAxis = "#888";
constexpr double kTitle = 18, kLabel = 20, kBelow = 36;

/// Returns the approximate width [px] of a text; a character of several bytes in UTF-8 counts once.
double widthOf(const std::string& text, double size) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
  return 0.56 * size * static_cast<double>(characters);
}

}  // namespace

PanelDrawing::PanelDrawing(const Panel& panel, double width) : panel_(panel), width_(width) {
  using Kind = Entry::Kind;
  for (const Curve& c : panel.curves)
    if (!c.name.empty()) entries_.push_back({c.name, c.colour, "", c.dots ? Kind::kDot : Kind::kLine});
  for (const Mark& bound : panel.bounds) entries_.push_back({bound.name, bound.colour, "", Kind::kDash});
  std::set<std::string> named;
  for (const Span& span : panel.spans)
    if (!span.name.empty() && named.insert(span.name).second)
      entries_.push_back({span.name, span.colour, "", Kind::kBlock});
  for (const NamedPoint& point : panel.points)
    if (!point.name.empty()) entries_.push_back({point.name, point.colour, point.label, Kind::kText});
  placeLegend();
  placeMoments();
}

/// Places the names of the legend from left to right. A name that does not fit begins a new row.
void PanelDrawing::placeLegend() {
  double at = 0;
  for (size_t i = 0; i < entries_.size(); ++i) {
    const double need = 26 + widthOf(entries_[i].name, kSize) + 14;
    if (at > 0 && at + need > inner() + kRight) at = 0, ++legend_rows_;
    legend_.push_back({i, at, legend_rows_});
    at += need;
  }
  if (!entries_.empty()) ++legend_rows_;
}

/// Places each name of a moment above its line, in the first row in which it does not overlap another name.
void PanelDrawing::placeMoments() {
  std::vector<double> ends;
  for (size_t i = 0; i < panel_.moments.size(); ++i) {
    const Mark& mark = panel_.moments[i];
    const double need = widthOf(mark.name, kSize) + 8;
    const double at = std::clamp(inner() * panel_.x.share(mark.at), 0.0, std::max(0.0, inner() + kRight - need));
    size_t row = 0;
    while (row < ends.size() && ends[row] > at) ++row;
    if (row == ends.size()) ends.push_back(0);
    ends[row] = at + need;
    moments_.push_back({i, at, row});
  }
  moment_rows_ = ends.size();
}

double PanelDrawing::height() const {
  const double above = (panel_.title.empty() ? 0 : kTitle) + kLabel + kRow * static_cast<double>(moment_rows_);
  return above + panel_.height + kBelow + kRow * static_cast<double>(legend_rows_) + 14;
}

double PanelDrawing::x(double value) const {
  return left_ + inner() * std::clamp(panel_.x.share(value), 0.0, 1.0);
}

double PanelDrawing::y(double value) const {
  return top_ + panel_.height * (1 - std::clamp(panel_.y.share(value), 0.0, 1.0));
}

void PanelDrawing::draw(Svg& svg, double left, double top) const {
  if (!panel_.title.empty()) svg.label(left + 14, top + 13, panel_.title, "start", "#222", 13);
  left_ = left + kLeft;
  top_ = top + (panel_.title.empty() ? 0 : kTitle) + kLabel + kRow * static_cast<double>(moment_rows_);
  drawAxes(svg);
  for (const Span& span : panel_.spans)
    svg.rectangle(x(span.from), top_ + panel_.height - 6, std::max(1.0, x(span.to) - x(span.from)), 6,
                  span.colour.c_str());
  for (const Bars& bars : panel_.bars) drawBars(svg, bars);
  for (const Curve& curve : panel_.curves) curve.dots ? drawDots(svg, curve) : drawCurve(svg, curve);
  for (const Mark& bound : panel_.bounds)
    svg.dashes(left_, y(bound.at), left_ + inner(), y(bound.at), bound.colour.c_str());
  drawMoments(svg);
  drawPoints(svg);
  drawLegend(svg, top_ + panel_.height + kBelow + 10);
}

void PanelDrawing::drawAxes(Svg& svg) const {
  const double bottom = top_ + panel_.height, right = left_ + inner();
  for (const double v : panel_.x.ticks(static_cast<size_t>(inner() / 52))) {
    svg.line(x(v), top_, x(v), bottom, kGrid);
    svg.label(x(v), bottom + 14, tickText(v), "middle", kInk, 10);
  }
  for (const double v : panel_.y.ticks(static_cast<size_t>(std::max(2.0, panel_.height / 22)))) {
    svg.line(left_, y(v), right, y(v), v == 0 ? kAxis : kGrid);
    svg.label(left_ - 5, y(v) + 3, tickText(v), "end", kInk, 10);
  }
  svg.line(left_, bottom, right, bottom, kAxis);
  svg.line(left_, top_, left_, bottom, kAxis);
  svg.label(left_ + inner() / 2, bottom + 30, panel_.x.label, "middle", kInk, 11);
  const double line = kRow * static_cast<double>(moment_rows_);
  svg.label(left_ - 34, top_ - 10 - line, panel_.y.label, "start", kInk, 11);
}

void PanelDrawing::drawMoments(Svg& svg) const {
  for (const Placed& placed : moments_) {
    const Mark& mark = panel_.moments[placed.index];
    const double base = top_ - 7 - kRow * static_cast<double>(moment_rows_ - 1 - placed.row);
    svg.dashes(x(mark.at), base, x(mark.at), top_ + panel_.height, mark.colour.c_str());
    svg.label(left_ + placed.x + 3, base, mark.name, "start", mark.colour.c_str(), static_cast<int>(kSize));
  }
}

void PanelDrawing::drawLegend(Svg& svg, double top) const {
  using Kind = Entry::Kind;
  for (const Placed& placed : legend_) {
    const Entry& entry = entries_[placed.index];
    const double at = left_ + placed.x, line = top + kRow * static_cast<double>(placed.row);
    const char* colour = entry.colour.c_str();
    if (entry.kind == Kind::kLine) svg.line(at, line - 4, at + 20, line - 4, colour, 2);
    if (entry.kind == Kind::kDash) svg.dashes(at, line - 4, at + 20, line - 4, colour);
    if (entry.kind == Kind::kDot) svg.rectangle(at + 7, line - 7, 6, 6, colour);
    if (entry.kind == Kind::kBlock) svg.rectangle(at, line - 8, 20, 8, colour);
    if (entry.kind == Kind::kText) svg.label(at + 20, line, entry.label, "end", colour, static_cast<int>(kSize));
    svg.label(at + 26, line, entry.name, "start", kInk, static_cast<int>(kSize));
  }
}

void PanelDrawing::drawCurve(Svg& svg, const Curve& curve) const {
  std::vector<double> pen;
  const auto lift = [&] {
    if (pen.size() >= 4) svg.curve(pen, curve.colour.c_str(), curve.width);
    pen.clear();
  };
  const auto finite = [&](size_t i) { return std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]); };
  for (size_t i = 0; i < curve.x.size();) {
    if (!finite(i)) {
      lift();
      ++i;
      continue;
    }
    const double column = std::floor(x(curve.x[i]));
    const size_t first = i;
    double low = curve.y[i], high = low;
    for (; i < curve.x.size() && finite(i) && std::floor(x(curve.x[i])) == column; ++i)
      low = std::min(low, curve.y[i]), high = std::max(high, curve.y[i]);
    pen.insert(pen.end(), {x(curve.x[first]), y(low)});
    if (i - first > 1) pen.insert(pen.end(), {x(curve.x[i - 1]), y(high)});
  }
  lift();
}

void PanelDrawing::drawDots(Svg& svg, const Curve& curve) const {
  for (size_t i = 0; i < curve.x.size(); ++i) {
    const double px = panel_.x.share(curve.x[i]), py = panel_.y.share(curve.y[i]);
    if (!std::isfinite(px + py) || px < 0 || px > 1 || py < 0 || py > 1) continue;
    svg.rectangle(x(curve.x[i]) - curve.width, y(curve.y[i]) - curve.width, 2 * curve.width, 2 * curve.width,
                  curve.colour.c_str());
  }
}

void PanelDrawing::drawBars(Svg& svg, const Bars& bars) const {
  const double bottom = top_ + panel_.height;
  for (size_t i = 0; i < bars.counts.size(); ++i)
    if (const double top = y(bars.counts[i]); top < bottom)
      svg.rectangle(x(bars.edges[i]), top, std::max(0.5, x(bars.edges[i + 1]) - x(bars.edges[i]) - 0.6), bottom - top,
                    bars.colour.c_str());
}

/// Draws points, then their labels. Each label gets the nearest place at which it covers no point and no other label.
void PanelDrawing::drawPoints(Svg& svg) const {
  std::vector<Box> taken;
  for (const NamedPoint& p : panel_.points) {
    if (p.x_high > p.x_low) {
      svg.line(x(p.x_low), y(p.y), x(p.x_high), y(p.y), p.colour.c_str());
      taken.push_back({x(p.x_low), y(p.y) - 1, x(p.x_high), y(p.y) + 1});
    }
    svg.rectangle(x(p.x) - p.half, y(p.y) - p.half, 2 * p.half, 2 * p.half, p.colour.c_str());
    taken.push_back({x(p.x) - p.half, y(p.y) - p.half, x(p.x) + p.half, y(p.y) + p.half});
  }
  for (const NamedPoint& p : panel_.points) {
    const double wide = widthOf(p.label, kSize) + 2, px = x(p.x), py = y(p.y);
    Box box{};
    for (int ring = 1, side = 0; ring < 12; side == 7 ? side = 0, ++ring : ++side) {
      const double angle = M_PI / 4 * side, far = p.half + 3 + 7 * (ring - 1);
      const double cx = px + std::cos(angle) * (far + wide / 2), cy = py - std::sin(angle) * (far + kSize / 2);
      box = {cx - wide / 2, cy - kSize / 2, cx + wide / 2, cy + kSize / 2};
      const bool inside =
          box.left > left_ && box.right < left_ + inner() && box.top > top_ - 8 && box.bottom < top_ + panel_.height;
      if (inside && std::none_of(taken.begin(), taken.end(), [&](const Box& other) { return box.meets(other); })) break;
    }
    taken.push_back(box);
    const double cx = (box.left + box.right) / 2, cy = (box.top + box.bottom) / 2;
    if (std::hypot(cx - px, cy - py) > p.half + wide / 2 + 16) svg.line(px, py, cx, cy, "#bbb", 0.7);
    svg.label(cx, cy + 4, p.label, "middle", p.colour.c_str(), static_cast<int>(kSize));
  }
}

}  // namespace hapticd::record
