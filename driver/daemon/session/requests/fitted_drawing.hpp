// SPDX-License-Identifier: MIT
/// The triangles of a model in a number that fits where they go: into an answer, or onto a page. What is felt does not
/// change.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>

#include "base/result.hpp"
#include "drawing/coarse_mesh.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::servo {

/// What a client asked for.
struct DrawingWish {
  double tolerance = 0;  ///< [m] largest distance from the model; 0: 5/1000 of the model's size, or more if needed
  /// Most triangles; 0: any number. A body that deforms keeps its triangles. If the tolerance is 0, a rigid model that
  /// needs few of them is drawn five times finer.
  std::size_t triangles = 0;
};

/// What a drawing must fit into.
struct DrawingRoom {
  std::size_t bytes = 0;               ///< for the message if nothing fits
  std::size_t bytes_per_triangle = 1;  ///< a guess for the first try: a drawing that needs more is tried with fewer
  bool normals = true;                 ///< false if normals are of no use: then the plugin's are ignored
  std::function<bool(const hsp_mesh&)> fits = nullptr;  ///< returns whether a drawing fits
};

struct Drawing {
  hsp_mesh of_plugin{};                          ///< valid until the next drawing of the shape
  std::optional<drawing::CoarseMesh> reduced{};  ///< if the plugin's triangles did not fit
  double tolerance = 0;  ///< [m] largest distance from the model, as far as the plugin keeps its promise

  /// [main] Returns the triangles to draw; valid as long as this object and the plugin's triangles.
  hsp_mesh mesh() const { return reduced ? reduced->view() : of_plugin; }
};

/// [main] Draws an active shape. A rigid one is reduced if the plugin's triangles do not fit; a body that deforms gets
/// a larger chord error, unless its steps write vertices, which belong to its own triangles. A tolerance that was asked
/// for is kept; if nothing fits within it, the error names one that works.
Result<Drawing> drawnToFit(const host::ShapeInstance& shape, const DrawingWish& wish, const DrawingRoom& room);

}  // namespace hapticd::servo
