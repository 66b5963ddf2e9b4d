// SPDX-License-Identifier: MIT
/// bench_mat: measures the time and the accuracy of soft bodies. It prints all tables, or those that are named (knobs,
/// scenes, meshes, felt, volume, searches). With --write it writes driver/docs/reports/bench_mat.md. `bench_mat ticks
/// seen|felt|off one|awake COUNT` runs ticks of 35 bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <utility>

#include "bench.hpp"

namespace {

constexpr const char* kHead =
    "# What soft bodies cost\n\nMade by `bench_mat --write` (configure with -DHAPTICD_BENCH=ON). One core of a shared "
    "virtual machine.\n\n";

}  // namespace

int main(int argc, char** argv) {
  using Part = std::pair<const char*, std::string (*)()>;
  constexpr Part kParts[] = {
      {"knobs", hapticd::bench_mat::knobTables},   {"scenes", hapticd::bench_mat::gardenTable},
      {"meshes", hapticd::bench_mat::meshTables},  {"felt", hapticd::bench_mat::feltTables},
      {"volume", hapticd::bench_mat::volumeTable}, {"searches", hapticd::bench_mat::skeletonTable}};
  if (argc == 5 && std::strcmp(argv[1], "ticks") == 0) {
    hapticd::bench_mat::strokeGarden(argv[2], std::strcmp(argv[3], "awake") == 0, std::atoi(argv[4]));
    return 0;
  }
  const bool write = argc == 2 && std::strcmp(argv[1], "--write") == 0;
  try {
    std::string text = kHead;
    for (const auto& [name, make] : kParts) {
      const bool wanted = argc < 2 || write || std::find(argv + 1, argv + argc, std::string(name)) != argv + argc;
      if (!wanted) continue;
      std::string made = make();
      // placed after the title
      made.insert(made.find("\n\n") + 2, fmt::format("`bench_mat {}` makes this part.\n\n", name));
      fmt::print("{}", made);
      std::fflush(stdout);
      text += made;
    }
    if (write) std::ofstream(HAPTICD_SOURCE_DIR "/driver/docs/reports/bench_mat.md") << text;
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
