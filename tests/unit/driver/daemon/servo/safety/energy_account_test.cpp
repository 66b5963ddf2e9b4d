// SPDX-License-Identifier: MIT
#include "servo/safety/energy_account.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;

/// One probe on one surface.
struct Book {
  EnergyAccount account;
  bool step(double x, double force, double depth) {
    return account.step({{force, 0, 0}, {x, 0, 0}, depth, true}, kTick);
  }
};

TEST(EnergyAccount, ASpringGivesNothingHoweverFastAHandSaws) {
  for (const double rate : {1.0, 8.0, 20.0}) {
    Book book;
    for (int i = 0; i < 5000; ++i) {
      const double x = 0.02 * std::cos(2 * M_PI * rate * kTick * i), depth = std::max(0.0, -x);
      ASSERT_FALSE(book.step(x, 8000 * depth, -x)) << rate;
      ASSERT_LT(book.account.given(), 0.05) << rate;
    }
  }
}

/// It pushes with 8 N on the way out, and with 2 N on the way in.
TEST(EnergyAccount, ASurfaceThatPushesMoreOnTheWayOutIsFoundOut) {
  Book book;
  double given = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool out = i / 50 % 2 == 1;
    const double x = 1e-3 * (i % 50) * (out ? 1 : -1) - (out ? 0.05 : 0);
    if (i > 50) given += 1e-3 * (out ? 8 : -2);
    if (book.step(x, out ? 8 : 2, 1e-3)) {
      EXPECT_LT(given, 2 * EnergyAccount::kMostGiven);
      return;
    }
  }
  FAIL();
}

TEST(EnergyAccount, WhatFrictionTookIsNotGivenBack) {
  Book book;
  double x = 0;
  for (int i = 0; i < 1000; ++i) book.step(x += 1e-3, -8, 1e-3);
  EXPECT_GE(book.account.given(), -8e-3 - 1e-9) << "8 J of friction";
  bool found = false;
  for (int i = 0; i < 50 && !found; ++i) found = book.step(x += 1e-3, 8, 1e-3);
  EXPECT_TRUE(found);
}

/// Friction that sticks: 100 N/m, stretched by 0.1 m, in a wall that is 1 mm deep. It may give back what it took, once.
TEST(EnergyAccount, WhatAShapeReportsToStoreMayComeBackAndNoMore) {
  EnergyAccount account;
  const auto step = [&](double x, double pull) {
    return account.step({{-pull, 0, 0}, {x, 0, 0}, 1e-3, true}, kTick, 0.5 * 100 * x * x);
  };
  for (int i = 0; i <= 100; ++i) ASSERT_FALSE(step(1e-3 * i, 0.1 * i));
  for (int i = 100; i >= 0; --i) ASSERT_FALSE(step(1e-3 * i, 0.1 * i));
  EXPECT_NEAR(account.given(), 0, 1e-3);
  bool found = false;
  for (int i = 0; i <= 100 && !found; ++i) found = step(1e-3 * i, -0.1 * i);
  EXPECT_TRUE(found);
}

/// It may report the energy, or a depth of a thousand metres.
TEST(EnergyAccount, AShapeThatPretendsToStoreAThousandJoulesGivesBackNoMoreThanAnArmPutsIn) {
  for (const auto& [depth, reported] : {std::pair(1e-3, 1000.0), std::pair(1000.0, 0.0)}) {
    EnergyAccount account;
    double x = 0, given = 0;
    const auto step = [&](double push) {
      return account.step({{push, 0, 0}, {x += 1e-3, 0, 0}, depth, true}, kTick, reported, 8);
    };
    for (int i = 0; i < 5000; ++i) ASSERT_FALSE(step(-8));  // 40 J
    while (given < 30 && !step(8)) given += 8e-3;
    EXPECT_LT(given, 8 * EnergyAccount::kDistance + 2 * EnergyAccount::kMostGiven) << depth;
  }
}

/// A lost sample is no credit without bound, either.
TEST(EnergyAccount, AWrongDepthAfterALostSampleHidesNoMoreThanAnArmPutsIn) {
  EnergyAccount account;
  account.forgetPush();
  double x = 0, given = 0;
  while (given < 30 && !account.step({{8, 0, 0}, {x += 1e-3, 0, 0}, 1000, true}, kTick, 0, 8)) given += 8e-3;
  EXPECT_LT(given, 8 * EnergyAccount::kDistance + 2 * EnergyAccount::kMostGiven);
}

/// Nor are many: an arm that loses a sample now and then must not hide for ever what goes along with the hand.
TEST(EnergyAccount, LostSamplesAgainAndAgainHideNoMoreThanTheWayThatNobodySaw) {
  for (const bool surface : {true, false}) {
    EnergyAccount account;
    double x = 0, given = 0;
    bool found = false;
    for (int i = 0; i < 20'000 && !found; ++i) {
      const int way = i / 60 % 2 == 0 ? 1 : -1;
      if (i % 100 == 0) account.forgetPush();
      found = account.step({{8.0 * way, 0, 0}, {x += 1e-3 * way, 0, 0}, 1000, surface}, kTick, 0, 8);
      given += 8e-3;
    }
    EXPECT_TRUE(found) << surface;
    EXPECT_LT(given, 3 * 8 * EnergyAccount::kDistance) << surface;
  }
}

TEST(EnergyAccount, AProbeThatJumpedInsideMayBePushedOut) {
  Book book;
  for (int turn = 0; turn < 20; ++turn) {
    book.account.forgetPush();
    for (int i = 50; i >= 0; --i) ASSERT_FALSE(book.step(-1e-3 * i, 160e-3 * i, 1e-3 * i)) << turn;
  }
}

/// As after a late tick, or if the path of the model jumps.
TEST(EnergyAccount, AProbeThatIsFarAwayAtOnceGotWhatWasStored) {
  Book book;
  for (int i = 0; i <= 10; ++i) ASSERT_FALSE(book.step(-1e-3 * i, 2 * i, 1e-3 * i));
  EXPECT_FALSE(book.step(0.06, 0, -0.06));
  EXPECT_NEAR(book.account.given(), 0, 1e-3);
}

TEST(EnergyAccount, APushThatRestsEachOtherTickIsFoundOut) {
  Book book;
  bool found = false;
  for (int i = 0; i < 1000 && !found; ++i) found = book.step(1e-3 * i, i % 2 == 0 ? 8 : 0, 1e-4);
  EXPECT_TRUE(found);
}

TEST(EnergyAccount, ALittlePowerIsAllowedForever) {
  Book book;
  double x = 0;
  for (int i = 0; i < 100000; ++i) ASSERT_FALSE(book.step(x += 0.9 * EnergyAccount::kMostPower * kTick, 1, 0));
}

/// One probe in a field, or in another thing that has no hard surface.
struct FieldBook {
  EnergyAccount account;
  static constexpr double kForce = 8;  // [N] that the arm lets through
  bool step(double x, double force) { return account.step({{force, 0, 0}, {x, 0, 0}, 0, false}, kTick, 0, kForce); }
};

TEST(EnergyAccount, AMagnetDrawsTheHandAcrossTheRoomOfTheArmAsOftenAsItLikes) {
  FieldBook book;
  for (int turn = 0; turn < 20; ++turn) {
    for (int i = 0; i <= 450; ++i) ASSERT_FALSE(book.step(1e-3 * i, 8)) << turn;
    for (int i = 450; i >= 0; --i) ASSERT_FALSE(book.step(1e-3 * i, 8)) << turn;
  }
}

TEST(EnergyAccount, AForceMayLeadAHandSlowlyForEver) {
  FieldBook book;
  for (int i = 0; i < 100'000; ++i) ASSERT_FALSE(book.step(0.9 * EnergyAccount::kSpeed * kTick * i, 8));
}

/// It pushes along with a hand that saws to and fro at 1 m/s.
TEST(EnergyAccount, AForceThatGoesAlongWithTheHandIsFoundOut) {
  FieldBook book;
  double x = 0, given = 0;
  bool found = false;
  for (int i = 0; i < 3000 && !found; ++i) {
    const int way = i / 60 % 2 == 0 ? 1 : -1;
    given += 8e-3;
    found = book.step(x += 1e-3 * way, 8 * way);
  }
  EXPECT_TRUE(found);
  EXPECT_LT(given, 1.5 * FieldBook::kForce * EnergyAccount::kDistance);
}

/// It rests in each other tick, so it gives half as much.
TEST(EnergyAccount, AForceThatGoesAlongWithTheHandInEachOtherTickIsFoundOut) {
  FieldBook book;
  double x = 0, given = 0;
  bool found = false;
  for (int i = 0; i < 6000 && !found; ++i) {
    const int way = i / 60 % 2 == 0 ? 1 : -1;
    given += i % 2 == 0 ? 8e-3 : 0;
    found = book.step(x += 1e-3 * way, i % 2 == 0 ? 8 * way : 0);
  }
  EXPECT_TRUE(found);
  EXPECT_LT(given, 2 * FieldBook::kForce * EnergyAccount::kDistance);
}

/// A program that sets a parameter in each tick may make a surface give as much, and no more.
TEST(EnergyAccount, ASurfaceThatAProgramSetsInEachTickIsJudgedAsAField) {
  EnergyAccount account;
  double x = 0;
  bool found = false;
  for (int i = 0; i < 3000 && !found; ++i) {
    const int way = i / 60 % 2 == 0 ? 1 : -1;
    account.noteChange();
    found = account.step({{8.0 * way, 0, 0}, {x += 1e-3 * way, 0, 0}, 1e-3, true}, kTick, 0, 8);
    EXPECT_LE(account.given(), 0);
  }
  EXPECT_TRUE(found);
}

TEST(EnergyAccount, NumbersThatOverflowAreForgotten) {
  Book book;
  EXPECT_FALSE(book.step(0, 1e200, 1e200));
  EXPECT_FALSE(book.step(1e200, 1e200, 1e200));
  EXPECT_TRUE(std::isfinite(book.account.given()));
}

}  // namespace
}  // namespace hapticd::servo
