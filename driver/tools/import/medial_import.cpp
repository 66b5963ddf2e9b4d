// SPDX-License-Identifier: MIT
#include "import/medial_import.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/regular_file.hpp"
#include "document/node.hpp"
#include "host/shape_instance.hpp"
#include "import/active_model.hpp"
#include "import/medial_axis.hpp"
#include "import/nearest_points.hpp"
#include "import/progress_line.hpp"
#include "import/unstated_unit.hpp"
#include "kernels/dynamics/plausible_mass.hpp"
#include "mesh_import/mesh_file.hpp"
#include "mesh_import/mesh_repair.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

constexpr double kToleranceShare = 0.01;  ///< default tolerance, as a share of the body's size
constexpr double kLarge = 1.0;            ///< [m] a larger body was probably given in millimetres
constexpr double kChordShare = 0.002;     ///< chord error of the triangles of a model, as a share of its size
constexpr std::size_t kMostFileBytes = std::size_t{1} << 30;

bool endsWith(const std::string& name, const char* end) {
  std::string lower = name;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower.ends_with(end);
}

std::string toMa(const MedialAxis& axis, const std::string& source) {
  std::string text = fmt::format("# made from {} by hapticd import --medial\n{} {} {}\n", source, axis.spheres.size(),
                                 axis.edges.size(), axis.triangles.size());
  for (const auto& s : axis.spheres) text += fmt::format("v {:.9g} {:.9g} {:.9g} {:.9g}\n", s[0], s[1], s[2], s[3]);
  for (const auto& e : axis.edges) text += fmt::format("e {} {}\n", e[0], e[1]);
  for (const auto& t : axis.triangles) text += fmt::format("f {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

std::string toYaml(const MedialAxis& axis, const MedialImport& options, const std::string& source) {
  std::string text =
      fmt::format("# made from {} by hapticd import --medial\nformat: hapticd-model/2\nmedial:\n  vertices:\n", source);
  for (const auto& s : axis.spheres)
    text += fmt::format("    - [{:.9g}, {:.9g}, {:.9g}, {:.9g}]\n", s[0], s[1], s[2], s[3]);
  if (!axis.edges.empty()) text += "  edges:\n";
  for (const auto& e : axis.edges) text += fmt::format("    - [{}, {}]\n", e[0], e[1]);
  if (!axis.triangles.empty()) text += "  triangles:\n";
  for (const auto& t : axis.triangles) text += fmt::format("    - [{}, {}, {}]\n", t[0], t[1], t[2]);
  text += options.young > 0 ? fmt::format("  young: {}\n  poisson: {}\n  thickness: {}\n", options.young,
                                          options.poisson, options.thickness)
                            : fmt::format("  stiffness: {}\n", options.stiffness);
  return text + fmt::format("  damping: {}\n  mass: {}\n", options.damping, options.mass);
}

/// The mass of a vertex that nobody gave [kg]. A body of many spheres would be heavier than metal with the usual one.
double usualMass(std::size_t spheres) {
  constexpr double kUsual = 0.01, kMostInAll = 2;  // [kg]
  static_assert(kMostInAll < dynamics::kEasyMass, "`check` must not warn of what import chose");
  return std::min(kUsual, kMostInAll / static_cast<double>(spheres));
}

struct Deviation {
  double most = 0, mean = 0;
};

/// Measures the distance of the given surface from the surface of the body, as the plugin computes it.
Result<Deviation> deviationFrom(host::ShapeInstance& body, const std::vector<Vector3d>& points,
                                ProgressLine& progress) {
  const hsp_near near{};
  if (body.surfaces()->activate(body.handle(), &near) < 0) return Error{"the body cannot be traced"};
  Deviation deviation;
  std::size_t done = 0;
  for (const Vector3d& p : points) {
    progress.show("measuring the written body", done++, points.size());
    const auto contact = touched(body, p);
    if (!contact) return Error{contact.error()};
    deviation.most = std::fmax(deviation.most, std::fabs(contact->depth_m));
    deviation.mean += std::fabs(contact->depth_m) / static_cast<double>(points.size());
  }
  return deviation;
}

/// Says what may bring a body nearer to its surface. Four times as many samples are half as far apart.
std::string adviceOf(bool has_all_spheres, int samples) {
  constexpr int kMostSamples = 1000000;
  if (has_all_spheres) return "more --spheres may help";
  const std::string angle = "a smaller --angle where the surface has edges";
  if (samples >= kMostSamples) return angle + " may help";
  return fmt::format("more samples may help, such as --samples {}, or {}", std::min(4 * samples, kMostSamples), angle);
}

/// Measures the distance of the given surface from the written body, and of the body from the surface, and prints both.
Result<void> report(const MedialImport& options, const MedialOptions& settings, const MedialAxis& axis,
                    const SurfaceSamples& samples, ProgressLine& progress, host::Catalog& catalog) {
  // the distance is that from the body at rest
  const auto body = activated("mat_deformable", options.out, catalog, ", dynamics: \"off\"");
  if (!body) return Error{body.error()};
  const auto there = deviationFrom(**body, samples.points, progress);
  if (!there) return Error{there.error()};
  // The drawn surface rounds creases by the size of a cell. Cells smaller than the tolerance show no more, and the time
  // grows with the square of their number.
  const double chord = 0.5 * settings.tolerance / (*body)->report().size_m;
  const auto drawn = tessellated(**body, std::clamp(chord, kChordShare, kToleranceShare));
  if (!drawn) return Error{drawn.error()};
  const NearestPoints nearest(samples.points);
  double back = 0, beyond = 0;  // [m] distance to the nearest sample, and to its tangent plane
  for (const Vector3d& p : drawn->points) {
    const uint32_t i = nearest.nearest(p);
    const Vector3d off = samples.points[i] - p;
    back = std::fmax(back, off.norm());
    beyond = std::fmax(beyond, std::fabs(samples.normals[i].dot(off)));
  }
  progress.clear();
  std::printf("%s: %zu spheres, %zu edges, %zu triangles, %d part%s; %.2f %% of the surface covered\n",
              options.out.c_str(), axis.spheres.size(), axis.edges.size(), axis.triangles.size(), axis.parts,
              axis.parts == 1 ? "" : "s", 100 * axis.covered);
  std::printf(
      "the surface is at most %.3f mm from the body (Hausdorff distance, one-sided; mean %.3f mm); the body at "
      "most %.3f mm from the tangent planes of its samples, and %.3f mm from the samples, which are %.3f mm apart\n",
      1e3 * there->most, 1e3 * there->mean, 1e3 * beyond, 1e3 * back, 1e3 * samples.spacing);
  const double reached = std::fmax(there->most, beyond);
  if (reached > settings.tolerance)
    std::fprintf(stderr,
                 "warning: the body and the surface differ by up to %.4g mm, but --tolerance allows only %.4g mm: %s\n",
                 1e3 * reached, 1e3 * settings.tolerance,
                 adviceOf(static_cast<int>(axis.spheres.size()) >= settings.most_spheres, options.samples).c_str());
  return {};
}

/// Says how a hand will feel the written body.
void printFeel(const MedialImport& options) {
  if (endsWith(options.out, ".ma")) {
    std::printf(
        "a .ma file holds no material: the scene gives stiffness, damping and mass; "
        "the hand feels the body as it moves with dynamics: felt, and at rest without\n");
    return;
  }
  const std::string stiffness = options.young > 0 ? fmt::format("the stiffness of {:g} Pa in a layer of {:g} mm",
                                                                options.young, 1e3 * options.thickness)
                                                  : fmt::format("{:g} N/m", options.stiffness);
  if (options.damping > 0 || options.mass > 0)
    std::printf("felt: %s, and as it moves %g N s/m and %.3g g for each sphere (dynamics: felt)\n", stiffness.c_str(),
                options.damping, 1e3 * options.mass);
  else
    std::printf("felt: %s, as a body at rest, because it has neither damping nor mass (dynamics: off)\n",
                stiffness.c_str());
}

/// Warns of a large body, because its file was probably in millimetres.
void printSize(const Eigen::AlignedBox3d& box, const MedialImport& options) {
  const std::string& file = options.file;
  const Vector3d size = box.sizes();
  std::printf("%s: %.4g x %.4g x %.4g m\n", file.c_str(), size.x(), size.y(), size.z());
  const std::string unit = isMeshFile(file) ? unstatedUnit(options.placement, size.maxCoeff()) : "";
  if (!unit.empty()) std::printf("  %s\n", unit.c_str());
  std::fflush(stdout);
  if (size.maxCoeff() > kLarge)
    std::fprintf(stderr,
                 "warning: %s: the body is %.3g m long, more than an arm reaches\n  fix: if the file counts "
                 "millimetres, add --scale 0.001\n",
                 file.c_str(), size.maxCoeff());
}

/// Repairs a mesh as for a part, and reports what was done: a file whose cracks are rounding bounds a volume all the
/// same.
Result<Triangles> closedSurface(const MeshFile& file, const MedialImport& options) {
  MeshReport done;
  RepairedMesh repaired_mesh = repaired(file, {.scale = options.placement.scale}, done);
  Triangles mesh{std::move(repaired_mesh.points), std::move(repaired_mesh.corners)};
  if (const auto closed = orientClosed(mesh, options.file); !closed) return Error{closed.error()};
  for (const std::string& line : linesOf(done)) std::fprintf(stderr, "%s: %s\n", options.file.c_str(), line.c_str());
  return mesh;
}

/// Reads a model file with NURBS surfaces as triangles.
Result<Triangles> readModel(const MedialImport& options, host::Catalog& catalog) {
  const auto shape = activated("nurbs_rigid", options.file, catalog);
  if (!shape) return Error{shape.error()};
  // chord error as a share of the tolerance, so that the triangles are exact enough for it
  constexpr double kOfTolerance = 0.25;
  const double size = (*shape)->report().size_m * options.placement.scale;
  const double wanted = options.tolerance > 0 ? kOfTolerance * options.tolerance / size : 1;
  return tessellated(**shape, std::min(kChordShare, wanted));
}

Result<Triangles> readMesh(const MedialImport& options) {
  document::Problems problems;
  const auto text = document::readFile(options.file, kMostFileBytes, problems);
  if (!text) return Error{problems.empty() ? options.file + ": cannot be read" : problems.front().text()};
  if (!isMeshFile(options.file))
    return Error{options.file +
                 ": its name does not say that it holds a surface; expected .obj, .stl, .ply, or a model file (.yaml, "
                 ".json) with surfaces"};
  auto read = parseMesh(*text, options.file);
  if (!read) return Error{read.error()};
  return closedSurface(*read, options);
}

}  // namespace

Result<Triangles> readSurface(const MedialImport& options, host::Catalog& catalog) {
  if (!endsWith(options.out, ".ma") && !endsWith(options.out, ".yaml"))
    return Error{options.out + ": the name does not say which format to write; expected one that ends in .ma or .yaml"};
  const bool model =
      endsWith(options.file, ".yaml") || endsWith(options.file, ".yml") || endsWith(options.file, ".json");
  auto surface = model ? readModel(options, catalog) : readMesh(options);
  Placement rest = options.placement;
  if (!model) rest.scale = 1;  // the repair has scaled it
  if (surface && (rest.scale != 1 || rest.fit > 0 || rest.center || rest.up != 'y'))
    placePoints(surface->points, surface->corners, rest);
  return surface;
}

Result<void> importMedial(const MedialImport& asked, const Triangles& mesh, host::Catalog& catalog) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.points) box.extend(p);
  printSize(box, asked);
  MedialOptions settings;
  settings.tolerance = asked.tolerance > 0 ? asked.tolerance : kToleranceShare * box.diagonal().norm();
  settings.most_spheres = asked.most_spheres;
  settings.least_angle = asked.least_angle;
  const SurfaceSamples samples = sampleSurface(mesh, static_cast<std::size_t>(asked.samples));
  ProgressLine progress;
  const auto axis = medialAxis(samples, settings, progress);
  if (!axis) return Error{asked.file + ": " + axis.error()};
  MedialImport options = asked;
  if (options.mass < 0) options.mass = usualMass(axis->spheres.size());
  const std::string source = fs::path(options.file).filename().string();
  const std::string text = endsWith(options.out, ".ma") ? toMa(*axis, source) : toYaml(*axis, options, source);
  if (auto written = writeWhole(options.out, text); !written) return written;
  if (auto measured = report(options, settings, *axis, samples, progress, catalog); !measured) return measured;
  printFeel(options);
  return {};
}

}  // namespace hapticd::importing
