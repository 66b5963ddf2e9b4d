// SPDX-License-Identifier: MIT
#include "model_warnings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "corner_slips.hpp"
#include "cusp_warnings.hpp"
#include "document.hpp"
#include "kernels/trace/side_curve.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;
using spline::SurfaceData;

template <class... T>
std::string written(const char* format, T... values) {
  char text[320];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

Path surfaceAt(std::size_t surface, const char* key = nullptr) {
  Path path{{"surfaces", 0}, {"", surface}};
  if (key != nullptr) path.push_back({key, 0});
  return path;
}

/// Returns the path of the control point that is farthest from the origin of the model's frame.
Path farthestPoint(const ModelFile& file, const std::vector<bool>* sound = nullptr) {
  Path farthest{{"surfaces", 0}};
  double most = 0;
  for (std::size_t i = 0; i < file.surfaces.size(); ++i) {
    if (sound != nullptr && (i >= sound->size() || !(*sound)[i])) continue;
    const auto& points = file.surfaces[i].points;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (points[k].norm() > most) {
        most = points[k].norm();
        farthest = surfaceAt(i, "points");
        farthest.push_back({"", k});
      }
  }
  return farthest;
}

void warnOfSize(double size, const Path& at, Problems& odd) {
  constexpr double kHuge = 5, kTiny = 1e-3;        // [m] sizes beyond these are unusual
  if (size > kHuge || (size > 0 && size < kTiny))  // a size of 0 is reported as surfaces without area
    odd.add(at, written("the model is %.3g m large; a hand feels models from 0.001 to 5 m, and lengths "
                        "must be in m: %.3g mm is %.3g m",
                        size, size, size / 1000));
}

void warnOfNames(const ModelFile& file, Problems& odd) {
  std::map<std::string, std::size_t> first;
  for (std::size_t i = 0; i < file.surfaces.size(); ++i) {
    const std::string& name = file.surfaces[i].name;
    const auto [known, is_new] = first.emplace(name, i);
    if (!name.empty() && !is_new)
      odd.add(surfaceAt(i, "name"), written("\"%.100s\" is also the name of surfaces[%zu]; each name must be used "
                                            "once, because edges and messages refer to it",
                                            name.c_str(), known->second));
  }
}

/// Warns of a weight that is so large that its neighbours in the net have no effect.
void warnOfWeights(const SurfaceData& surface, std::size_t index, Problems& odd) {
  constexpr double kTimes = 1000;
  const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
  const auto judge = [&](std::size_t a, std::size_t b) {
    const std::size_t heavy = surface.weights[a] > surface.weights[b] ? a : b, light = a + b - heavy;
    if (surface.weights[heavy] <= kTimes * surface.weights[light]) return false;
    Path at = surfaceAt(index, "weights");
    at.push_back({"", heavy});
    odd.add(at,
            written("%.4g is %.3g times the neighbouring weight (%.4g), so the surface is pulled into this point; "
                    "weights are usually about 1",
                    surface.weights[heavy], surface.weights[heavy] / surface.weights[light], surface.weights[light]));
    return true;
  };
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t at = i * columns + j;
      if ((j + 1 < columns && judge(at, at + 1)) || (i + 1 < rows && judge(at, at + columns))) return;
    }
}

/// Returns the length in m of all lines of a control net. `along_u` and `along_v` are the distances in the list between
/// neighbours.
double lengthOfNet(const SurfaceData& surface, std::size_t along_u, std::size_t along_v) {
  const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
  double length = 0;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      const Vector3d& at = surface.points[i * along_u + j * along_v];
      if (i + 1 < rows) length += (surface.points[(i + 1) * along_u + j * along_v] - at).norm();
      if (j + 1 < columns) length += (surface.points[i * along_u + (j + 1) * along_v] - at).norm();
    }
  return length;
}

/// Returns true if some lines of a control net that face each other across a cell run in opposite directions.
bool runsToAndFro(const SurfaceData& surface, std::size_t along_u, std::size_t along_v) {
  const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
  const auto& p = surface.points;
  for (std::size_t i = 0; i + 1 < rows; ++i)
    for (std::size_t j = 0; j + 1 < columns; ++j) {
      const std::size_t a = i * along_u + j * along_v, b = a + along_u, c = a + along_v, d = b + along_v;
      if ((p[b] - p[a]).dot(p[d] - p[c]) < 0 || (p[c] - p[a]).dot(p[d] - p[b]) < 0) return true;
    }
  return false;
}

/// Warns of a control net whose points were written with u fastest. Read with v fastest, its lines run to and fro, so
/// they are longer.
void warnOfOrder(const SurfaceData& surface, std::size_t index, Problems& odd) {
  constexpr double kShorter = 0.8, kBitShorter = 0.95;
  const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
  const double as_read = lengthOfNet(surface, columns, 1), turned = lengthOfNet(surface, 1, rows);
  const bool folded =
      turned < kBitShorter * as_read && runsToAndFro(surface, columns, 1) && !runsToAndFro(surface, 1, rows);
  if (folded || turned < kShorter * as_read)
    odd.add(surfaceAt(index, "points"),
            written("the points seem to be listed with u fastest: as read, the lines of the net of %zu by %zu run to "
                    "and fro, %.3g times as long; expected all points of the first u, then of the next: v runs fastest",
                    rows, columns, as_read / turned));
}

/// Warns of a control point that is far away from all its neighbours: a coordinate with its decimal point elsewhere.
void warnOfSpikes(const SurfaceData& surface, std::size_t index, Problems& odd) {
  constexpr double kTimes = 4;  // the longest line of the rest of the net
  const auto rows = static_cast<std::size_t>(surface.count(0)), columns = static_cast<std::size_t>(surface.count(1));
  struct Line {
    std::size_t a, b;
    double length;
  };
  std::vector<Line> lines;
  const auto add = [&](std::size_t a, std::size_t b) {
    lines.push_back({a, b, (surface.points[a] - surface.points[b]).norm()});
  };
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      if (i + 1 < rows) add(i * columns + j, (i + 1) * columns + j);
      if (j + 1 < columns) add(i * columns + j, i * columns + j + 1);
    }
  if (rows < 3 || columns < 3) return;
  // Only an end of the longest line can be such a point.
  const Line longest =
      *std::max_element(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.length < b.length; });
  for (const std::size_t point : {longest.a, longest.b}) {
    double own = longest.length, other = 0;
    for (const Line& line : lines)
      if (line.a == point || line.b == point)
        own = std::min(own, line.length);
      else
        other = std::max(other, line.length);
    if (own <= kTimes * other || !(other > 0)) continue;
    Path at = surfaceAt(index, "points");
    at.push_back({"", point});
    return odd.add(at, written("lies %.3g m away from its neighbours, which are at most %.3g m apart; is its decimal "
                               "point in the right place?",
                               own, other));
  }
}

/// Finds two sides that begin at a common corner and end near each other: their other corners were probably meant to be
/// the same. Surfaces that are apart on purpose, such as a lid above its pot, share no corner.
class Gaps {
 public:
  /// @param known pairs of surfaces whose gap is reported already
  Gaps(const trace::Model& model, const ModelFile& file, std::set<std::pair<std::size_t, std::size_t>> known,
       Problems& odd)
      : model_(model), file_(file), odd_(odd), known_(std::move(known)) {
    for (int patch = 0; patch < model.patchCount(); ++patch)
      for (int side = 0; side < trace::kSides; ++side)
        if (model.patch(patch).side(side).kind == trace::SideKind::kFree) {
          for (const int end : {0, 1}) free_at_[cornerOf({patch, side}, end)].push_back({{patch, side}, end});
          free_.push_back({patch, side});
        }
  }

  void tell() {
    // most sides at one corner that are compared; checkAlone() is left out if there are more than eight times as many
    // free sides
    constexpr std::size_t kMost = 64;
    for (const auto& [corner, ends] : free_at_)
      for (std::size_t i = 0; i < std::min(ends.size(), kMost); ++i)
        for (std::size_t j = i + 1; j < std::min(ends.size(), kMost); ++j) judge(ends[i], ends[j]);
    if (free_.size() > 8 * kMost) return;
    for (int patch = 0; patch < model_.patchCount(); ++patch) checkAlone(patch);
  }

 private:
  static constexpr double kNear = 0.1;  ///< greatest distance of corners that are near, as a share of the shorter side
  struct SideOf {
    int patch, side;
  };
  struct End {
    SideOf of;
    int end;
  };

  int cornerOf(const SideOf& of, int end) const {
    const int corner = trace::Patch::endsOf(of.side)[static_cast<std::size_t>(end)];
    return model_.patch(of.patch).corners[static_cast<std::size_t>(corner)];
  }
  Vector3d at(const SideOf& of, int end, double share) const {
    return trace::pointOnSide(model_.patch(of.patch), of.side, end == 0 ? share : 1 - share);
  }

  void judge(const End& a, const End& b) {
    if (a.of.patch == b.of.patch || cornerOf(a.of, 1 - a.end) == cornerOf(b.of, 1 - b.end)) return;
    const auto length = [this](const End& one) { return (at(one.of, one.end, 1) - at(one.of, one.end, 0)).norm(); };
    const double near = kNear * std::min(length(a), length(b));
    const double gap = (at(a.of, a.end, 1) - at(b.of, b.end, 1)).norm();
    if (gap > near || (at(a.of, a.end, 0.5) - at(b.of, b.end, 0.5)).norm() > near) return;
    const int source = model_.patch(a.of.patch).source, other = model_.patch(b.of.patch).source;
    if (known_.contains(
            {static_cast<std::size_t>(std::min(source, other)), static_cast<std::size_t>(std::max(source, other))}))
      return;
    if (source == other || !told_.insert(std::max(source, other)).second) return;
    odd_.add(surfaceAt(static_cast<std::size_t>(std::max(source, other))),
             written("there is a gap between %.80s and %.80s: two of their sides share one corner, but their other "
                     "ends are %.3g mm apart; is a coordinate mistyped?",
                     nameOf(std::max(source, other)).c_str(), nameOf(std::min(source, other)).c_str(), 1e3 * gap));
  }

  /// Returns the patch of another surface whose free side runs beside this one; -1 if there is none.
  int besideOf(const SideOf& one) const {
    const double near = kNear * (at(one, 0, 1) - at(one, 0, 0)).norm();
    for (const SideOf& other : free_) {
      if (model_.patch(other.patch).source == model_.patch(one.patch).source) continue;
      for (const int end : {0, 1})
        if ((at(one, 0, 0) - at(other, end, 0)).norm() <= near && (at(one, 0, 1) - at(other, end, 1)).norm() <= near)
          return other.patch;
    }
    return -1;
  }

  /// Finds a face that joins no other face although other surfaces surround it: the whole face is probably misplaced.
  /// Two parallel sheets do not count, because each has only one neighbour.
  void checkAlone(int patch) {
    constexpr std::size_t kRound = 3;
    std::set<int> beside;
    for (int side = 0; side < trace::kSides; ++side) {
      const bool open = model_.patch(patch).side(side).kind == trace::SideKind::kFree;
      const int other = open ? besideOf({patch, side}) : -1;
      if (other < 0) return;
      beside.insert(other);
    }
    if (beside.size() < kRound) return;
    const int source = model_.patch(patch).source;
    odd_.add(surfaceAt(static_cast<std::size_t>(source)),
             written("%.80s joins none of the %zu surfaces round it, although all its sides run beside theirs; they "
                     "should have common corners: is a coordinate mistyped?",
                     nameOf(source).c_str(), beside.size()));
  }

  std::string nameOf(int source) const {
    const std::string& name = file_.surfaces[static_cast<std::size_t>(source)].name;
    return name.empty() ? "surface " + std::to_string(source) : "'" + name + "'";
  }

  const trace::Model& model_;
  const ModelFile& file_;
  Problems& odd_;
  std::set<std::pair<std::size_t, std::size_t>> known_;
  std::vector<SideOf> free_;
  std::set<int> told_;                       ///< surfaces that have been reported
  std::map<int, std::vector<End>> free_at_;  ///< by corner: the free sides that end there
};

}  // namespace

namespace {

/// Judges one surface by itself.
void warnOfSurface(const SurfaceData& surface, std::size_t index, Problems& odd) {
  if (spline::hasNoArea(surface))
    odd.add(surfaceAt(index, "points"),
            "all points lie in one place or on one line, so the surface has no area and cannot be felt");
  warnOfOrder(surface, index, odd);
  warnOfSpikes(surface, index, odd);
  if (!surface.weights.empty()) warnOfWeights(surface, index, odd);
  warnOfCusps(surface, index, odd);
}

}  // namespace

std::vector<std::string> warnOfSurfaces(const ModelFile& file, const std::vector<bool>& sound, const std::string& text,
                                        const std::string& name) {
  Problems odd(name, text);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < sound.size() && i < file.surfaces.size(); ++i)
    if (sound[i])
      for (const Vector3d& point : file.surfaces[i].points) box.extend(point);
  if (!box.isEmpty()) warnOfSize(box.diagonal().norm(), farthestPoint(file, &sound), odd);
  for (std::size_t i = 0; i < sound.size() && i < file.surfaces.size() && !odd.full(); ++i)
    if (sound[i]) warnOfSurface(file.surfaces[i], i, odd);
  warnOfNames(file, odd);
  return odd.texts();
}

std::vector<std::string> warnOfModel(const ModelFile& file, const trace::Model& model, const std::string& text,
                                     const std::string& name) {
  Problems odd(name, text);
  warnOfSize(model.bounds().diagonal().norm(), farthestPoint(file), odd);
  for (std::size_t i = 0; i < file.surfaces.size() && !odd.full(); ++i) warnOfSurface(file.surfaces[i], i, odd);
  warnOfNames(file, odd);
  Gaps(model, file, warnOfCornerSlips(file, odd), odd).tell();
  return odd.texts();
}

std::vector<std::string> warnOfJoints(const ModelFile& file, const trace::Model& model, const std::string& text,
                                      const std::string& name) {
  Problems odd(name, text);
  for (const std::string& warning : model.warnings()) {
    std::size_t last = 0, at = 0;  // the surface that is named last, and where
    for (std::size_t i = 0; i < file.surfaces.size(); ++i) {
      const std::string& own = file.surfaces[i].name;
      const std::string named = own.empty() ? "surface " + std::to_string(i) + " " : "surface '" + own + "'";
      if (const std::size_t found = warning.rfind(named); found != std::string::npos && found >= at)
        last = i, at = found;
    }
    odd.add(surfaceAt(last), warning);
  }
  return odd.texts();
}

}  // namespace hapticd
