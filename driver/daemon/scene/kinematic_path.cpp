// SPDX-License-Identifier: MIT
#include "scene/kinematic_path.hpp"

#include "document/reader.hpp"

namespace hapticd::scene {

using namespace document;
namespace {

constexpr double kFarthest = 1e6;  ///< [m] largest coordinate
constexpr size_t kPoseColumns = 8;

std::string wrongQuaternion(const double* row, size_t columns) {
  if (columns < kPoseColumns) return "";
  Eigen::Quaterniond q(row[4], row[5], row[6], row[7]);
  if (normalise(q)) return "";
  return "the quaternion has length " + numberText(q.norm()) + ", expected 1 within 0.001 (order w, x, y, z)";
}

std::vector<PathPoint> pointsOf(const CsvTable& table) {
  std::vector<PathPoint> points(table.rows());
  for (size_t i = 0; i < table.rows(); ++i) {
    const double* v = table.row(i);
    points[i].t = v[0];
    points[i].pose.position = {v[1], v[2], v[3]};
    if (table.columns < kPoseColumns) continue;
    Eigen::Quaterniond& q = points[i].pose.orientation = {v[4], v[5], v[6], v[7]};
    normalise(q);  // wrongQuaternion() has allowed it
  }
  return points;
}

}  // namespace

const CsvRules& kinematicPathRules() {
  static const CsvRules kRules{{"t,x,y,z,qw,qx,qy,qz", "t,x,y,z"}, true, true, kFarthest, wrongQuaternion, "qw"};
  return kRules;
}

std::vector<PathPoint> parseKinematicPath(const std::string& text, const std::string& file, Problems& problems) {
  const auto table = parseCsv(text, file, kinematicPathRules(), problems);
  return table ? pointsOf(*table) : std::vector<PathPoint>{};
}

std::vector<PathPoint> readKinematicPath(const std::filesystem::path& file, Problems& problems) {
  auto table = readCsv(file, kMaxPathBytes, kinematicPathRules(), problems);
  if (!table) table = readSoundRows(file, kMaxPathBytes, kinematicPathRules());  // so that a check can judge them
  return table ? pointsOf(*table) : std::vector<PathPoint>{};
}

}  // namespace hapticd::scene
