// SPDX-License-Identifier: MIT
#include "host/kinematics_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hapticd::host {
namespace {

enum Slip { kNone, kRowNegated, kDoubled, kTransposed, kNotANumber, kTurnsBackwards };
Slip slip = kNone;
bool refuses = false;

/// Two turning joints and a slide: the tip is at r = 0.3 m + slide from the second joint, 0.2 m above the first.
hsp_status forward(const hdv_device*, const double* q, double position[3], double orientation[4]) noexcept HSP_RT {
  if (refuses) return HSP_E_NUMERIC;
  const double r = 0.3 + q[2];
  position[0] = r * std::cos(q[0]) * std::cos(q[1]);
  position[1] = r * std::sin(q[0]) * std::cos(q[1]);
  position[2] = 0.2 + r * std::sin(q[1]);
  orientation[0] = std::cos(q[0] / 2);
  orientation[1] = orientation[2] = 0;
  orientation[3] = std::sin(q[0] / 2);
  return HSP_OK;
}

hsp_status jacobian(const hdv_device*, const double* q, double* J) noexcept HSP_RT {
  const double r = 0.3 + q[2], c0 = std::cos(q[0]), s0 = std::sin(q[0]), c1 = std::cos(q[1]), s1 = std::sin(q[1]);
  const double right[18] = {-r * s0 * c1,
                            -r * c0 * s1,
                            c0 * c1,
                            r * c0 * c1,
                            -r * s0 * s1,
                            s0 * c1,
                            0,
                            r * c1,
                            s1,
                            0,
                            0,
                            0,
                            0,
                            0,
                            0,
                            1,
                            0,
                            0};
  for (int row = 0; row < 6; ++row)
    for (int j = 0; j < 3; ++j) {
      double value = right[row * 3 + j];
      if (slip == kRowNegated && row == 2) value = -value;
      if (slip == kDoubled && row < 3) value *= 2;
      if (slip == kTransposed && row < 3) value = right[j * 3 + row];
      if (slip == kTurnsBackwards && row > 2) value = -value;
      J[row * 3 + j] = value;
    }
  if (slip == kNotANumber) J[4] = std::numeric_limits<double>::quiet_NaN();
  return HSP_OK;
}

std::string wrong(Slip how) {
  slip = how;
  const hdv_ext_kinematics kinematics{sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, nullptr, nullptr};
  return wrongJacobian(kinematics, nullptr);
}

TEST(WrongJacobian, PassesADerivative) {
  EXPECT_EQ(wrong(kNone), "");
}

TEST(WrongJacobian, NamesEverySlipThatTurnsOrScalesAForce) {
  for (const Slip how : {kRowNegated, kDoubled, kTransposed, kNotANumber})
    EXPECT_NE(wrong(how).find("moves the tip by ("), std::string::npos) << how << wrong(how);
  EXPECT_NE(wrong(kTurnsBackwards).find("joint 1 turns the tip by (0, 0, 1) rad"), std::string::npos)
      << wrong(kTurnsBackwards);
}

TEST(WrongJacobian, JudgesNothingWhereForwardRefuses) {
  refuses = true;
  EXPECT_EQ(wrong(kDoubled), "");
  refuses = false;
}

hsp_status weightless(const hdv_device*, const double*, const double*, double* torque) noexcept HSP_RT {
  for (int i = 0; i < 3; ++i) torque[i] = 0;
  return HSP_OK;
}

TEST(WrongBetweenStops, TakesStopsThatNoArmReachesForNone) {
  slip = kNone;
  const hdv_ext_kinematics kinematics{sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &weightless, nullptr};
  hdv_info info{};
  info.joint_count = 3;
  for (int i = 0; i < 3; ++i) info.position_min[i] = -1e300, info.position_max[i] = 1e300;
  EXPECT_EQ(wrongBetweenStops(kinematics, nullptr, info), "");
}

hsp_status gantry(const hdv_device*, const double* q, double position[3], double orientation[4]) noexcept HSP_RT {
  for (int i = 0; i < 3; ++i) position[i] = q[i];
  orientation[0] = 1, orientation[1] = orientation[2] = orientation[3] = 0;
  return HSP_OK;
}

hsp_status inverseWithin15cm(const hdv_device*, const double position[3], double* q) noexcept HSP_RT {
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(position[i]) <= 0.15)) return HSP_E_NUMERIC;
  for (int i = 0; i < 3; ++i) q[i] = refuses ? -position[i] : position[i];
  return HSP_OK;
}

TEST(WrongInverse, JudgesAnArmThatReachesLessThanAMetreWhereItReaches) {
  const hdv_ext_kinematics small{sizeof(hdv_ext_kinematics), 3, &gantry, &jacobian, nullptr, &inverseWithin15cm};
  EXPECT_EQ(wrongInverse(small, nullptr), "");
  refuses = true;
  EXPECT_NE(wrongInverse(small, nullptr), "");
  refuses = false;
}

}  // namespace
}  // namespace hapticd::host
