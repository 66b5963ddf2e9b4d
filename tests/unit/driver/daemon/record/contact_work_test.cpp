// SPDX-License-Identifier: MIT
/// The work that a model does on a hand, and the work that the hand does on it.
#include "record/contact_work.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::record {
namespace {

/// A spring of 500 N/m, pressed 5 mm deep and let go; `gain`: of its force on the way out.
ContactWork pressed(double gain) {
  ContactWork work;
  for (uint64_t tick = 0; tick <= 400; ++tick) {
    const double depth = .005 * std::sin(M_PI * static_cast<double>(tick) / 400);
    work.add(tick, 1e-3, {0, 500 * depth * (tick > 200 ? gain : 1), 0}, {0, -depth, 0}, depth);
  }
  return work;
}

TEST(ContactWork, OfASpringIsNothingAndOfOneThatGivesMoreWhatItGives) {
  constexpr double kStored = 0.5 * 500 * .005 * .005;
  const ContactWork spring = pressed(1), drives = pressed(1.8);
  EXPECT_NEAR(spring.taken(), kStored, 1e-9);
  EXPECT_NEAR(spring.given(), kStored, 1e-9);
  EXPECT_NEAR(drives.given(), 1.8 * kStored, 1e-4 * kStored);
  ContactWork gap;
  gap.add(0, 0, {1, 0, 0}, {0, 0, 0}, 0.01);
  gap.add(7, 1e-3, {1, 0, 0}, {1, 0, 0}, 0.01);  // the model was out of reach meanwhile
  EXPECT_EQ(gap.given() + gap.taken(), 0);
}

/// A hand that strokes a ball goes along an arc while the process is stopped. Nobody knows how it pressed there.
TEST(ContactWork, OfATimeThatNobodySawIsNotCounted) {
  ContactWork stopped;
  stopped.add(0, 0, {0, 0, 1}, {0, 0, 0.05}, 0.001);
  stopped.add(1, 0.5, {1.4, 0, 0}, {0.05, 0, 0}, 0.002);
  EXPECT_EQ(stopped.given(), 0);
  EXPECT_EQ(stopped.taken(), 0);
  stopped.add(2, 1e-3, {1.4, 0, 0}, {0.051, 0, 0}, 0.001);
  EXPECT_NEAR(stopped.given(), 1.4e-3, 1e-9) << "and the ticks after it are";
}

TEST(ContactWork, OfASlowServoIsCounted) {
  ContactWork slow(0.1);
  slow.add(0, 0, {0, 0, 1}, {0, 0, 0}, 0.001);
  slow.add(1, 0.11, {0, 0, 1}, {0, 0, 0.002}, 0.001);
  EXPECT_NEAR(slow.given(), 2e-3, 1e-9);
  slow.add(2, 0.3, {0, 0, 1}, {0, 0, 0.004}, 0.001);
  EXPECT_NEAR(slow.given(), 2e-3, 1e-9) << "but no time in which it stood";
}

TEST(ContactWork, OfAHandThatBeginsInsideIsNoMoreThanWasStoredThere) {
  ContactWork work;  // 500 N/m, 5 mm deep: 6.25 mJ
  for (uint64_t tick = 0; tick <= 200; ++tick) {
    const double depth = .005 * std::cos(M_PI * static_cast<double>(tick) / 400);
    work.add(tick, 1e-3, {0, 500 * depth, 0}, {0, -depth, 0}, depth);
  }
  EXPECT_NEAR(work.given(), 0.5 * 500 * .005 * .005, 1e-9);
  EXPECT_EQ(work.taken(), 0);
  EXPECT_GE(work.began(), work.given());
  EXPECT_LE(work.began(), 2.01 * work.given());
  EXPECT_EQ(pressed(1.8).began(), 0) << "it came from outside";
}

}  // namespace
}  // namespace hapticd::record
