// SPDX-License-Identifier: MIT
/// Finds nearest points of a CAD file with Open CASCADE, prepared as well as possible. Each face has an extrema object
/// and a trim classifier, and each edge an extrema object, made once. Faces and edges whose boxes are too far away are
/// skipped.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>

namespace hapticd::bench {

class OcctPart {
 public:
  virtual ~OcctPart() = default;
  /// Returns the distance [m] from p to the part. @param bound [m] known upper bound of the distance
  virtual double distance(const Eigen::Vector3d& p, double bound) = 0;
};

/// Reads a file (.step or .brep) with one body, in the frame of the file. Returns null if this program was built
/// without Open CASCADE.
std::unique_ptr<OcctPart> readOcctPart(const std::string& file);

}  // namespace hapticd::bench
