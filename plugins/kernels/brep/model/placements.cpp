// SPDX-License-Identifier: MIT
#include "kernels/brep/model/placements.hpp"

#include <set>
#include <stdexcept>

#include "kernels/part/names.hpp"

namespace hapticd::brep {
namespace {

/// True if `wanted` is the name or the path of the instance itself.
bool isNamed(const Part& part, std::uint32_t index, const std::string& wanted) {
  return instanceName(part, index) == wanted || instancePath(part, index) == wanted;
}

/// True if `wanted` names the instance or an assembly that contains it.
bool belongs(const Part& part, std::uint32_t index, const std::string& wanted) {
  if (wanted.empty()) return true;
  for (; index != kNone; index = part.instances[index].parent)
    if (isNamed(part, index, wanted)) return true;
  return false;
}

/// Refuses a name that instances with different paths have. Instances with one path cannot be distinguished, so all of
/// them are taken.
void refuseAmbiguous(const Part& part, const std::string& parameter, const std::string& wanted) {
  constexpr std::size_t kMost = 12;
  std::set<std::string> paths;
  for (std::uint32_t i = 0; i < part.instances.size(); ++i) {
    const std::uint32_t parent = part.instances[i].parent;
    if (instancePath(part, i) == wanted) return;
    if (instanceName(part, i) == wanted && (parent == kNone || !belongs(part, parent, wanted)))
      paths.insert(instancePath(part, i));
  }
  if (paths.size() < 2) return;
  std::string listed;
  std::size_t count = 0;
  for (const std::string& path : paths)
    if (count++ < kMost) listed += (count > 1 ? ", " : "") + path;
  if (count > kMost) listed += ", ... (" + std::to_string(count) + " in all)";
  throw std::invalid_argument(parameter + ": several are named '" + wanted + "', expected one of their paths " +
                              listed);
}

[[noreturn]] void failUnknown(const Part& part, const std::string& parameter, const std::string& wanted) {
  constexpr std::size_t kMost = 12;
  std::string names;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < part.instances.size(); ++i, ++count)
    if (count < kMost) names += (count > 0 ? ", " : "") + instancePath(part, i);
  if (count > kMost) names += ", ... (" + std::to_string(count) + " in all)";
  throw std::invalid_argument(parameter + ": there is no '" + wanted + "', expected one of " + names);
}

Placement placementOf(const Part& part, std::uint32_t index) {
  const Instance& instance = part.instances[index];
  Placement place;
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<std::size_t>(4 * row);
    place.rotation.row(row) = Eigen::RowVector3d(instance.pose[at], instance.pose[at + 1], instance.pose[at + 2]);
    place.position[row] = instance.pose[at + 3];
  }
  place.moved = !place.rotation.isIdentity(0) || !place.position.isZero(0);
  place.body = instance.body;
  place.instance = index;
  const Body& body = part.bodies[instance.body];
  // a closed shell is one of which the importer did not make a solid, because its faces bound no single volume
  place.solid = body.kind != BodyKind::kShell && (body.flags & kClosed) != 0;
  return place;
}

/// Removes the placements that belong to an instance or assembly. @throws std::invalid_argument if there are none
void leaveOut(const Part& part, const std::string& from, const std::string& name, std::vector<Placement>& placements) {
  refuseAmbiguous(part, "without", name);
  const auto named = [&](const Placement& place) { return belongs(part, place.instance, name); };
  if (std::erase_if(placements, named) > 0) return;
  for (std::uint32_t i = 0; i < part.instances.size(); ++i)
    if (belongs(part, i, name))
      throw std::invalid_argument("without: '" + name + "' is not in '" + from + "', from which it is to be left out");
  failUnknown(part, "without", name);
}

}  // namespace

std::vector<Placement> placementsOf(const Part& part, const ModelOptions& options, std::uint32_t& feature_count) {
  const std::string& wanted = options.instance;
  std::vector<Placement> placements;
  std::uint64_t features = 0;
  if (!wanted.empty()) refuseAmbiguous(part, "instance", wanted);
  for (std::uint32_t i = 0; i < part.instances.size(); ++i) {
    if (part.instances[i].body == kNone) continue;
    const Body& body = part.bodies[part.instances[i].body];
    const std::uint64_t count = std::uint64_t{body.face_count} + body.triangle_count;
    if (count > 0 && belongs(part, i, wanted)) {
      placements.push_back(placementOf(part, i));
      placements.back().first_feature = static_cast<std::uint32_t>(features);
    }
    features += count;  // features are numbered over all instances of the file, also those that are not traced
    if (features >= kNone)
      throw std::invalid_argument("the part has more than 4,294,967,294 faces over all instances, expected fewer");
  }
  feature_count = static_cast<std::uint32_t>(features);
  if (placements.empty() && !wanted.empty()) failUnknown(part, "instance", wanted);
  if (placements.empty())
    throw std::invalid_argument("the part has neither faces nor triangles, expected at least one");
  for (const std::string& name : options.without) leaveOut(part, wanted, name, placements);
  if (placements.empty()) throw std::invalid_argument("without: leaves out everything, expected some of the instances");
  return placements;
}

}  // namespace hapticd::brep
