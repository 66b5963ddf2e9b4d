// SPDX-License-Identifier: MIT
/// Floors with one slip each, as authors of a first shape make them, for `hapticd plugin check`; and one without.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

enum class Slip {
  kNone,
  kPrints,
  kAsks,           ///< another system call
  kReadsVelocity,  ///< without HSP_R_VELOCITY
  kMillimetres,    ///< the depth of the force is in mm
  kUnit,           ///< a unit that is not SI
  kThrows,
  kCrashes,
  kNan,
  kNormalInward,  ///< and the force with it
  kShares,        ///< a static variable
  kNoInvalid,     ///< HSP_IN_INVALID is not looked at
  kComputes,      ///< 3 ms of computing
  kLeaks,         ///< 1000 bytes in each life
  kSawtooth,      ///< keeps 100 kB, and gives them back in its next life
  kSawtoothLate,  ///< the same, a life later
  kClaims,        ///< to be quicker than any processor
  kAllocates,     ///< in contact
  kVibrates,      ///< on purpose, and says so: no slip
  kLive,          ///< a stiffness that changes without consent
  kOneMember      ///< two lines of the table name it
};

template <class Derived, Slip kSlip>
struct Floor : hapticd::Shape {
  double stiffness = 0;
  std::vector<double> heights = {0};
  volatile double kept = 0;  // so that the computing is done
  char* leaked = nullptr;
  double offset = 0;
  static constexpr auto fields() {
    using F = hapticd::Fields<Derived>;
    return std::array{F::real("stiffness", &Derived::stiffness, kSlip == Slip::kUnit ? "N/mm" : "N/m", 0, 5000, 500,
                              "Spring.", kSlip == Slip::kLive ? uint32_t{HSP_P_LIVE} : 0),
                      F::real("offset", kSlip == Slip::kOneMember ? &Derived::stiffness : &Derived::offset, "", 0, 600,
                              500, "None.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    static std::vector<char> kept_over(kSlip == Slip::kSawtoothLate ? 100'000 : 0);
    report.max_stiffness = stiffness;
    if (kSlip == Slip::kLeaks) leaked = new char[1000];
    if (kSlip == Slip::kSawtooth || kSlip == Slip::kSawtoothLate)
      kept_over = std::vector<char>(kept_over.empty() ? 100'000 : 0);
    if (kSlip == Slip::kVibrates) hapticd::reportJumps(report, 0.2);
    if (kSlip == Slip::kClaims) report.worst_ns = 1;
  }

  __attribute__((noinline)) void keepDepth(double depth) {
    if (heights.size() < 100) heights.push_back(depth);
  }

  double push(const hsp_probe& in, double depth) {
    static double shared = 0;
    if (kSlip == Slip::kAllocates) keepDepth(depth);
    if (kSlip == Slip::kPrints) std::printf("depth %f\n", depth);
    if (kSlip == Slip::kAsks) return getppid() > 0 ? stiffness * depth : 0;
    if (kSlip == Slip::kReadsVelocity) return stiffness * depth - 2 * in.velocity[1];
    if (kSlip == Slip::kMillimetres) return stiffness * depth * 1000;
    if (kSlip == Slip::kThrows) return heights.at(100000);
    if (kSlip == Slip::kCrashes) *reinterpret_cast<volatile double*>(heights.size() - 1) = 1;
    if (kSlip == Slip::kNan) return std::sqrt(-depth);
    if (kSlip == Slip::kShares) return stiffness * depth + 1e-3 * std::sin(1e4 * (shared += depth));
    if (kSlip == Slip::kVibrates)
      return stiffness * depth + 0.1 * std::sin(2 * M_PI * 200e-9 * static_cast<double>(in.time_ns));
    return stiffness * depth;
  }

  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if (kSlip != Slip::kNoInvalid && (in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.normal[1] = kSlip == Slip::kNormalInward ? -1 : 1;
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    if (out.depth_m <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    if (kSlip == Slip::kComputes)
      for (int i = 0; i < 1'000'000; ++i) kept = kept + std::sqrt(i);
    out.force[1] = out.normal[1] * push(in, out.depth_m);
    return HSP_OK;
  }
};

#define SHAPE(NAME, TYPE, SLIP)                                                                                  \
  struct TYPE : Floor<TYPE, Slip::SLIP> {                                                                        \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." NAME, NAME, "1.0.0", "MIT", "To be tested."}; \
  };

SHAPE("right", Right, kNone)
SHAPE("prints", Prints, kPrints)
SHAPE("asks", Asks, kAsks)
SHAPE("reads_velocity", ReadsVelocity, kReadsVelocity)
SHAPE("millimetres", Millimetres, kMillimetres)
SHAPE("unit", Unit, kUnit)
SHAPE("throws", Throws, kThrows)
SHAPE("crashes", Crashes, kCrashes)
SHAPE("nan", Nan, kNan)
SHAPE("normal_inward", NormalInward, kNormalInward)
SHAPE("shares", Shares, kShares)
SHAPE("no_invalid", NoInvalid, kNoInvalid)
SHAPE("computes", Computes, kComputes)
SHAPE("leaks", Leaks, kLeaks)
SHAPE("sawtooth", Sawtooth, kSawtooth)
SHAPE("sawtooth_late", SawtoothLate, kSawtoothLate)
SHAPE("claims", Claims, kClaims)
SHAPE("allocates", Allocates, kAllocates)
SHAPE("vibrates", Vibrates, kVibrates)
SHAPE("live", Live, kLive)
SHAPE("one_member", OneMember, kOneMember)

}  // namespace

HAPTICD_SHAPES(Right, Prints, Asks, ReadsVelocity, Millimetres, Unit, Throws, Crashes, Nan, NormalInward, Shares,
               NoInvalid, Computes, Leaks, Sawtooth, SawtoothLate, Claims, Allocates, Vibrates, Live, OneMember)
