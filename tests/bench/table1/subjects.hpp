// SPDX-License-Identifier: MIT
/// The five models of Table 1, and the route of the operator's finger over each.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

namespace hapticd::table1 {

/// The place at which the operator aims the finger, in the model frame.
struct Aim {
  Eigen::Vector3d point{0, 0, 0};   ///< [m] point on the surface, or beside it if the finger goes round an edge
  Eigen::Vector3d normal{0, 0, 1};  ///< outward
  /// [m] Depth below the surface up to which this side of the model is still the nearest. A target point deeper than
  /// this would pull the finger to another side. So the operator pushes less near an edge or on a thin stem.
  double room = 1;
};

/// Mean, standard deviation and maximum of the depth [mm].
struct Depths {
  double mean = 0, std = 0, max = 0;
};

/// The plugin of a model, with its parameters in a scene.
struct Plugin {
  std::string name, motion;  ///< `motion` is "" if the plugin moves the model by itself
  std::string parameters;    ///< YAML
};

struct Subject {
  std::string name;
  std::string geometry;              ///< model file under config/models
  double scale;                      ///< scale of that file, so that the model fills the arm's workspace
  Plugin moving;                     ///< test 2; in test 1 all are rigid and at rest
  std::function<Aim(double)> route;  ///< aim at time t [s]
  Depths paper[2];                   ///< Thompson et al. 1999, Table 1: test 1 and test 2
  double position_y = 0;             ///< [m] height of the model in the world
};

/// YAML parameters of the wall in every row but the button's: Eq. 4 with n = 1/2 and 6000 N/m (6 N at 1 mm).
extern const char* const kWall;

/// The detent curve of the button, as travel [m] and force [N], and the slope beyond its last point [N/m].
inline constexpr double kDetent[4][2] = {{0, 0}, {0.006, 9}, {0.009, 5}, {0.012, 8}}, kEndSlope = 8000;
inline constexpr double kSurface = 6000;  ///< [N/m] stiffness of every wall (paper)

/// Text that says how cube, cylinder and goblet move in test 2.
extern const char* const kMotionOfSolids;

/// [main] Returns all five models, in the paper's order.
std::vector<Subject> subjects();

}  // namespace hapticd::table1
