// SPDX-License-Identifier: MIT
/// Figures of the soft bodies: tables of text, and how times are taken.
#pragma once
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace hapticd::bench_mat {

/// The paper's table of six scenes, and more bodies than it had. Markdown.
std::string gardenTable();
/// Ticks of its last scene, 35 bodies: one is touched, or all have been and still move. Prints the median time; what it
/// costs whatever else the machine does is counted by tests/bench/mat/instructions.
void strokeGarden(const char* dynamics, bool awake, int ticks);
/// Searches on ten skeletons against brute force. Markdown.
std::string skeletonTable();
/// Accuracy against speed, a table a knob. Markdown.
std::string knobTables();
/// Medial meshes: a cone, a slab, bodies of up to 10,000 slabs. Markdown.
std::string meshTables();
/// Volume with and without keeping it. Markdown.
std::string volumeTable();

/// Felt surfaces: moduli beside the continuous tissue, and the stiffest that an arm bears. Markdown.
std::string feltTables();

/// Median time [s] of `batches` batches of calls `work(i)`, per call.
template <class Work>
double medianTime(int batches, int calls, Work&& work) {
  std::vector<double> times;
  int count = 0;
  for (int b = 0; b < batches; ++b) {
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) work(count++);
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / calls);
  }
  std::nth_element(times.begin(), times.begin() + batches / 2, times.end());
  return times[static_cast<std::size_t>(batches / 2)];
}

/// Least time [s] of `batches` batches of calls `work(i)`, per call: for work so short that any disturbance shows.
template <class Work>
double leastTime(int batches, int calls, Work&& work) {
  double least = 1e300;
  for (int b = 0; b < batches; ++b) least = std::min(least, medianTime(1, calls, work));
  return least;
}

}  // namespace hapticd::bench_mat
