/// bench_mat: what soft bodies cost and how exact they are. Prints the tables; with --write, writes
/// driver/docs/bench_mat.md.
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <fstream>

#include "bench.hpp"

namespace {

constexpr const char* kHead =
    "# What soft bodies cost\n\nMade by `bench_mat --write` (configure with -DHAPTICD_BENCH=ON). One core of a shared "
    "virtual "
    "machine.\n\n";

}  // namespace

int main(int argc, char** argv) {
  try {
    std::string text = kHead;
    for (const auto part :
         {hapticd::bench_mat::knobTables, hapticd::bench_mat::gardenTable, hapticd::bench_mat::skeletonTable}) {
      const std::string made = part();
      fmt::print("{}", made);
      std::fflush(stdout);
      text += made;
    }
    if (argc > 1 && std::strcmp(argv[1], "--write") == 0)
      std::ofstream(HAPTICD_SOURCE_DIR "/driver/docs/bench_mat.md") << text;
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
