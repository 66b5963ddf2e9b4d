// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "mesh_import/mesh_colours.hpp"
#include "mesh_import/mesh_objects.hpp"
#include "mesh_import/mesh_repair.hpp"

namespace hapticd::importing {
namespace {

using brep::kNone;
using Corners = std::array<std::uint32_t, 3>;
using Eigen::Vector3d;

/// Refuses what a part file does not hold, before the squares of coordinates overflow.
void refuseFarPoints(const MeshFile& mesh, double scale) {
  constexpr double kFarthest = 1e6;  // [m] as in part_check.cpp
  double farthest = 0;
  for (const Corners& c : mesh.corners)  // points without a triangle are left out of the part
    for (const std::uint32_t i : c) farthest = std::max(farthest, scale * mesh.points[i].lpNorm<Eigen::Infinity>());
  if (farthest <= kFarthest) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "a coordinate is %.10g m, expected at most 1000000 m\n"
                "  fix: if the file counts millimetres, add --scale 0.001",
                farthest);
  throw std::invalid_argument(text);
}

/// Adds the triangles of a body, with their neighbours, to a part. Returns the index of the body.
std::uint32_t addBody(const RepairedMesh& mesh, bool closed, const MeshOptions& options, brep::Part& part) {
  brep::Body body;
  body.kind = brep::BodyKind::kMesh;
  body.flags = closed ? brep::kClosed : 0;
  body.first_point = static_cast<std::uint32_t>(part.points.size());
  body.first_triangle = static_cast<std::uint32_t>(part.triangles.size());
  body.point_count = static_cast<std::uint32_t>(mesh.points.size());
  body.triangle_count = static_cast<std::uint32_t>(mesh.corners.size());
  body.smooth_angle = options.smooth_angle;
  for (const Vector3d& p : mesh.points) part.points.push_back({p.x(), p.y(), p.z()});
  for (Corners c : mesh.corners) {
    for (std::uint32_t& corner : c) corner += body.first_point;
    part.triangles.push_back({c, {kNone, kNone, kNone}});
  }
  for (std::size_t i = 0; i < mesh.edges.size();) {
    const std::size_t end = endOfEdge(mesh.edges, i);
    for (std::size_t k = i; end - i > 1 && k < end; ++k) {
      const std::uint32_t code = mesh.edges[k].code;
      part.triangles[body.first_triangle + code / 4].across[code % 4] =
          4 * body.first_triangle + mesh.edges[k + 1 < end ? k + 1 : i].code;
    }
    i = end;
  }
  part.bodies.push_back(body);
  return static_cast<std::uint32_t>(part.bodies.size() - 1);
}

void addInstance(const std::string& name, std::uint32_t body, std::uint32_t parent, brep::Part& part) {
  brep::Instance instance;
  instance.body = body;
  instance.parent = parent;
  instance.name = static_cast<std::uint32_t>(part.names.size());
  if (body != kNone) part.bodies[body].name = instance.name;
  part.names.push_back(name);
  part.instances.push_back(instance);
}

/// Repairs each object and adds it as a body of its own.
void addObjects(const std::vector<MeshObject>& objects, const MeshOptions& options, const std::string& name,
                brep::Part& part, MeshReport& report) {
  const bool several = objects.size() > 1;
  if (several) addInstance(name, kNone, kNone, part);
  report.closed = true;
  for (const MeshObject& object : objects) {
    MeshReport of_body;
    const RepairedMesh mesh = repaired(object.mesh, options, of_body);
    report.add(of_body);
    if (mesh.corners.empty()) continue;
    const std::uint32_t body = addBody(mesh, of_body.closed, options, part);
    report.coloured += addColours(object.mesh, options.scale, mesh, part);
    const std::string own = several && !object.name.empty() ? object.name : name;
    addInstance(own, body, several ? 0 : kNone, part);
    if (several) report.bodies.push_back({own, of_body.triangles, of_body.closed});
  }
}

/// Returns where bodies pass through each other.
Crossings overlapsOf(const brep::Part& part) {
  if (part.bodies.size() < 2) return {};
  std::vector<Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<std::uint32_t> body;
  points.reserve(part.points.size());
  corners.reserve(part.triangles.size());
  body.reserve(part.triangles.size());
  for (const brep::Point& p : part.points) points.emplace_back(p.data());
  for (const brep::Triangle& triangle : part.triangles)
    corners.push_back({triangle.corner[0], triangle.corner[1], triangle.corner[2]});
  for (std::size_t i = 0; i < part.bodies.size(); ++i)
    body.insert(body.end(), part.bodies[i].triangle_count, static_cast<std::uint32_t>(i));
  return crossingsOf(points, corners, body, part.bodies.size());
}

}  // namespace

brep::Part meshPart(const MeshFile& mesh, const MeshOptions& options, const std::string& file_name,
                    MeshReport& report) {
  report.remarks = mesh.remarks;
  refuseFarPoints(mesh, options.scale);
  brep::Part part;
  part.source.file = file_name;
  part.source.unit = options.unit;
  part.source.placed = options.placed;
  addObjects(objectsOf(mesh, report.remarks), options, file_name.substr(0, file_name.rfind('.')), part, report);
  if (part.triangles.empty()) throw std::invalid_argument("all triangles have zero area");
  if (report.coloured == 0)
    part.colours.clear();
  else
    part.colours.resize(part.triangles.size());
  Eigen::AlignedBox3d box;
  for (const brep::Point& p : part.points) box.extend(Vector3d(p.data()));
  report.size = box.sizes();
  options.progress("looking for bodies that overlap");
  report.overlaps = overlapsOf(part);
  report.borders = brep::openBorders(part);
  for (const std::string& line : linesOf(report)) part.warnings.push_back(line);
  return part;
}

}  // namespace hapticd::importing
