/// `hapticd import --medial`: a soft body from a closed surface.
#pragma once
#include <string>

namespace hapticd::cli {

struct MedialImport {
  std::string file, out;
  double scale = 1;      ///< metres per unit of an OBJ or STL
  double tolerance = 0;  ///< [m]; 0: a hundredth of the body's size
  int samples = 20000;   ///< points on the surface
  int most_spheres = 2000;
  double least_angle = 60;  ///< [degrees]
  double stiffness = 300, damping = 0.5, mass = 0.01;
};

/// [main] @returns the exit code of the program
int importMedial(const MedialImport& options);

}  // namespace hapticd::cli
