// SPDX-License-Identifier: MIT
#include "diagnostics/hand/detent_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "diagnostics/hand/hand_script.hpp"
#include "document/node.hpp"
#include "host/class_params.hpp"

namespace hapticd::diagnostics {
namespace {

/// Collects the numbers of a YAML list such as [[0, 0], [0.003, 4]].
void collect(const document::Node& node, std::vector<double>& numbers) {
  if (const auto number = node.isScalar() ? document::toNumber(node.scalar) : std::nullopt) numbers.push_back(*number);
  for (const document::Node& item : node.items) collect(item, numbers);
}

/// Returns a list as the file gives it, or the plugin's default; empty if the plugin has no such parameter.
std::vector<double> listOf(const scene::Model& model, const hsp_class& plugin, const char* id) {
  if (const scene::Value* value = givenIn(model.parameters, id)) return value->numbers;
  std::vector<double> numbers;
  const auto index = host::paramIndexOf(plugin, id);
  const char* text = index ? host::paramAt(plugin, *index).def_text : nullptr;
  document::Problems unread;
  if (const auto node = text != nullptr ? document::parseText(text, "default", unread) : std::nullopt)
    collect(*node, numbers);
  return numbers;
}

/// [m] Returns the travel at which the force first falls; 0 if it never does, so that nothing clicks.
double clickOf(const std::vector<double>& detent) {
  for (size_t i = 0; i + 3 < detent.size(); i += 2)
    if (detent[i + 3] < detent[i + 1]) return detent[i];
  return 0;
}

std::string direction(const Eigen::Vector3d& v) {
  const auto rounded = [](double x) { return std::round(x * 100) / 100 + 0.0; };  // never -0
  return fmt::format("[{:g}, {:g}, {:g}]", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

}  // namespace

bool reportNoClick(const scene::Model& model, size_t index, const host::ShapeInstance& shape, const WalkedModel& seen,
                   bool whole, document::Problems& warnings) {
  constexpr double kStill = 1e-9, kPressed = 0.1, kAlong = 0.1;  // [m]; [N]; cosine of the angle to the axis
  const std::vector<double> detent = listOf(model, shape.description(), "detent");
  const std::vector<double> axis = listOf(model, shape.description(), "axis");
  const double click = clickOf(detent);
  if (click <= 0 || axis.size() != 3 || seen.clicked) return false;
  const auto tell = [&](const char* id, const std::string& what) {
    const scene::Value* value = givenIn(model.parameters, id);
    document::report(warnings, value != nullptr ? value->place : model.place,
                     fmt::format("models[{}].parameters.{}", index, id), what);
    return true;
  };
  const Eigen::Vector3d way = Eigen::Vector3d(axis.data()).normalized();
  if (seen.travel < kStill && seen.force > kPressed && seen.push.dot(way) < kAlong)
    return tell("axis",
                fmt::format("{} is pressed along {} with {:.3g} N and does not move: the axis {} does not lead "
                            "inwards there; expected the direction in which the hand presses, in the model frame",
                            model.name, direction(seen.push), seen.force, direction(way)));
  Eigen::AlignedBox3d box;
  const bool known = shape.bounds(box.min().data(), box.max().data());
  const double size = known ? box.diagonal().norm() : 0;
  if (known && click > size)
    return tell("detent",
                fmt::format("{} clicks at a travel of {:.4g} m, but it is only {:.3g} m large, and the hand presses it "
                            "by {:.3g} mm, with {:.2g} N at most; travel must be in m (5 mm is 0.005)",
                            model.name, click, size, seen.travel * 1e3, seen.force));
  if (!whole || seen.force < kPressed) return false;
  return tell("detent",
              fmt::format("{} never clicks: the hand presses it by {:.3g} mm, with {:.3g} N at most, but it clicks at "
                          "{:.4g} mm; expected a hand that goes deeper (hand.radius, hand.rise), or "
                          "less travel or force",
                          model.name, seen.travel * 1e3, seen.force, click * 1e3));
}

}  // namespace hapticd::diagnostics
