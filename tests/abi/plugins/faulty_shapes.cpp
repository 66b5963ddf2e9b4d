// SPDX-License-Identifier: MIT
/// Shapes that fail while they are set up.
#include <cmath>
#include <stdexcept>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

template <class T>
struct Faulty : hapticd::Shape {
  int unused = 0;
  static constexpr auto fields() {
    return std::array{Fields<T>::integer("unused", &T::unused, "", 0, 1, 0, "Nothing.")};
  }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};

struct NoActivation : Faulty<NoActivation> {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.no_activation", "no_activation", "1.0.0", "MIT",
                                            "Fails."};
  void activate(const hsp_activation&, hsp_report&) { throw std::runtime_error("the coffee is cold"); }
};

struct NoInstance : Faulty<NoInstance> {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.no_instance", "no_instance", "1.0.0", "MIT", "Fails."};
  NoInstance() { throw std::bad_alloc(); }
  void activate(const hsp_activation&, hsp_report&) {}
};

struct NanClaim : Faulty<NanClaim> {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.nan_claim", "nan_claim", "1.0.0", "MIT", "Fails."};
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = std::nan(""); }
};

}  // namespace

HAPTICD_SHAPES(NoActivation, NoInstance, NanClaim)
