// SPDX-License-Identifier: MIT
/// The five models of Table 1 and the way over each that the operator's finger takes.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

namespace hapticd::table1 {

/// Where the operator wants the finger, model frame.
struct Aim {
  Eigen::Vector3d point{0, 0, 0};   ///< on the surface [m], or beside it where the finger goes round an edge
  Eigen::Vector3d normal{0, 0, 1};  ///< outward
  /// [m] How far behind the surface this side of the model is still the nearest. A pull to a point behind it would drag
  /// the finger to the other side: an operator pushes less hard near an edge or on a thin stem.
  double room = 1;
};

/// Mean, standard deviation and maximum of the depth [mm].
struct Depths {
  double mean = 0, std = 0, max = 0;
};

/// What plays a model in a scene.
struct Plugin {
  std::string name, motion;  ///< motion "": the plugin knows
  std::string parameters;    ///< YAML
};

struct Subject {
  std::string name;
  std::string geometry;              ///< model file under config/models
  double scale;                      ///< of that file: the models fill the arm's workspace
  Plugin moving;                     ///< test 2; in test 1 all are rigid and at rest
  std::function<Aim(double)> route;  ///< aim at time t [s]
  Depths paper[2];                   ///< Thompson et al. 1999, Table 1: test 1 and test 2
  double position_y = 0;             ///< [m] where the model stands
};

/// The wall of every row but the button's, YAML: Eq. 4 with n = 1/2 and 6000 N/m (6 N at 1 mm).
extern const char* const kWall;

/// The button's own resistance and the slope beyond its last point: travel [m], force [N]; [N/m].
inline constexpr double kDetent[4][2] = {{0, 0}, {0.006, 9}, {0.009, 5}, {0.012, 8}}, kEndSlope = 8000;
inline constexpr double kSurface = 6000;  ///< [N/m] of every wall (paper)

/// How cube, cylinder and goblet move in test 2, in words.
extern const char* const kMotionOfSolids;

/// [main] All five, in the paper's order.
std::vector<Subject> subjects();

}  // namespace hapticd::table1
