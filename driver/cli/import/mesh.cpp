// SPDX-License-Identifier: MIT
#include "cli/import/mesh.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/counted.hpp"
#include "base/regular_file.hpp"
#include "base/short_number.hpp"
#include "cli/support/command.hpp"
#include "document/json_text.hpp"
#include "import/progress_line.hpp"
#include "import/unstated_unit.hpp"
#include "kernels/brep/model/empty_balls.hpp"
#include "kernels/part/file.hpp"
#include "mesh_import/mesh_part.hpp"

namespace hapticd::cli {
namespace {

constexpr std::size_t kMaxMeshBytes = std::size_t{4} << 30;
constexpr std::size_t kMaxMaterialBytes = std::size_t{16} << 20;  ///< a material takes some 200 bytes
// The limits and the measure, the diagonal of the box, are those of the warnings of `check`.
constexpr double kTooLarge = 5;     ///< [m] a model larger than this was probably given in millimetres
constexpr double kTooSmall = 1e-3;  ///< [m] a smaller part was probably scaled twice: no fingertip feels its form

nlohmann::ordered_json holePlaces(const std::vector<brep::OpenBorder>& borders) {
  nlohmann::ordered_json places = nlohmann::ordered_json::array();
  for (const brep::OpenBorder& border : borders) {
    const Eigen::Vector3d middle = border.box.center();
    places.push_back({{"middle_m", {middle.x(), middle.y(), middle.z()}},
                      {"width_m", border.box.diagonal().norm()},
                      {"free_edges", border.edges}});
  }
  return places;
}

nlohmann::ordered_json bodyList(const importing::MeshReport& report) {
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  for (const importing::MeshBody& body : report.bodies)
    bodies.push_back({{"name", body.name}, {"triangles", body.triangles}, {"closed", body.closed}});
  return bodies;
}

std::string jsonOf(const importing::MeshReport& r, const std::string& out) {
  const nlohmann::ordered_json report = {{"part", out},
                                         {"triangles", r.triangles},
                                         {"points", r.points},
                                         {"coloured_triangles", r.coloured},
                                         {"shells", r.shells},
                                         {"crossing_triangles", r.crossings.pairs},
                                         {"overlapping_triangles", r.overlaps.pairs},
                                         {"closed", r.closed},
                                         {"volume_m3", r.volume},
                                         {"size_m", {r.size.x(), r.size.y(), r.size.z()}},
                                         {"joined_points", r.joined},
                                         {"slivers", r.slivers},
                                         {"solids_inside", r.solids_inside},
                                         {"degenerate", r.degenerate},
                                         {"duplicates", r.duplicates},
                                         {"back_to_back", r.back_to_back},
                                         {"flipped", r.flipped},
                                         {"touching_edges", r.touching},
                                         {"non_manifold_edges", r.non_manifold},
                                         {"unorientable_edges", r.unorientable},
                                         {"holes", r.holes},
                                         {"free_edges", r.free_edges},
                                         {"hole_places", holePlaces(r.borders)},
                                         {"bodies", bodyList(r)},
                                         {"remarks", r.remarks}};
  return document::jsonLines(report);
}

/// Returns the name of a unit of so many metres, or its size if it has none.
std::string unitName(double metres) {
  constexpr std::pair<double, const char*> kUnits[] = {{1, "m"},     {0.01, "cm"},   {0.001, "mm"},
                                                       {1e-6, "um"}, {0.0254, "in"}, {0.3048, "ft"}};
  for (const auto& [size, name] : kUnits)
    if (metres == size) return name;
  return withDigits(metres, 6) + " m";
}

/// Returns the unit of the file, as it is noted in the part.
std::string unitOf(const importing::Placement& placement) {
  if (placement.fit > 0) return "whatever makes it fit into " + withDigits(placement.fit, 6) + " m";
  return unitName(placement.scale);
}

/// Returns how the points were turned and centred, as it is noted in the part; "" if they were not.
std::string placedText(const importing::Placement& placement) {
  std::string text;
  if (placement.up != 'y') text = std::string("turned, ") + placement.up + " is up";
  if (placement.center) text += text.empty() ? "centred" : ", centred";
  return text;
}

void print(const importing::MeshReport& r, const std::string& out, const importing::Placement& placement) {
  std::printf("%s: %zu triangle%s, %zu points, %.4g x %.4g x %.4g m, %s\n", out.c_str(), r.triangles,
              r.triangles == 1 ? "" : "s", r.points, r.size.x(), r.size.y(), r.size.z(),
              r.closed ? "closed" : "open: a shell that is felt from both sides unless the scene says sides: front");
  for (const importing::MeshBody& body : r.bodies)
    std::printf("  body '%s': %zu triangle%s, %s\n", body.name.c_str(), body.triangles, body.triangles == 1 ? "" : "s",
                body.closed ? "closed" : "open");
  if (r.coloured > 0)
    std::printf("  colours: %s\n",
                r.coloured == r.triangles ? "of all triangles" : counted(r.coloured, "triangle").c_str());
  for (const std::string& line : importing::linesOf(r)) std::printf("  %s\n", line.c_str());
  printUnit(placement, r.size.maxCoeff());
  warnOfSize(out, r.size.norm());
}

Result<importing::MeshFile> readMesh(const std::string& file) {
  importing::ProgressLine progress;
  progress.show("reading " + file);
  const auto bytes = readRegular(file, kMaxMeshBytes);
  if (!bytes) return Error{file + ": " + bytes.error()};
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  return importing::parseMesh(
      *bytes, file, [&](const std::string& name) { return readRegular((folder / name).string(), kMaxMaterialBytes); });
}

/// Returns the bytes of the part that a mesh becomes.
Result<std::string> makePart(importing::MeshFile& mesh, const MeshImport& options, importing::MeshReport& report) {
  importing::ProgressLine progress;
  const importing::Placement& placement = options.placement;
  const bool placed = placement.fit > 0 || placement.center || placement.up != 'y';
  if (placed) importing::placePoints(mesh.points, mesh.corners, placement);
  const importing::MeshOptions how{placed ? 1 : placement.scale, options.smooth_angle * std::numbers::pi / 180,
                                   unitOf(placement), placedText(placement),
                                   [&progress](const char* what) { progress.show(what); }};
  try {
    const std::string name = std::filesystem::path(options.file).filename().string();
    brep::Part part = importing::meshPart(mesh, how, name, report);
    if (options.felt) {
      progress.show("finding how far each triangle is alone, so that ticks are short");
      brep::findEmptyBalls(part);
    }
    progress.show("writing the part");
    return brep::writePart(part);
  } catch (const std::exception& error) {
    return Error{options.file + ": " + error.what()};
  }
}

}  // namespace

void warnOfSize(const std::string& out, double size) {
  if (size > kTooLarge)
    std::fprintf(
        stderr,
        "warning: %s: %.3g m large from corner to corner; if the imported file counts millimetres, add --scale 0.001\n",
        out.c_str(), size);
  else if (size < kTooSmall)
    std::fprintf(stderr,
                 "warning: %s: %.3g mm large from corner to corner, too small to be felt; "
                 "is --scale (metres per unit of the imported file) right?\n",
                 out.c_str(), size * 1e3);
}

void printUnit(const importing::Placement& placement, double largest) {
  if (const std::string line = importing::unstatedUnit(placement, largest); !line.empty())
    std::printf("  %s\n", line.c_str());
}

int failLines(int exit_code, const std::string& lines) {
  for (std::size_t begin = 0; begin < lines.size();) {
    std::size_t end = lines.find('\n', begin);
    while (end != std::string::npos && end + 1 < lines.size() && lines[end + 1] == ' ') end = lines.find('\n', end + 1);
    fail(exit_code, lines.substr(begin, end - begin));
    begin = end == std::string::npos ? lines.size() : end + 1;
  }
  return exit_code;
}

int importMesh(const MeshImport& options) {
  if (std::filesystem::path(options.out).extension() != ".hpart")
    return fail(kBadInput, options.out +
                               ": triangles become a part, expected a name that ends in .hpart\n  fix: for a "
                               "soft body (.ma, .yaml) add --medial");
  auto mesh = readMesh(options.file);
  if (!mesh) return failLines(kBadInput, mesh.error());
  importing::MeshReport report;
  const auto part = makePart(*mesh, options, report);
  if (!part) return fail(kBadInput, part.error());
  if (const auto written = writeWhole(options.out, *part); !written) return fail(kFailed, written.error());
  const std::string& called = options.named.empty() ? options.out : options.named;
  if (options.json)
    std::printf("%s\n", jsonOf(report, called).c_str());
  else
    print(report, called, options.placement);
  return kWorked;
}

}  // namespace hapticd::cli
