// SPDX-License-Identifier: MIT
/// Floors with one slip each, as authors of a first shape make them, for `hapticd plugin check`; and one without.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <mutex>
#include <string>
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
  kOneMember,     ///< two lines of the table name it
  kFourPlaces,    ///< what it keeps for each probe has room for four, however many there are
  kFourShared,    ///< the fifth probe has the place of the first one
  kDepthMm,       ///< depth_m is in mm
  kFootMm,        ///< and so is the foot
  kFlatOutside,   ///< the depth is 0 where the probe is outside
  kLocks,         ///< in contact
  kClicks,        ///< 2 N, 3 mm deep
  kSteepens,      ///< 2 mm deep, to four times what it claims
  kFilters,       ///< a damper whose filter goes on for some ticks: no slip
  kLivePath,      ///< a path that says it can change live
  kCrashesEarly,  ///< in activate()
  kTorqueAtOnce   ///< 0.3 N m from the first touch on
};

template <class Derived, Slip kSlip>
struct Floor : hapticd::Shape {
  double stiffness = 0;
  std::vector<double> heights = {0};
  volatile double kept = 0;  // so that the computing is done
  char* leaked = nullptr;
  double offset = 0;
  std::string file;
  struct Kept {
    double depth = 0, more[3] = {};
  };
  std::vector<Kept> places;  // of the probes
  static constexpr auto fields() {
    using F = hapticd::Fields<Derived>;
    return std::array{
        F::real("stiffness", &Derived::stiffness, kSlip == Slip::kUnit ? "N/mm" : "N/m", 0, 5000, 500, "Spring.",
                kSlip == Slip::kLive ? uint32_t{HSP_P_LIVE} : 0),
        F::real("offset", kSlip == Slip::kOneMember ? &Derived::stiffness : &Derived::offset, "", 0, 600, 500, "None."),
        F::path("file", &Derived::file, "None.", kSlip == Slip::kLivePath ? uint32_t{HSP_P_LIVE} : 0)};
  }
  void activate(const hsp_activation& activation, hsp_report& report) {
    static std::vector<char> kept_over(kSlip == Slip::kSawtoothLate ? 100'000 : 0);
    report.max_stiffness = stiffness;
    if (kSlip == Slip::kCrashesEarly) *reinterpret_cast<volatile double*>(heights.size() - 1) = 1;
    if (kSlip == Slip::kFilters) report.flags |= HSP_R_VELOCITY;
    if (kSlip == Slip::kLeaks) leaked = new char[1000];
    if (kSlip == Slip::kSawtooth || kSlip == Slip::kSawtoothLate)
      kept_over = std::vector<char>(kept_over.empty() ? 100'000 : 0);
    if (kSlip == Slip::kVibrates) hapticd::reportJumps(report, 0.2);
    if (kSlip == Slip::kClaims) report.worst_ns = 1;
    if (kSlip == Slip::kFourPlaces || kSlip == Slip::kFourShared) places.assign(4, {});
    if (kSlip == Slip::kFilters) places.assign(activation.max_probes, {});
  }
  void reset() noexcept HSP_RT { places.assign(places.size(), {}); }

  /// A little of the depth before, or a damper whose filter goes on for some ticks.
  double lag(const hsp_probe& in, const hsp_step& step, double depth) {
    const auto bytes = reinterpret_cast<const char*>(&in) - reinterpret_cast<const char*>(step.in);
    const size_t number = static_cast<size_t>(bytes) / step.in_stride;
    double& own = places.data()[kSlip == Slip::kFourShared ? number % 4 : number].depth;
    if (kSlip == Slip::kFilters) {
      own += 0.05 * (in.velocity[1] - own);
      return -20 * own * std::min(1.0, depth * 1e3);
    }
    const double before = (in.flags & HSP_IN_JUMP) != 0 ? depth : own;
    own = depth;
    return 0.01 * stiffness * (depth - before);
  }

  __attribute__((noinline)) void keepDepth(double depth) {
    if (heights.size() < 100) heights.push_back(depth);
  }

  double push(const hsp_probe& in, double depth) {
    static double shared = 0;
    static std::mutex mutex;
    if (kSlip == Slip::kAllocates) keepDepth(depth);
    if (kSlip == Slip::kPrints) std::printf("depth %f\n", depth);
    if (kSlip == Slip::kAsks) return getppid() > 0 ? stiffness * depth : 0;
    if (kSlip == Slip::kReadsVelocity) return stiffness * depth - 2 * in.velocity[1];
    if (kSlip == Slip::kMillimetres) return stiffness * depth * 1000;
    if (kSlip == Slip::kThrows) return heights.at(100000);
    if (kSlip == Slip::kCrashes) *reinterpret_cast<volatile double*>(heights.size() - 1) = 1;
    if (kSlip == Slip::kNan) return std::sqrt(-depth);
    if (kSlip == Slip::kShares) return stiffness * depth + 1e-3 * std::sin(1e4 * (shared += depth));
    if (kSlip == Slip::kLocks) const std::lock_guard held(mutex);
    if (kSlip == Slip::kClicks && depth > 3.05e-3) return stiffness * depth + 2;
    if (kSlip == Slip::kSteepens) return stiffness * (depth + 3 * std::max(0.0, depth - 2e-3));
    if (kSlip == Slip::kVibrates)
      return stiffness * depth + 0.1 * std::sin(2 * M_PI * 200e-9 * static_cast<double>(in.time_ns));
    return stiffness * depth;
  }

  hsp_status touch(const hsp_probe& in, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    if (kSlip != Slip::kNoInvalid && (in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.normal[1] = kSlip == Slip::kNormalInward ? -1 : 1;
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    if (kSlip == Slip::kFootMm) out.point[0] *= 1000, out.point[2] *= 1000;
    const double depth = out.depth_m;
    if (kSlip == Slip::kDepthMm) out.depth_m *= 1000;
    if (kSlip == Slip::kFlatOutside) out.depth_m = std::max(0.0, depth);
    if (depth <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    if (kSlip == Slip::kComputes)
      for (int i = 0; i < 1'000'000; ++i) kept = kept + std::sqrt(i);
    out.force[1] = out.normal[1] * push(in, depth);
    if (kSlip == Slip::kTorqueAtOnce) out.torque[0] = 0.3;
    if (!places.empty()) out.force[1] += lag(in, step, depth);
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
SHAPE("four_places", FourPlaces, kFourPlaces)
SHAPE("four_shared", FourShared, kFourShared)
SHAPE("depth_mm", DepthMm, kDepthMm)
SHAPE("foot_mm", FootMm, kFootMm)
SHAPE("flat_outside", FlatOutside, kFlatOutside)
SHAPE("locks", Locks, kLocks)
SHAPE("clicks", Clicks, kClicks)
SHAPE("steepens", Steepens, kSteepens)
SHAPE("filters", Filters, kFilters)
SHAPE("live_path", LivePath, kLivePath)
SHAPE("crashes_early", CrashesEarly, kCrashesEarly)
SHAPE("torque_at_once", TorqueAtOnce, kTorqueAtOnce)

}  // namespace

HAPTICD_SHAPES(Right, Prints, Asks, ReadsVelocity, Millimetres, Unit, Throws, Crashes, Nan, NormalInward, Shares,
               NoInvalid, Computes, Leaks, Sawtooth, SawtoothLate, Claims, Allocates, Vibrates, Live, OneMember,
               FourPlaces, FourShared, DepthMm, FootMm, FlatOutside, Locks, Clicks, Steepens, Filters, LivePath,
               CrashesEarly, TorqueAtOnce)
