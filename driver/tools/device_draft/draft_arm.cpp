// SPDX-License-Identifier: MIT
#include "device_draft/draft_arm.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace hapticd::device_draft {
namespace {

std::string listOf(const std::vector<double>& numbers) {
  return fmt::format("[{:g}]", fmt::join(numbers, ", "));
}

constexpr const char* kPhantom = R"(    lengths: {}     # m: upper arm, forearm; l3, l5, l6: see driver/docs/devices.md
    masses: [0, 0, 0, 0]          # kg: ma, mc, mbe, mdf; all 0: the weight is not carried; if left out, those of a Premium 1.5
)";

std::string phantomOf(const DeviceDraft& draft) {
  std::vector<double> all = draft.lengths.empty() ? std::vector<double>{0.2, 0.2} : draft.lengths;
  all.insert(all.end(), {0, 0, 0});
  return fmt::format(kPhantom, listOf(all));
}

constexpr const char* kNoLengths = "    # lengths: [a, b, c, d, e, f, r, s]    # m; if left out, those of a Falcon\n";
constexpr const char* kDeltaMasses =
    "    masses: [0, 0, 0]             # kg: arm, rod, platform; all 0: the weight is not carried; "
    "if left out, guesses for a Falcon\n";

std::string deltaOf(const DeviceDraft& draft) {
  if (draft.lengths.empty()) return std::string(kNoLengths) + kDeltaMasses;
  return fmt::format("    lengths: {}    # m: a, b, c, d, e, f, r, s\n", listOf(draft.lengths)) + kDeltaMasses;
}

constexpr const char* kPlanar =
    R"(      # Every alpha is 0: all axes are parallel, and the tip stays in a plane. A base that turns about the
      # vertical has alpha 1.5707963 in the first row, and base_orientation below.
)";
constexpr const char* kBelowChain =
    R"(    # base_orientation: [0.7071068, -0.7071068, 0, 0]   # the first axis points up; if left out, toward the user
    # masses: [...]               # kg, one per row; if left out, the weight is not carried
    # centers: [[-0.1, 0, 0], ...] # m, one per row: the link's centre of mass, from its far end, in its frame;
                                  # if left out, each mass is at the far end of its link, so the weight is too large
)";

std::string chainOf(const DeviceDraft& draft) {
  std::string text =
      "    dh:                           # a, alpha, d, theta: "
      "m, rad (standard Denavit-Hartenberg), one row per joint\n";
  for (int i = 0; i < draft.joints; ++i)
    text += fmt::format("      - [{:g}, {:.9g}, 0, 0]\n",
                        draft.lengths.empty() ? 0.2 : DeviceDraft::ofJoint(draft.lengths, i),
                        draft.twists.empty() ? 0 : DeviceDraft::ofJoint(draft.twists, i));
  if (draft.isPlanar()) text += kPlanar;
  return text + kBelowChain;
}

constexpr const char* kArm = R"(  arm:
    kind: {}
{}    # limits: [[-1, 1], ...]      # rad, one row per joint; if left out, those of the mechanism
    max_torque: {}             # N m at the joint: torque of the motor times its turns per turn of the joint
)";

constexpr const char* kMount =
    R"(mount: {position: [0, 0, 0.09]}     # m: where the arm's frame is in the world; here the resting tip is
                                     # 9 cm in front of the origin, where the scenes have their shapes
)";
constexpr const char* kNoMount =
    R"(# mount: {position: [0, 0, 0]}      # m: where the arm's frame is in the world. The shapes of scenes are near
                                     # the origin, so take (0, 0, 0.09) minus the resting tip, as `device kinematics` prints it
)";

}  // namespace

std::string armOf(const DeviceDraft& draft) {
  const std::string links = draft.kind == "phantom" ? phantomOf(draft)
                            : draft.kind == "delta" ? deltaOf(draft)
                                                    : chainOf(draft);
  return fmt::format(kArm, draft.kind, links, listOf(draft.torque));
}

/// Only for a PHANToM is the rest position known here; for other mechanisms it depends on their dimensions.
std::string mountOf(const DeviceDraft& draft) {
  return draft.kind == "phantom" ? kMount : kNoMount;
}

}  // namespace hapticd::device_draft
