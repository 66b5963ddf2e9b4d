// SPDX-License-Identifier: MIT
#include "session/requests/geometry_answer.hpp"

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

constexpr std::size_t kMostMemory = std::size_t{64} << 20;  ///< [bytes] largest memory for the triangles of one drawing
/// [bytes] that a triangle and its share of the vertices usually need as text and in memory
constexpr std::size_t kTextPerTriangle = 34, kMemoryPerTriangle = 26;
constexpr std::size_t kHeadBytes = 512;  ///< [bytes] room for the rest of an answer

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

constexpr const char* kNotANumber = "a vertex of the model is not a finite number";

/// Returns what the answer says about a drawing, beside its lists.
std::string keysOf(const Drawing& drawing) {
  constexpr double kJoined = 1e-9;  // [m] below this, the reduction has only joined corners at the same place
  if (!drawing.reduced || drawing.reduced->off < kJoined) return fmt::format(R"("tolerance":{:g})", drawing.tolerance);
  const std::string note =
      fmt::format("drawn with {} of {} triangles, at most {:.2g} mm off the model's own: coarser than what is felt",
                  drawing.mesh().triangle_count, drawing.of_plugin.triangle_count, 1e3 * drawing.reduced->off);
  return fmt::format(R"("tolerance":{:g},"full_triangles":{},"off":{:.3g},"note":"{}")", drawing.tolerance,
                     drawing.of_plugin.triangle_count, drawing.reduced->off, note);
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

Result<std::string> geometryAnswer(const host::ShapeInstance& shape, const DrawingWish& wish) {
  std::string lists;
  const std::size_t most = control::Server::kMaxWaiting - kHeadBytes;
  const auto fits = [&](const hsp_mesh& mesh) {
    lists = R"("xyz":[)";
    appendPlaces(lists, mesh.xyz, 3 * std::size_t{mesh.vertex_count});
    lists += R"(],"triangles":[)";
    for (std::size_t i = 0; i < 3 * std::size_t{mesh.triangle_count} && !tooLong(lists); ++i)
      lists += fmt::format("{}{}", i == 0 ? "" : ",", mesh.indices[i]);
    lists += "]";
    return lists.size() <= most;
  };
  const auto drawing = drawnToFit(shape, wish, {most, kTextPerTriangle, false, fits});
  if (!drawing) return Error{drawing.error()};
  return fmt::format(R"({{"ok":true,{},{}}})", keysOf(*drawing), lists);
}

Result<std::string> geometryInMemory(const host::ShapeInstance& shape, const DrawingWish& wish, Descriptor& memory) {
  const auto bytesOf = [](const hsp_mesh& mesh) {
    const std::size_t per_vertex = (mesh.normals != nullptr ? 6 : 3) + (mesh.colours != nullptr ? 1 : 0);
    return 4 * (per_vertex * mesh.vertex_count + 3 * std::size_t{mesh.triangle_count});
  };
  const auto drawing = drawnToFit(shape, wish, {kMostMemory, kMemoryPerTriangle, true, [&](const hsp_mesh& mesh) {
                                                  return bytesOf(mesh) <= kMostMemory;
                                                }});
  if (!drawing) return Error{drawing.error()};
  const hsp_mesh mesh = drawing->mesh();
  const std::size_t places = 3 * std::size_t{mesh.vertex_count}, bytes = bytesOf(mesh);
  const auto shared = SealedMemory::create("hapticd-geometry", bytes, SealedMemory::Writers::kOne);
  if (!shared) return Error{shared.error()};
  std::byte* at = (*shared)->data();
  const auto append = [&](const void* from, std::size_t count) {
    std::memcpy(at, from, 4 * count);
    at += 4 * count;
  };
  append(mesh.xyz, places);
  if (mesh.normals != nullptr) append(mesh.normals, places);
  append(mesh.indices, 3 * std::size_t{mesh.triangle_count});
  if (mesh.colours != nullptr) append(mesh.colours, mesh.vertex_count);
  auto descriptor = (*shared)->share();
  if (!descriptor) return Error{descriptor.error()};
  memory = std::move(*descriptor);
  return fmt::format(R"({{"ok":true,"bytes":{},"vertices":{},"triangles":{},"normals":{},"colours":{},{}}})", bytes,
                     mesh.vertex_count, mesh.triangle_count, mesh.normals != nullptr, mesh.colours != nullptr,
                     keysOf(*drawing));
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
