// SPDX-License-Identifier: MIT
/// Open CASCADE's nearest point of a CAD file, prepared as well as it can be: an extrema object and a trim classifier
/// for each face and an extrema object for each edge, made once; boxes leave out what is farther.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>

namespace hapticd::bench {

class OcctPart {
 public:
  virtual ~OcctPart() = default;
  /// Distance [m] from p to the faces. `bound` [m]: it is known to be no larger.
  virtual double distance(const Eigen::Vector3d& p, double bound) = 0;
};

/// Of one body in the file's own frame (.step or .brep); null where this program was built without Open CASCADE.
std::unique_ptr<OcctPart> readOcctPart(const std::string& file);

}  // namespace hapticd::bench
