// SPDX-License-Identifier: MIT
#include "session/geometry_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/sealed_memory.hpp"
#include "control/server.hpp"
#include "document/json_text.hpp"
#include "hapticd/shape_names.h"

namespace hapticd::servo {
namespace {

constexpr double kChordShare = 0.005;  ///< default chord error as a share of the model's size: fine enough for a screen
constexpr std::size_t kMostMemory = std::size_t{64} << 20;  ///< [bytes] largest memory for the triangles of one drawing
constexpr double kDefaultChord = 1e-3;  ///< [m] default chord error if the model does not report its size

bool tooLong(const std::string& text) {
  return text.size() > control::Server::kMaxWaiting;
}

/// Appends a list of coordinates until the answer is too long. Returns false if a coordinate is not finite.
bool appendPlaces(std::string& text, const float* xyz, std::size_t count) {
  for (std::size_t i = 0; i < count && !tooLong(text); ++i) {
    if (!std::isfinite(xyz[i])) return false;
    text += fmt::format("{}{:.7g}", i == 0 ? "" : ",", xyz[i]);
  }
  return true;
}

constexpr const char* kNoTriangles =
    "the model cannot be drawn, because its plugin gives no triangles (extension hsp.geometry/1); it can still be felt";
constexpr const char* kNotANumber = "a vertex of the model is not a finite number";

bool allFinite(const float* numbers, std::size_t count) {
  return std::all_of(numbers, numbers + count, [](float number) { return std::isfinite(number); });
}

/// Makes the triangles of a shape. @param tolerance chord error [m] that was asked for; becomes the one that was used
Result<hsp_mesh> cut(const host::ShapeInstance& shape, double& tolerance) {
  if (shape.geometry() == nullptr) return Error{kNoTriangles};
  const double size = shape.report().size_m;
  if (!(tolerance > 0) && shape.contour() == nullptr) tolerance = size > 0 ? kChordShare * size : kDefaultChord;
  hsp_mesh mesh{};
  if (shape.tessellate(tolerance, mesh) < 0)
    return Error{
        fmt::format("the plugin of the model gives no valid triangles for a chord error of {:g} m", tolerance)};
  return mesh;
}

Error tooMany(const hsp_mesh& mesh, std::size_t most, double tolerance) {
  return Error{
      fmt::format("{} vertices and {} triangles do not fit into the {} bytes of an answer\n"
                  "  fix: ask for a tolerance larger than {:g} m",
                  mesh.vertex_count, mesh.triangle_count, most, tolerance)};
}

std::string featureName(const host::ShapeInstance& shape, uint32_t feature) {
  constexpr uint64_t kLongest = 256;  // longer names are cut off
  const hsp_class& plugin = shape.description();
  if (!shape.active() || !HSP_HAS(&plugin, extension) || plugin.extension == nullptr) return "";
  const OwnerScope calling(shape.owner());
  const auto* names = static_cast<const hsp_ext_names*>(plugin.extension(shape.handle(), HSP_EXT_NAMES));
  if (names == nullptr || names->struct_size < sizeof *names || names->feature == nullptr) return "";
  std::string text(kLongest, '\0');
  const int64_t needed = names->feature(shape.handle(), feature, text.data(), text.size());
  text.resize(std::min<uint64_t>(needed > 0 ? static_cast<uint64_t>(needed) : 0, kLongest));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';  // names are printed on terminals
  return text;
}

}  // namespace

Result<std::string> geometryAnswer(const host::ShapeInstance& shape, double tolerance) {
  const auto mesh = cut(shape, tolerance);
  if (!mesh) return Error{mesh.error()};
  std::string text = fmt::format(R"({{"ok":true,"tolerance":{:g},"xyz":[)", tolerance);
  if (!appendPlaces(text, mesh->xyz, 3 * std::size_t{mesh->vertex_count})) return Error{kNotANumber};
  text += R"(],"triangles":[)";
  for (std::size_t i = 0; i < 3 * std::size_t{mesh->triangle_count} && !tooLong(text); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ",", mesh->indices[i]);
  text += "]}";
  if (tooLong(text)) return tooMany(*mesh, control::Server::kMaxWaiting, tolerance);
  return text;
}

Result<std::string> geometryInMemory(const host::ShapeInstance& shape, double tolerance, Descriptor& memory) {
  const auto mesh = cut(shape, tolerance);
  if (!mesh) return Error{mesh.error()};
  const std::size_t places = 3 * std::size_t{mesh->vertex_count}, corners = 3 * std::size_t{mesh->triangle_count};
  if (!allFinite(mesh->xyz, places)) return Error{kNotANumber};
  const bool normals = mesh->normals != nullptr && allFinite(mesh->normals, places);
  const std::size_t bytes = 4 * (places * (normals ? 2 : 1) + corners);
  if (bytes == 0) return Error{kNoTriangles};
  if (bytes > kMostMemory) return tooMany(*mesh, kMostMemory, tolerance);
  const auto shared = SealedMemory::create("hapticd-geometry", bytes, SealedMemory::Writers::kOne);
  if (!shared) return Error{shared.error()};
  std::byte* at = (*shared)->data();
  const auto append = [&](const void* from, std::size_t count) {
    std::memcpy(at, from, 4 * count);
    at += 4 * count;
  };
  append(mesh->xyz, places);
  if (normals) append(mesh->normals, places);
  append(mesh->indices, corners);
  auto descriptor = (*shared)->share();
  if (!descriptor) return Error{descriptor.error()};
  memory = std::move(*descriptor);
  return fmt::format(R"({{"ok":true,"bytes":{},"vertices":{},"triangles":{},"normals":{},"tolerance":{:g}}})", bytes,
                     mesh->vertex_count, mesh->triangle_count, normals, tolerance);
}

Result<std::string> verticesAnswer(const host::ShapeInstance& shape, double after) {
  if (shape.contour() == nullptr)
    return Error{
        "the model writes no vertices while it runs\n"
        "  fix: if it is a soft body, set display_tolerance: 0.001 among its parameters in the scene"};
  const host::Contour::Frame& frame = shape.contour()->newest();
  std::string text = fmt::format(R"({{"ok":true,"frame":{})", frame.number);
  if (static_cast<double>(frame.number) > after) {
    text += R"(,"xyz":[)";
    if (!appendPlaces(text, frame.xyz.data(), frame.xyz.size())) return Error{kNotANumber};
    if (tooLong(text))
      return Error{
          fmt::format("{} vertices do not fit into the {} bytes of an answer\n"
                      "  fix: set a larger display_tolerance among the model's parameters in the scene",
                      frame.xyz.size() / 3, control::Server::kMaxWaiting)};
    text += "]";
  }
  return text + "}";
}

std::string featureAnswer(const host::ShapeInstance& shape, uint32_t feature) {
  using Json = nlohmann::ordered_json;
  const std::string name = featureName(shape, feature);
  return document::jsonLine({{"ok", true}, {"name", name.empty() ? Json() : Json(name)}});
}

}  // namespace hapticd::servo
