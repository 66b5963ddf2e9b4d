// SPDX-License-Identifier: MIT
/// The state of a contact where the kernel's feet are not certain.
#include "kernels/contact/contact_state.hpp"

#include <gtest/gtest.h>

namespace hapticd::contact {
namespace {

using Eigen::Vector3d;

/// A shell whose nearest foot is what a test says. It is never entered, and tells from where that was asked.
struct SaidFeet {
  Foot said;
  Vector3d asked_from{0, 0, 0};

  Followed follow(double, Foot&) noexcept { return Followed::kLost; }
  Foot nearest() noexcept { return said; }
  bool enter(const PathStart& from, Sides, double&) noexcept {
    asked_from = from.point;
    return false;
  }
  void holdNearest() noexcept {}
  void release() noexcept {}
};

/// A probe over the front of a shell in the plane y = 0.
struct Probe {
  ContactState state;
  SaidFeet feet;
  Vector3d last{0, 0, 0};

  Foot at(double y, double height_said, FootStatus status) {
    const Vector3d p(0, y, 0);
    feet.said = {};
    feet.said.normal = Vector3d::UnitY();
    feet.said.point = p - height_said * Vector3d::UnitY();
    feet.said.distance = std::abs(height_said);
    feet.said.behind = -height_said;
    feet.said.status = status;
    const Foot foot = state.step(feet, last, p, {Sides::kBoth});
    last = p;
    return foot;
  }
};

TEST(ContactState, AFootThatIsNotCertainDoesNotSayThatAShellWasNotCrossed) {
  Probe probe;
  probe.at(1e-4, 1e-4, FootStatus::kNearest);
  probe.at(-1e-4, 1.5e-4, FootStatus::kDegraded);  // the probe is behind, but its foot is one of another place
  EXPECT_EQ(probe.state.side(), 1);
  probe.at(-2e-4, -2e-4, FootStatus::kNearest);
  EXPECT_EQ(probe.feet.asked_from.y(), 1e-4) << "the path begins where the probe was surely in front";
}

TEST(ContactState, AFootThatIsNotCertainButFarBeginsAPath) {
  Probe probe;
  probe.at(1e-2, 1e-2, FootStatus::kNearest);
  probe.at(9e-3, 9e-3, FootStatus::kDegraded);
  probe.at(8.9e-3, 8.9e-3, FootStatus::kNearest);
  EXPECT_EQ(probe.feet.asked_from.y(), 9e-3);
}

}  // namespace
}  // namespace hapticd::contact
