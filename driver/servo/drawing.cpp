#include "servo/drawing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/server.hpp"

namespace hapticd::servo {
namespace {

constexpr double kChordShare = 0.005;   ///< of a model's size: fine enough for a screen
constexpr double kDefaultChord = 1e-3;  ///< [m] of a model that does not say its size

}  // namespace

Result<std::string> drawingOf(const host::ShapeInstance& shape, double tolerance) {
  const hsp_ext_geometry* geometry = shape.geometry();
  if (geometry == nullptr) return Error{"the model has no triangles to draw"};
  const double size = shape.report().size_m;
  if (!(tolerance > 0)) tolerance = size > 0 ? kChordShare * size : kDefaultChord;
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  if (geometry->tessellate(shape.handle(), tolerance, &mesh) < 0)
    return Error{fmt::format("the model cannot be cut into triangles within {:g} m", tolerance)};
  std::string text = fmt::format(R"({{"ok":true,"tolerance":{:g},"xyz":[)", tolerance);
  const auto most = [&text] { return text.size() > control::Server::kMaxWaiting; };
  for (std::size_t i = 0; i < 3 * std::size_t{mesh.vertex_count} && !most(); ++i) {
    if (!std::isfinite(mesh.xyz[i])) return Error{"a vertex of the model is not a number"};
    fmt::format_to(std::back_inserter(text), "{}{:.7g}", i == 0 ? "" : ",", mesh.xyz[i]);
  }
  text += R"(],"triangles":[)";
  for (std::size_t i = 0; i < 3 * std::size_t{mesh.triangle_count} && !most(); ++i)
    fmt::format_to(std::back_inserter(text), "{}{}", i == 0 ? "" : ",", mesh.indices[i]);
  text += "]}";
  if (most())
    return Error{
        fmt::format("{} vertices and {} triangles are more than the {} bytes of an answer\n"
                    "  fix: a tolerance coarser than {:g} m",
                    mesh.vertex_count, mesh.triangle_count, control::Server::kMaxWaiting, tolerance)};
  return text;
}

}  // namespace hapticd::servo
