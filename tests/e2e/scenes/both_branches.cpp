// SPDX-License-Identifier: MIT
/// The simulated hand of soft-branch.yaml feels both fingers and the crotch between them, in virtual time.
/// Usage: both_branches HAPTICD SCENE
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "record/recording.hpp"

namespace {

constexpr double kLeastForce = 0.1;  ///< [N] that a finger tip feels
constexpr int kLeastTicks = 100;
constexpr double kAside = 0.008;  ///< [m] of the middle: beyond, it is a finger

int judge(const std::string& file) {
  const auto recording = hapticd::record::Recording::open(file);
  if (!recording) return std::fprintf(stderr, "%s\n", recording.error().c_str()), 1;
  const auto* contacts = (*recording)->stream("contacts");
  if (contacts == nullptr) return std::fprintf(stderr, "no stream contacts in %s\n", file.c_str()), 1;
  const auto column = [&](const char* name) { return *contacts->find(name); };
  const auto depth = column("depth"), px = column("px"), fx = column("fx"), fy = column("fy"), fz = column("fz");
  int left = 0, right = 0, crotch = 0;
  double jump = 0, before[3] = {0, 0, 0};
  for (uint64_t i = 0; i < contacts->rows(); ++i) {
    const double x = contacts->number(i, px);
    const double f[3] = {contacts->number(i, fx), contacts->number(i, fy), contacts->number(i, fz)};
    jump = std::fmax(jump, std::hypot(f[0] - before[0], f[1] - before[1], f[2] - before[2]));
    for (int k = 0; k < 3; ++k) before[k] = f[k];
    if (!(contacts->number(i, depth) > 0) || std::hypot(f[0], f[1], f[2]) < kLeastForce) continue;
    ++(x < -kAside ? left : x > kAside ? right : crotch);
  }
  std::printf(
      "felt for %d ticks on the left finger, %d on the right, %d between; greatest change of the force in a tick "
      "%.3f N\n",
      left, right, crotch, jump);
  return left >= kLeastTicks && right >= kLeastTicks && crotch > 0 && jump < 0.5 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("branches-" + std::to_string(::getpid()));
  const std::string command = std::string("'") + argv[1] + "' run '" + argv[2] + "' --virtual-time --for 4 --record '" +
                              file.string() + "' >/dev/null";
  const int result = std::system(command.c_str()) == 0 ? judge(file.string()) : 1;
  std::filesystem::remove(file);
  return result;
}
