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
  /// Distance [m] from p to the mesh. `bound`: it is known to be no larger; `near`: the nearest point, on entry
  /// that of the query before if `bound` is finite.
  virtual double distance(const Eigen::Vector3d& p, double bound, Eigen::Vector3d& near) = 0;
  virtual std::string name() const = 0;
  /// Takes so long that few queries must do.
  virtual bool slow() const { return false; }
};

/// Those that this program was built with.
std::vector<std::unique_ptr<Peer>> makePeers(const std::vector<std::array<double, 3>>& points,
                                             const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace hapticd::bench
