// SPDX-License-Identifier: MIT
/// Traces a case as a user would: with `hapticd trace`, or in a session that is recorded.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "case_files.hpp"

namespace hapticd::extremes {

using Eigen::Vector3d;
namespace fs = std::filesystem;

std::vector<Answer> traceThroughDoor(const Case& c, const fs::path& hapticd) {
  const CaseFiles files(c);
  files.run(fmt::format("'{}' trace scene.yaml --probe probe.csv --out out.csv", hapticd.string()));
  const Table table(files / "out.csv");
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < table.rows(); ++i) answers.push_back(table.answer(i));
  return answers;
}

std::vector<Answer> traceInSession(const Case& c, const fs::path& hapticd, const fs::path& modules) {
  const CaseFiles files(c, "arm.yaml");
  std::ofstream(files / "arm.yaml") << "hapticd-device: 1\nmodule: walker\nparameters: {path: probe.csv}\n";
  const double seconds = static_cast<double>(c.probe.size() + 2) / c.rate;
  // A sample that is not finite is a fault. The run then ends with exit code 1, but tracing goes on after that sample.
  const bool faulty = std::any_of(c.probe.begin(), c.probe.end(), [](const Vector3d& p) { return !p.allFinite(); });
  files.run(
      fmt::format("export HAPTICD_PLUGIN_PATH='{0}'; '{1}' run scene.yaml --virtual-time --for {2} --record run.h5; "
                  "test $? = {3} && '{1}' replay run.h5 && '{1}' export run.h5 --csv .",
                  modules.string(), hapticd.string(), seconds, faulty ? 1 : 0));
  const Table ticks(files / "ticks.csv"), contacts(files / "contacts.csv");
  std::vector<Answer> answers(c.probe.size());
  for (Answer& answer : answers) answer.point.setConstant(NAN);
  for (std::size_t i = 0, contact = 0; i < ticks.rows(); ++i) {
    while (contact < contacts.rows() && contacts.at(contact, "tick") < ticks.at(i, "tick")) ++contact;
    const auto sample =
        // the arm numbers its samples by the rows of the path
        static_cast<std::size_t>(ticks.at(i, "arm0_sequence")) - 1;
    const bool known = contact < contacts.rows() && contacts.at(contact, "tick") == ticks.at(i, "tick");
    if (sample >= c.probe.size() || !known) continue;
    answers[sample] = contacts.answer(contact);
    const Vector3d tip(ticks.at(i, "arm0_x"), ticks.at(i, "arm0_y"), ticks.at(i, "arm0_z"));
    answers[sample].traced = answers[sample].traced && tip == c.probe[sample];
  }
  return answers;
}

Case moved(const Case& c, std::mt19937& random) {
  std::normal_distribution<double> any(0, 1);
  const double w = any(random), x = any(random), y = any(random), z = any(random);
  const Eigen::Quaterniond R = Eigen::Quaterniond(w, x, y, z).normalized();
  const Vector3d shift(0.5 * any(random), 0.5 * any(random), 0.5 * any(random));
  Case other = c;
  for (spline::SurfaceData& surface : other.surfaces)
    for (Vector3d& point : surface.points) point = R * point + shift;
  for (Vector3d& probe : other.probe) probe = R * probe + shift;
  return other;
}

}  // namespace hapticd::extremes
