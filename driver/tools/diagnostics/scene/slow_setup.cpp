// SPDX-License-Identifier: MIT
#include "diagnostics/scene/slow_setup.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace hapticd::diagnostics {

void SlowSetup::look(double seconds) {
  if (seconds < kFirst) next_ = kFirst;
  const uint32_t index = trail_.item();
  if (seconds < next_ || index >= scene_.models.size()) return;
  next_ *= 2;
  const scene::Model& model = scene_.models[index];
  const std::string text = fmt::format(
      "{}: model {}: plugin '{}' has been in its {}() for {:.0f} s; it is ended after {:g} s (--setup-limit)",
      scene_.file.string(), model.name, model.plugin, trail_.call(), seconds, limit_);
  std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace hapticd::diagnostics
