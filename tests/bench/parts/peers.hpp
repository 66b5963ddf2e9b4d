// SPDX-License-Identifier: MIT
/// Other libraries that find the nearest point of a triangle mesh.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace hapticd::bench {

class Peer {
 public:
  virtual ~Peer() = default;
  /// Returns the distance [m] from p to the mesh. @param bound [m] known upper bound of the distance; infinite if there
  /// is none @param near becomes the nearest point; if `bound` is finite, it must be the nearest point of the last
  /// query
  virtual double distance(const Eigen::Vector3d& p, double bound, Eigen::Vector3d& near) = 0;
  virtual std::string name() const = 0;
  /// True if a query takes so long that only a few are made.
  virtual bool slow() const { return false; }
};

/// Returns the libraries with which this program was built.
std::vector<std::unique_ptr<Peer>> makePeers(const std::vector<std::array<double, 3>>& points,
                                             const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace hapticd::bench
