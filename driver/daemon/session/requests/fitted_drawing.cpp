// SPDX-License-Identifier: MIT
#include "session/requests/fitted_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hapticd::servo {
namespace {

/// Default chord error as a share of the model's size; and the one that is tried first if the client says how many
/// triangles it can use: less than a pixel of a screen that the model fills.
constexpr double kChordShare = 0.005, kFineChordShare = 0.001;
constexpr std::size_t kFineTriangles = 4;  ///< a fine drawing takes at most one in so many of the triangles allowed
constexpr double kDefaultChord = 1e-3;     ///< [m] default chord error if the model does not report its size
constexpr double kLargestChord = 1;        ///< [m] largest tolerance that a request may ask for
constexpr std::size_t kFewest = 100;       ///< any model can be reduced to so few triangles
constexpr const char* kNoTriangles =
    "the model cannot be drawn, because its plugin gives no triangles (extension hsp.geometry/1); it can still be felt";

/// Rounds up to two digits, so that the number that a message prints is the number that was tried.
double roundedUp(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / digit * (1 - 1e-9)) * digit;
}

class Fitting {
 public:
  Fitting(const host::ShapeInstance& shape, const DrawingWish& wish, const DrawingRoom& room)
      : shape_(shape), wish_(wish), room_(room) {}

  Result<Drawing> run() {
    if (shape_.geometry() == nullptr) return Error{kNoTriangles};
    if (wish_.tolerance > 0) return within(wish_.tolerance);
    const double size = shape_.report().size_m;
    const double usual = size > 0 ? kChordShare * size : kDefaultChord;
    if (wish_.triangles > 0 && rigid() && size > 0 && cutBy(kFineChordShare * size) &&
        mesh_.triangle_count <= wish_.triangles / kFineTriangles && fits(mesh_))
      return whole();
    if (const auto cut = cutBy(shape_.contour() != nullptr ? 0 : usual); !cut) return Error{cut.error()};
    if (fits(mesh_)) return whole();
    if (!rigid()) return shape_.contour() != nullptr ? tooMany(usual) : doubled(usual);
    Drawing drawing = reduced();
    drawing.tolerance += drawing.reduced->off;
    return drawing;
  }

 private:
  bool rigid() const { return (shape_.description().flags & HSP_C_DEFORMS) == 0 && shape_.contour() == nullptr; }

  /// Lets the plugin make its triangles.
  Result<void> cutBy(double chord) {
    chord_ = chord;
    if (shape_.tessellate(chord, mesh_) < 0)
      return Error{fmt::format("the plugin of the model gives no valid triangles for a chord error of {:g} m", chord)};
    if (mesh_.triangle_count == 0) return Error{kNoTriangles};
    if (!room_.normals || !finiteNormals()) mesh_.normals = nullptr;
    if (first_.struct_size == 0) first_ = mesh_;
    return {};
  }

  bool finiteNormals() const {
    return mesh_.normals != nullptr && std::all_of(mesh_.normals, mesh_.normals + 3 * std::size_t{mesh_.vertex_count},
                                                   [](float number) { return std::isfinite(number); });
  }

  bool fits(const hsp_mesh& mesh) const {
    const bool few = wish_.triangles == 0 || mesh.triangle_count <= wish_.triangles || !rigid();
    return few && room_.fits(mesh);
  }

  Drawing whole() const { return {mesh_, std::nullopt, chord_}; }

  /// Reduces the plugin's triangles to a number that fits. Its tolerance lacks what the reduction adds.
  Drawing reduced() const {
    const drawing::MeshReducer reducer(mesh_);
    std::size_t most = room_.bytes / room_.bytes_per_triangle;
    if (wish_.triangles > 0) most = std::min(most, wish_.triangles);
    Drawing drawing{mesh_, std::nullopt, chord_};
    for (;; most = most / 4 * 3) {
      drawing.reduced = reducer.reduce(std::max(most, kFewest));
      if (most <= kFewest || fits(drawing.mesh())) return drawing;
    }
  }

  /// Tries to draw within a tolerance. If the plugin's own triangles do not fit, it gets one half of the tolerance, and
  /// the reduction the other.
  Result<Drawing> tried(double tolerance) {
    if (const auto cut = cutBy(tolerance); !cut) return Error{cut.error()};
    if (fits(mesh_)) return whole();
    if (!rigid()) return Error{""};
    if (const auto cut = cutBy(tolerance / 2); !cut) return Error{cut.error()};
    Drawing drawing = reduced();
    off_ = drawing.reduced->off;
    drawing.tolerance += off_;
    if (drawing.tolerance <= tolerance) return drawing;
    return Error{""};
  }

  Result<Drawing> within(double tolerance) {
    auto drawing = tried(tolerance);
    return drawing || !drawing.error().empty() ? std::move(drawing) : tooMany(tolerance);
  }

  /// Draws with the least of the tolerances 2, 4, 8... times as large that fits.
  Result<Drawing> doubled(double tolerance) {
    for (double more = 2 * tolerance; more <= kLargestChord; more *= 2)
      if (auto drawing = tried(more); drawing || !drawing.error().empty()) return drawing;
    return tooMany(tolerance);
  }

  /// Says that nothing fits within a tolerance, and which one works. That one was tried.
  Error tooMany(double tolerance) {
    const std::string text = fmt::format("{} vertices and {} triangles do not fit into the {} bytes of an answer",
                                         first_.vertex_count, first_.triangle_count, room_.bytes);
    while (tolerance < kLargestChord) {
      tolerance = std::min(roundedUp(std::max(2 * tolerance, 2 * off_)), kLargestChord);
      const auto drawing = tried(tolerance);
      if (drawing) return Error{fmt::format("{}\n  fix: ask for a larger tolerance, such as {:g} m", text, tolerance)};
      if (!drawing.error().empty()) break;
    }
    return Error{text};
  }

  const host::ShapeInstance& shape_;
  const DrawingWish& wish_;
  const DrawingRoom& room_;
  hsp_mesh mesh_{};
  hsp_mesh first_{};  ///< counts of what the request asked for
  double chord_ = 0;  ///< [m] chord error of mesh_
  double off_ = 0;    ///< [m] how far the last reduction was off
};

}  // namespace

Result<Drawing> drawnToFit(const host::ShapeInstance& shape, const DrawingWish& wish, const DrawingRoom& room) {
  return Fitting(shape, wish, room).run();
}

}  // namespace hapticd::servo
