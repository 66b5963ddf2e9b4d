// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "mesh_import/mesh_edges.hpp"
#include "mesh_import/mesh_nesting.hpp"
#include "mesh_import/mesh_slivers.hpp"
#include "mesh_import/mesh_touching.hpp"

namespace hapticd::importing {
namespace {

using brep::kNone;
using Corners = std::array<std::uint32_t, 3>;
using Eigen::Vector3d;

class Repair {
 public:
  Repair(const MeshFile& mesh, double scale, MeshReport& report) : corners_(mesh.corners), report_(report) {
    points_.reserve(mesh.points.size());
    for (const Vector3d& p : mesh.points) points_.emplace_back(scale * p);
  }

  void run() {
    dropEmpty();
    dropDuplicates();
    edges_ = meshEdges(corners_);
    orient();
    edges_ = meshEdges(corners_);  // flipped triangles have other edge numbers
    turnOutward();
    countEdges();
    report_.flipped = static_cast<std::size_t>(std::count(turned_.begin(), turned_.end(), 1));
    report_.crossings = crossingsOf(points_, corners_, shell_, report_.shells);
    dropUnusedPoints();
  }

  std::vector<Vector3d> points_;
  std::vector<Corners> corners_;
  std::vector<MeshEdge> edges_;

 private:
  void dropEmpty() {
    report_.degenerate =
        std::erase_if(corners_, [](const Corners& c) { return c[0] == c[1] || c[1] == c[2] || c[2] == c[0]; });
    report_.joined = joinFreePoints(points_, corners_);
    report_.slivers = takeInSlivers(points_, corners_);
    report_.degenerate += std::erase_if(corners_, [this](const Corners& c) { return isEmptyTriangle(points_, c); });
  }

  void dropDuplicates() {
    std::vector<std::pair<Corners, std::uint32_t>> sorted;
    sorted.reserve(corners_.size());
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      Corners c = corners_[i];
      std::sort(c.begin(), c.end());
      sorted.emplace_back(c, i);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> drop(corners_.size(), 0);
    for (std::size_t i = 1; i < sorted.size(); ++i)
      if (sorted[i].first == sorted[i - 1].first) drop[sorted[i].second] = 1;
    std::size_t at = 0;
    report_.duplicates = std::erase_if(corners_, [&](const Corners&) { return drop[at++] != 0; });
  }

  /// Reverses triangles so that neighbours agree. In each shell the orientation of the majority is kept.
  void orient() {
    const std::vector<std::uint32_t> across = pairedNeighbours(edges_, corners_.size());
    shell_.assign(corners_.size(), kNone);
    turned_.assign(corners_.size(), 0);
    std::vector<char> flip(corners_.size(), 0);
    std::vector<std::uint32_t> members;
    for (std::uint32_t seed = 0; seed < corners_.size(); ++seed) {
      if (shell_[seed] != kNone) continue;
      members.assign(1, seed);
      shell_[seed] = static_cast<std::uint32_t>(report_.shells);
      std::size_t flips = 0;
      for (std::size_t i = 0; i < members.size(); ++i) {
        const std::uint32_t t = members[i];
        flips += flip[t] != 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t code = across[3 * t + k];
          if (code == kNone) continue;
          const std::uint32_t other = code / 4, m = code % 4;
          const bool alike = corners_[t][k] == corners_[other][m];  // the edge runs in the same direction in both
          if (shell_[other] == kNone) {
            shell_[other] = shell_[seed];
            flip[other] = static_cast<char>((flip[t] != 0) != alike);
            members.push_back(other);
          } else if (((flip[t] != 0) != (flip[other] != 0)) != alike && t < other) {
            ++report_.unorientable;
          }
        }
      }
      const bool majority = 2 * flips > members.size();
      for (const std::uint32_t t : members)
        if ((flip[t] != 0) != majority) turn(t);
      ++report_.shells;
    }
  }

  void turn(std::size_t t) {
    std::swap(corners_[t][1], corners_[t][2]);
    turned_[t] = turned_[t] == 0 ? 1 : 0;  // one that is turned twice is as in the file
  }

  void countEdges() {
    std::vector<std::uint32_t> next(points_.size(), kNone);  // next point along the free edges
    for (std::size_t i = 0; i < edges_.size();) {
      const std::size_t end = endOfEdge(edges_, i);
      if (end - i > 2) ++(solidsTouch(points_, corners_, edges_, i, end) ? report_.touching : report_.non_manifold);
      if (end - i == 1) {
        ++report_.free_edges;
        const Corners& c = corners_[edges_[i].code / 4];
        const std::uint32_t k = edges_[i].code % 4;
        next[c[k]] = c[(k + 1) % 3];
      }
      i = end;
    }
    report_.closed = report_.free_edges == 0 && report_.non_manifold == 0 && report_.unorientable == 0;
    if (report_.closed) report_.volume = volume_;
    for (std::uint32_t start = 0; start < next.size(); ++start) {
      if (next[start] == kNone) continue;
      ++report_.holes;
      for (std::uint32_t at = start; at != kNone && next[at] != kNone;) at = std::exchange(next[at], kNone);
    }
  }

  /// Returns which shells have no border: along each edge, as many of a shell's triangles run one way as the other way.
  std::vector<char> closedShells() const {
    std::vector<char> closed(report_.shells, 1);
    std::map<std::uint32_t, int> balance;  // by shell
    for (std::size_t i = 0, end = 0; i < edges_.size(); i = end) {
      end = endOfEdge(edges_, i);
      if (end - i == 2 && shell_[edges_[i].code / 4] == shell_[edges_[i + 1].code / 4]) continue;
      balance.clear();
      for (std::size_t k = i; k < end; ++k)
        balance[shell_[edges_[k].code / 4]] += runsForward(corners_, edges_[k]) ? 1 : -1;
      for (const auto& [shell, sum] : balance)
        if (sum != 0) closed[shell] = 0;
    }
    return closed;
  }

  /// Reverses closed shells that are inside out.
  void turnOutward() {
    const std::vector<char> closed = closedShells();
    const Nesting nesting = nestingOf({points_, corners_, shell_, closed});
    report_.solids_inside = nesting.solids_inside;
    if (nesting.incomplete)
      report_.remarks.emplace_back(
          "there are too many closed surfaces to look for cavities: small ones are felt as solid bodies");
    for (std::size_t s = 0; s < closed.size(); ++s)
      volume_ += nesting.inside_out[s] != 0 ? -nesting.volume[s] : nesting.volume[s];
    for (std::size_t t = 0; t < corners_.size(); ++t)
      if (nesting.inside_out[shell_[t]] != 0) turn(t);
    const auto turned = std::count(nesting.inside_out.begin(), nesting.inside_out.end(), 1);
    if (turned > 0) edges_ = meshEdges(corners_);
  }

  void dropUnusedPoints() {
    std::vector<std::uint32_t> number(points_.size(), kNone);
    std::vector<Vector3d> kept;
    for (Corners& c : corners_)
      for (std::uint32_t& corner : c) {  // numbered in the order of use, so neighbours stay close in memory
        if (number[corner] == kNone) {
          number[corner] = static_cast<std::uint32_t>(kept.size());
          kept.push_back(points_[corner]);
        }
        corner = number[corner];
      }
    points_ = std::move(kept);
  }

  MeshReport& report_;
  double volume_ = 0;                 ///< [m^3] of all closed shells
  std::vector<std::uint32_t> shell_;  ///< shell of each triangle
  std::vector<char> turned_;          ///< 1 for each triangle that is reversed
};

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Returns a point as text, such as "0.01, 0, 0.02 m".
std::string where(const Vector3d& p) {
  std::string text;
  for (int k = 0; k < 3; ++k) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4g", k > 0 ? ", " : "", p[k]);
    text += number;
  }
  return text + " m";
}

/// Refuses what a part file does not hold, before the squares of coordinates overflow.
void refuseFarPoints(const MeshFile& mesh, double scale) {
  constexpr double kFarthest = 1e6;  // [m] as in part_check.cpp
  double farthest = 0;
  for (const Corners& c : mesh.corners)  // points without a triangle are left out of the part
    for (const std::uint32_t i : c) farthest = std::max(farthest, scale * mesh.points[i].lpNorm<Eigen::Infinity>());
  if (farthest <= kFarthest) return;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "a coordinate is %.10g m, expected at most 1000000 m\n  fix: if the file counts millimetres, add --scale "
      "0.001",
      farthest);
  throw std::invalid_argument(text);
}

}  // namespace

brep::Part meshPart(const MeshFile& mesh, const MeshOptions& options, const std::string& file_name,
                    MeshReport& report) {
  report.remarks = mesh.remarks;
  refuseFarPoints(mesh, options.scale);
  Repair repair(mesh, options.scale, report);
  repair.run();
  if (repair.corners_.empty()) throw std::invalid_argument("all triangles have zero area");
  brep::Part part;
  part.source = {file_name, "", options.unit};
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : repair.points_) {
    part.points.push_back({p.x(), p.y(), p.z()});
    box.extend(p);
  }
  for (const Corners& c : repair.corners_) part.triangles.push_back({c, {kNone, kNone, kNone}});
  for (std::size_t i = 0; i < repair.edges_.size();) {
    const std::size_t end = endOfEdge(repair.edges_, i);
    for (std::size_t k = i; end - i > 1 && k < end; ++k) {
      const std::uint32_t code = repair.edges_[k].code;
      part.triangles[code / 4].across[code % 4] = repair.edges_[k + 1 < end ? k + 1 : i].code;
    }
    i = end;
  }
  brep::Body body;
  body.kind = brep::BodyKind::kMesh;
  body.flags = report.closed ? brep::kClosed : 0;
  body.point_count = static_cast<std::uint32_t>(part.points.size());
  body.triangle_count = static_cast<std::uint32_t>(part.triangles.size());
  body.smooth_angle = options.smooth_angle;
  part.names = {file_name.substr(0, file_name.rfind('.'))};
  body.name = 0;
  part.bodies.push_back(body);
  brep::Instance instance;
  instance.body = instance.name = 0;
  part.instances.push_back(instance);
  report.triangles = part.triangles.size();
  report.points = part.points.size();
  report.size = box.sizes();
  for (const std::string& line : linesOf(report)) part.warnings.push_back(line);
  return part;
}

std::vector<std::string> linesOf(const MeshReport& r) {
  std::vector<std::string> lines = r.remarks;
  const auto say = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) lines.push_back(counted(count, one, many));
  };
  say(r.joined, "point was joined with one that differs by rounding only",
      "points were joined with others that differ by rounding only");
  say(r.slivers, "triangle of zero area was taken into its neighbour",
      "triangles of zero area were taken into their neighbours");
  say(r.degenerate, "triangle of zero area was left out", "triangles of zero area were left out");
  say(r.duplicates, "duplicate triangle was left out", "duplicate triangles were left out");
  say(r.flipped, "triangle was reversed", "triangles were reversed");
  say(r.touching, "edge has more than two triangles, those of solids that touch there",
      "edges have more than two triangles, those of solids that touch there");
  say(r.non_manifold, "edge has more than two triangles", "edges have more than two triangles");
  say(r.unorientable, "edge has triangles with contradictory outward sides",
      "edges have triangles with contradictory outward sides");
  if (const Crossings& c = r.crossings; c.pairs > 0)
    lines.push_back(
        counted(r.shells, "shell", "shells") + " pass through each other: " +
        counted(c.pairs, "pair of triangles crosses", "pairs of triangles cross") + ", the first at " + where(c.first) +
        "; the faces inside are felt as well: unite the bodies in the program that wrote the file (boolean union)");
  if (!r.crossings.all_tried)
    lines.emplace_back("not all pairs of triangles were tried, so its shells may pass through each other");
  say(r.solids_inside, "shell lies inside another one and faces outward as well: a body in a body, no cavity",
      "shells lie inside others and face outward as well: bodies in a body, no cavities");
  if (r.holes > 0)
    lines.push_back(counted(r.holes, "hole", "holes") + " with " + counted(r.free_edges, "free edge", "free edges"));
  return lines;
}

}  // namespace hapticd::importing
