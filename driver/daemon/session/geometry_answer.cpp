// SPDX-License-Identifier: MIT
#include "session/geometry_answer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/server.hpp"

namespace hapticd::servo {
namespace {

constexpr double kChordShare = 0.005;   ///< of a model's size: fine enough for a screen
constexpr double kDefaultChord = 1e-3;  ///< [m] of a model that does not say its size

bool tooLong(const std::string& text) {
  return text.size() > control::Server::kMaxWaiting;
}

/// Appends a list of coordinates, as far as an answer may be long. False: one is not a number.
bool appendPlaces(std::string& text, const float* xyz, std::size_t count) {
  for (std::size_t i = 0; i < count && !tooLong(text); ++i) {
    if (!std::isfinite(xyz[i])) return false;
    fmt::format_to(std::back_inserter(text), "{}{:.7g}", i == 0 ? "" : ",", xyz[i]);
  }
  return true;
}

constexpr const char* kNotANumber = "a vertex of the model is not a number";

}  // namespace

Result<std::string> geometryAnswer(const host::ShapeInstance& shape, double tolerance) {
  const hsp_ext_geometry* geometry = shape.geometry();
  if (geometry == nullptr) return Error{"the model has no triangles to draw"};
  const double size = shape.report().size_m;
  if (!(tolerance > 0) && shape.contour() == nullptr) tolerance = size > 0 ? kChordShare * size : kDefaultChord;
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  if (geometry->tessellate(shape.handle(), tolerance, &mesh) < 0)
    return Error{fmt::format("the model cannot be cut into triangles within {:g} m", tolerance)};
  std::string text = fmt::format(R"({{"ok":true,"tolerance":{:g},"xyz":[)", tolerance);
  if (!appendPlaces(text, mesh.xyz, 3 * std::size_t{mesh.vertex_count})) return Error{kNotANumber};
  text += R"(],"triangles":[)";
  for (std::size_t i = 0; i < 3 * std::size_t{mesh.triangle_count} && !tooLong(text); ++i)
    fmt::format_to(std::back_inserter(text), "{}{}", i == 0 ? "" : ",", mesh.indices[i]);
  text += "]}";
  if (tooLong(text))
    return Error{
        fmt::format("{} vertices and {} triangles are more than the {} bytes of an answer\n"
                    "  fix: a tolerance coarser than {:g} m",
                    mesh.vertex_count, mesh.triangle_count, control::Server::kMaxWaiting, tolerance)};
  return text;
}

Result<std::string> verticesAnswer(const host::ShapeInstance& shape, double after) {
  if (shape.contour() == nullptr)
    return Error{
        "the model's steps write no vertices\n"
        "  fix: for a soft body, display_tolerance: 0.001 among its parameters in the scene"};
  const host::Contour::Frame& frame = shape.contour()->newest();
  std::string text = fmt::format(R"({{"ok":true,"frame":{})", frame.number);
  if (static_cast<double>(frame.number) > after) {
    text += R"(,"xyz":[)";
    if (!appendPlaces(text, frame.xyz.data(), frame.xyz.size())) return Error{kNotANumber};
    if (tooLong(text))
      return Error{fmt::format("{} vertices are more than the {} bytes of an answer", frame.xyz.size() / 3,
                               control::Server::kMaxWaiting)};
    text += "]";
  }
  return text + "}";
}

}  // namespace hapticd::servo
