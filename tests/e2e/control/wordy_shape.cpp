// SPDX-License-Identifier: MIT
/// A shape with a live parameter of each kind, and some that nothing can change. It may ask for memory in its steps,
/// and refuse to be set up.
#include <memory>
#include <stdexcept>
#include <string>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

struct Wordy : hapticd::Shape {
  int law = 0, whole = 1, allocates = 0, ticks = 0;
  bool loud = false, refuses = false;
  double push = 0;
  std::string file;
  static constexpr const char* kLaws[] = {"linear", "hertz"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.wordy", "wordy", "1.0.0", "MIT", "Has words."};
  static constexpr auto fields() {
    using F = Fields<Wordy>;
    return std::array{F::choice("law", &Wordy::law, kLaws, 0, "Of contact.", HSP_P_LIVE),
                      F::boolean("loud", &Wordy::loud, false, "A switch.", HSP_P_LIVE),
                      F::real("push", &Wordy::push, "N", 0, 3, 0, "A force.", HSP_P_LIVE),
                      F::integer("whole", &Wordy::whole, "", 0, 9, 1, "A whole number.", HSP_P_LIVE),
                      F::real("fixed", &Wordy::push, "N", 0, 3, 0, "Another.", 0),
                      F::path("file", &Wordy::file, "Whatever.", HSP_P_LIVE),
                      F::integer("allocates", &Wordy::allocates, "", 0, 9, 0, "Blocks of memory in each step."),
                      F::boolean("refuses", &Wordy::refuses, false, "To be set up.")};
  }
  void activate(const hsp_activation&, hsp_report&) {
    if (refuses) throw std::invalid_argument("refuses: it was told to");
  }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    for (int i = 0; i < allocates; ++i) {
      const auto block = std::make_unique<volatile char[]>(100);
      block[0] = static_cast<char>(i);
    }
    out.force[1] = push;
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(Wordy)
