// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_repair.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "mesh_import/mesh_coincident.hpp"
#include "mesh_import/mesh_duplicates.hpp"
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
  Repair(const MeshFile& mesh, const MeshOptions& options, MeshReport& report)
      : triangles_{mesh.corners, std::vector<std::uint32_t>(mesh.corners.size())}, options_(options), report_(report) {
    std::iota(triangles_.from.begin(), triangles_.from.end(), 0u);
    points_.reserve(mesh.points.size());
    for (const Vector3d& p : mesh.points) points_.emplace_back(options.scale * p);
  }

  void run() {
    options_.progress("joining the corners of triangles");
    dropDuplicates(Flange::kKeepOneSide);
    dropEmpty();
    dropDuplicates(Flange::kLeaveOut);  // a fold whose sliver was taken in lies on itself
    options_.progress("turning the triangles outward");
    edges_ = meshEdges(corners_);
    orient();
    edges_ = meshEdges(corners_);  // flipped triangles have other edge numbers
    turnOutward();
    countEdges();
    report_.flipped = static_cast<std::size_t>(std::count(turned_.begin(), turned_.end(), 1));
    options_.progress("looking for surfaces that cross");
    report_.crossings = crossingsOf(points_, corners_, shell_, report_.shells);
    dropUnusedPoints();
  }

  std::vector<Vector3d> points_;
  MeshTriangles triangles_;
  std::vector<Corners>& corners_ = triangles_.corners;
  std::vector<MeshEdge> edges_;

 private:
  void dropEmpty() {
    report_.degenerate = triangles_.eraseIf([this](std::size_t t) {
      const Corners& c = corners_[t];
      return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    });
    const double rounding = roundingOf(points_, corners_);
    report_.joined = joinFreePoints(points_, rounding, triangles_);
    report_.joined += joinCoincident(points_, rounding, triangles_);
    report_.slivers = takeInSlivers(points_, rounding, triangles_);
    report_.degenerate += triangles_.eraseIf([this](std::size_t t) { return isEmptyTriangle(points_, corners_[t]); });
  }

  void dropDuplicates(Flange flange) {
    const LeftOut left = leaveOutDuplicates(triangles_, flange);
    report_.duplicates += left.duplicates;
    report_.back_to_back += left.back_to_back;
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

  const MeshOptions& options_;
  MeshReport& report_;
  double volume_ = 0;                 ///< [m^3] of all closed shells
  std::vector<std::uint32_t> shell_;  ///< shell of each triangle
  std::vector<char> turned_;          ///< 1 for each triangle that is reversed
};

}  // namespace

RepairedMesh repaired(const MeshFile& mesh, const MeshOptions& options, MeshReport& report) {
  Repair repair(mesh, options, report);
  repair.run();
  report.triangles = repair.corners_.size();
  report.points = repair.points_.size();
  return {std::move(repair.points_), std::move(repair.corners_), std::move(repair.edges_),
          std::move(repair.triangles_.from)};
}

}  // namespace hapticd::importing
