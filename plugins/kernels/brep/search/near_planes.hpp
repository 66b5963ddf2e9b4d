// SPDX-License-Identifier: MIT
/// Planes between a slow probe and the triangles around it. They tell at little cost that none of these triangles has
/// become the nearest.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/brep/search/near_rows.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {

/// Where the probe is, seen from the place where the planes were made.
struct PlaneProbe {
  Float4 at[3];  ///< [m]
  double way;    ///< [m] length of `at`
};

/// A plane for each gathered row, and one for each triangle of the rows that were examined. A plane parts its row or
/// triangle from the probe, so the distance to the plane is a lower bound of the distance to what is behind it. A
/// triangle is convex, as is the disc around a row. So a plane across the way to the nearest point is such a plane, and
/// while the probe stays near, its distance is hardly less than that of the triangle.
class NearPlanes {
 public:
  static constexpr int kMostTriangles = 32;
  static constexpr int kMostPlanes = NearTriangles::kMostRows + kMostTriangles;
  static constexpr int kNowhere = -1;

  /// [rt] Forgets all planes.
  void forget() noexcept { rows_ = triangles_ = 0; }
  /// [rt] True if the planes of the rows `near` are known and p (frame of the body) is so near to the place where they
  /// were made that they are close bounds.
  bool serve(const Eigen::Vector3d& p) const noexcept {
    return rows_ > 0 && (p - center_).squaredNorm() <= reach_ * reach_;
  }
  /// [rt] Makes a plane for each of the rows. @param reach [m] serve() is true within this distance from p
  void make(const NearTriangles& near, const BoxProbe& probe, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] Removes the plane of a row: all of its triangles were added.
  void dropRow(int row) noexcept { putLane(at(row).offset, row % 4, kEndless4[0]); }
  bool hasRoom() const noexcept { return triangles_ + 4 <= kMostTriangles; }
  /// [rt] Adds a triangle, whose plane learn() must make. Returns its number.
  int add(Element triangle) noexcept;
  /// [rt] Makes the plane of a triangle with these corners from its foot for the probe p.
  void learn(int plane, const Eigen::Vector3d& p, const Eigen::Vector3d& foot,
             const std::array<Eigen::Vector3d, 3>& corners) noexcept;

  int fours() const noexcept { return row_fours_ + (triangles_ + 3) / 4; }
  bool isRow(int plane) const noexcept { return plane < 4 * row_fours_; }
  /// [rt] Returns the triangle of a plane that is not of a row.
  Element triangle(int plane) const noexcept { return of_[static_cast<std::size_t>(plane - 4 * row_fours_)]; }
  /// [rt] Returns the number of the plane of a triangle, or kNowhere. @param likely where it probably is
  int find(Element triangle, int likely) const noexcept;

  PlaneProbe probe(const Eigen::Vector3d& p) const noexcept {
    const Eigen::Vector3d x = p - center_;
    const auto wide = [](double number) { return Float4{} + static_cast<float>(number); };
    return {{wide(x.x()), wide(x.y()), wide(x.z())}, x.norm()};
  }
  /// [rt] Returns lower bounds of the distances [m] to what is behind four planes, each too high by rounding() at most.
  Float4 distances(int four, const PlaneProbe& probe) const noexcept {
    const Four& f = fours_[static_cast<std::size_t>(four)];
    return f.normal[0] * probe.at[0] + f.normal[1] * probe.at[1] + f.normal[2] * probe.at[2] + f.offset;
  }
  /// [rt] Returns by how much a bound of about `distance` [m] may be too high.
  static double rounding(double distance, const PlaneProbe& probe) noexcept { return 1e-6 * (distance + probe.way); }

 private:
  /// Unit normals toward the probe, or a little shorter, and distances from center_ [m].
  struct alignas(64) Four {
    Float4 normal[3], offset;
  };
  Four& at(int plane) noexcept { return fours_[static_cast<std::size_t>(plane / 4)]; }

  std::array<Four, kMostPlanes / 4> fours_;
  std::array<Element, kMostTriangles> of_;
  Eigen::Vector3d center_{0, 0, 0};
  double reach_ = 0;
  int rows_ = 0, row_fours_ = 0, triangles_ = 0;
};

}  // namespace hapticd::brep
