// SPDX-License-Identifier: MIT
#include "cli/recording/force_of_a_tick.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <limits>

#include "cli/recording/recorded_part.hpp"
#include "record/picture.hpp"

namespace hapticd::cli {
namespace {

using Eigen::Vector3d;
using Stream = record::RecordedStream;

constexpr double kAlike = 1e-3;  // [N] forces that differ by less are printed as one

/// Three columns whose names end in x, y and z; zero where a stream has none.
class Vectors {
 public:
  Vectors(const Stream& stream, const std::string& name) : stream_(stream) {
    for (size_t axis = 0; axis < 3; ++axis) columns_[axis] = stream.find(name + "xyz"[axis]);
  }
  Vector3d at(uint64_t row) const {
    Vector3d vector = Vector3d::Zero();
    for (size_t axis = 0; axis < 3; ++axis)
      if (columns_[axis] != nullptr) vector[static_cast<int>(axis)] = stream_.number(row, *columns_[axis]);
    return vector;
  }

 private:
  const Stream& stream_;
  std::array<const record::Column*, 3> columns_{};
};

/// Returns a column; NaN where a stream has none.
double numberAt(const Stream& stream, uint64_t row, const std::string& name) {
  const record::Column* column = stream.find(name);
  return column != nullptr ? stream.number(row, *column) : std::numeric_limits<double>::quiet_NaN();
}

std::string inWords(const Vector3d& force) {
  return fmt::format("{:.3g} N ({:.3g}, {:.3g}, {:.3g})", force.norm(), force.x(), force.y(), force.z());
}

/// Returns the row of the first tick from a time [s] on. There is one.
uint64_t rowAt(const Stream& ticks, double at) {
  const record::Column* t = ticks.find("t");
  uint64_t row = 0;
  while (row + 1 < ticks.rows() && ticks.number(row, *t) < at) ++row;
  return row;
}

/// Returns the row of the tick in which an arm got most force; rows() if it never got any.
uint64_t rowOfMost(const Stream& ticks, const std::string& arm) {
  const Vectors sent(ticks, arm + "sent_f");
  uint64_t found = ticks.rows();
  double most = 0;
  for (uint64_t row = 0; row < ticks.rows(); ++row)
    if (const double force = sent.at(row).norm(); force > most) most = force, found = row;
  return found;
}

/// Says what a model pushes in a row of contacts, and where.
std::string ofModel(const Stream& contacts, uint64_t row, const servo::RunModel* model, const std::string& name) {
  const Vector3d force = Vectors(contacts, "f").at(row), normal = Vectors(contacts, "n").at(row);
  const double depth = numberAt(contacts, row, "depth"), gain = numberAt(contacts, row, "gain");
  std::string text = name + ": " + inWords(force);
  if (depth > 0) text += fmt::format(", {:.3g} mm deep", 1e3 * depth);
  const double feature = numberAt(contacts, row, "feature");
  if (depth > 0 && model != nullptr && feature >= 0)
    text += " at " + featureNameIn(partOf(model->model), static_cast<uint32_t>(feature));
  const Vector3d along = force - force.dot(normal) * normal;
  if (along.norm() > kAlike)
    text += fmt::format("; {:.3g} N of it out of the surface, {:.3g} N along it", force.dot(normal), along.norm());
  if (gain < 1) text += fmt::format("; it fades, and {:.0f} % of this force count", 100 * gain);
  return text;
}

/// Adds a line for each model that is touched, or that pushes, in a tick.
void addModels(const Stream& contacts, double tick, uint32_t arm, const servo::RunModels& models,
               std::vector<std::string>& lines) {
  const record::Column *number_of_tick = contacts.find("tick"), *probe = contacts.find("probe");
  if (number_of_tick == nullptr || probe == nullptr) return;
  for (uint64_t row = 0; row < contacts.rows(); ++row) {
    if (contacts.number(row, *number_of_tick) != tick || contacts.number(row, *probe) != arm) continue;
    if (!(numberAt(contacts, row, "depth") > 0) && Vectors(contacts, "f").at(row).norm() < kAlike) continue;
    const double number = numberAt(contacts, row, "model");
    const size_t place = models.find(number, tick);
    lines.push_back("  " + ofModel(contacts, row, place == servo::RunModels::kNone ? nullptr : &models.all()[place],
                                   models.nameOf(number, tick)));
  }
}

/// Says what became of the force that models and programs ask for.
std::string ofLimits(const Vector3d& asked, const Vector3d& sent, double fault) {
  if (fault > 0)
    return "  fault: " + record::nameOfFault(static_cast<uint32_t>(fault)) + ", which takes the force away";
  if ((asked - sent).norm() < kAlike) return "";
  return "  together they ask for " + inWords(asked) + ", which the limits, ramps or passivity of the arm changed";
}

void addArm(const record::Recording& recording, const servo::RunModels& models, const Stream& ticks, uint64_t row,
            uint32_t arm, const std::string& name, std::vector<std::string>& lines) {
  const std::string column = fmt::format("arm{}_", arm);
  const Vector3d sent = Vectors(ticks, column + "sent_f").at(row), client = Vectors(ticks, column + "client_f").at(row);
  lines.push_back(fmt::format("{} got {} at {:.4f} s", name, inWords(sent), numberAt(ticks, row, "t")));
  const size_t before = lines.size();
  if (const Stream* contacts = recording.stream("contacts"))
    addModels(*contacts, numberAt(ticks, row, "tick"), arm, models, lines);
  if (client.norm() > kAlike) lines.push_back("  programs: " + inWords(client));
  if (lines.size() == before) lines.push_back("  no model is touched, and no program pushes");
  const std::string limits =
      ofLimits(Vectors(ticks, column + "f").at(row) + client, sent, numberAt(ticks, row, column + "fault"));
  if (!limits.empty()) lines.push_back(limits);
}

}  // namespace

Result<std::vector<std::string>> forceLines(const record::Recording& recording, const servo::RunModels& models,
                                            const scene::Scene& scene, std::optional<double> at) {
  std::vector<std::string> lines;
  const Stream* ticks = recording.stream("ticks");
  if (ticks == nullptr || ticks->rows() == 0 || ticks->find("t") == nullptr) return lines;
  const double first = numberAt(*ticks, 0, "t"), last = numberAt(*ticks, ticks->rows() - 1, "t");
  if (at && !(*at >= first && *at <= last))
    return Error{fmt::format("--at {:g}: expected a time of the recording, {:g} to {:g} s", *at, first, last)};
  for (uint32_t arm = 0; arm < scene.devices.size(); ++arm) {
    const uint64_t row = at ? rowAt(*ticks, *at) : rowOfMost(*ticks, fmt::format("arm{}_", arm));
    if (row < ticks->rows()) addArm(recording, models, *ticks, row, arm, scene.devices[arm].name, lines);
  }
  return lines;
}

}  // namespace hapticd::cli
