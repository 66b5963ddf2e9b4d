// SPDX-License-Identifier: MIT
/// A host built against one minor version of the headers steps plugins built against each: all must answer alike.
/// This file is compiled once for each version.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "shape.h"

namespace {

constexpr uint32_t kProbes = 3;
const double kPositions[kProbes][3] = {{0.04, 0, 0}, {0.01, -0.02, 0.03}, {0.1, 0.2, 0.3}};

struct Answer {
  double force[3], normal[3], depth;
};

/// A plugin loaded for one test.
class Plugin {
 public:
  explicit Plugin(const char* file) : handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ != nullptr) entry_ = static_cast<const hsp_entry*>(dlsym(handle_, "hsp_plugin_entry"));
  }
  ~Plugin() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  Plugin(const Plugin&) = delete;
  Plugin& operator=(const Plugin&) = delete;
  const hsp_entry* entry() const { return entry_; }

 private:
  void* handle_;
  const hsp_entry* entry_ = nullptr;
};

std::vector<Answer> stepOnce(const hsp_class& shape_class) {
  hsp_host host{};
  host.struct_size = sizeof host;
  hsp_shape* shape = shape_class.create(&shape_class, &host);
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  activation.max_probes = kProbes;
  activation.rate_hz = 1000;
  hsp_report report{};
  report.struct_size = sizeof report;
  EXPECT_EQ(shape_class.activate(shape, &activation, &report), HSP_OK);
  EXPECT_DOUBLE_EQ(report.max_stiffness, 500);

  hsp_probe in[kProbes]{};
  hsp_contact out[kProbes]{};
  for (uint32_t i = 0; i < kProbes; ++i) std::memcpy(in[i].position, kPositions[i], sizeof kPositions[i]);
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = kProbes;
  step.in = in;
  step.out = out;
  step.in_stride = sizeof in[0];
  step.out_stride = sizeof out[0];
  step.dt_s = 1e-3;
  EXPECT_EQ(shape_class.step(shape, &step), HSP_OK);
  shape_class.deactivate(shape);
  shape_class.destroy(shape);

  std::vector<Answer> answers(kProbes);
  for (uint32_t i = 0; i < kProbes; ++i) {
    std::memcpy(answers[i].force, out[i].force, sizeof out[i].force);
    std::memcpy(answers[i].normal, out[i].normal, sizeof out[i].normal);
    answers[i].depth = out[i].depth_m;
  }
  return answers;
}

class HostOfThisVersion : public testing::TestWithParam<const char*> {};

TEST_P(HostOfThisVersion, StepsAPluginOfAnotherVersion) {
  const Plugin plugin(GetParam());
  ASSERT_NE(plugin.entry(), nullptr) << dlerror();
  ASSERT_EQ(plugin.entry()->abi_major, HSP_ABI_MAJOR);
  const std::vector<Answer> answers = stepOnce(*plugin.entry()->classes[0]);
  for (uint32_t i = 0; i < kProbes; ++i) {
    const double* p = kPositions[i];
    const double distance = std::hypot(p[0], p[1], p[2]), depth = 0.05 - distance;
    EXPECT_NEAR(answers[i].depth, depth, 1e-15);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(answers[i].normal[k], p[k] / distance, 1e-15);
      EXPECT_NEAR(answers[i].force[k], depth > 0 ? 500 * depth * p[k] / distance : 0, 1e-12);
    }
  }
}

TEST_P(HostOfThisVersion, WalksTheParameterTableWithItsWritersStride) {
  const Plugin plugin(GetParam());
  ASSERT_NE(plugin.entry(), nullptr);
  const hsp_class& shape_class = *plugin.entry()->classes[0];
  ASSERT_EQ(shape_class.param_count, 2u);
  const uint32_t stride = shape_class.params[0].struct_size;
  EXPECT_STREQ(HSP_AT(const hsp_param, shape_class.params, stride, 0)->id, "radius");
  EXPECT_STREQ(HSP_AT(const hsp_param, shape_class.params, stride, 1)->id, "stiffness");
}

INSTANTIATE_TEST_SUITE_P(Plugins, HostOfThisVersion, testing::Values(PLUGIN_SMALL, PLUGIN_SAME, PLUGIN_LARGE));

}  // namespace
