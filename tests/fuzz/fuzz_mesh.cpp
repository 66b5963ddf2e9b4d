// SPDX-License-Identifier: MIT
/// Fuzzes triangle meshes (OBJ, STL, PLY): the reader, its repairs, and some ticks with the part that it makes. Each
/// such part must pass the checks of part files. The first byte of the input chooses the format. What follows the
/// byte 1e is the file of materials of an OBJ file.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/part/file.hpp"
#include "mesh_import/mesh_part.hpp"

namespace {

using namespace hapticd;
using Eigen::Vector3d;

void need(bool good) {
  if (!good) std::abort();
}

void trace(brep::Part part) {
  constexpr int kTicks = 20;
  const brep::Model model(std::move(part));
  brep::Tracer tracer(model);
  const Eigen::AlignedBox3d box = model.bounds();
  for (int i = 0; i < kTicks; ++i) {
    const Vector3d p = box.min() + i / (kTicks - 1.0) * box.sizes() + Vector3d(1e-3, -2e-3, 1e-3 * std::sin(i));
    const contact::Foot foot = tracer.step(p, {});
    if (contact::found(foot)) need(foot.point.allFinite() && foot.normal.allFinite() && std::isfinite(foot.depth));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kNames[] = {"fuzz.obj", "fuzz.stl", "fuzz.ply"};
  constexpr double kSmooth = 0.5;
  if (size == 0) return 0;
  const std::string_view input(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t end = data[0] % 3 == 0 ? input.find('\x1e') : std::string_view::npos;
  const auto materials = [&](const std::string& name) -> Result<std::string> {
    for (const std::filesystem::path& step : std::filesystem::path(name)) need(step != ".." && step != "/");
    if (end == std::string_view::npos) return Error{"is not there"};
    return std::string(input.substr(end + 1));
  };
  const auto mesh = importing::parseMesh(input.substr(0, end), kNames[data[0] % 3], materials);
  if (!mesh) return 0;
  try {
    importing::MeshReport report;
    const brep::Part part = importing::meshPart(*mesh, {1e-3, data[0] % 2 * kSmooth, "mm"}, "fuzz", report);
    brep::checkPart(part);
    trace(part);
  } catch (const std::invalid_argument&) {  // no triangle is left, or the part is too large or too small
  }
  return 0;
}
