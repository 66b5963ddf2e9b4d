// SPDX-License-Identifier: MIT
/// The tables of bench_mat, as Markdown text, and functions that measure times.
#pragma once
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace hapticd::bench_mat {

/// Returns the table of the paper's six scenes, and of a scene with more bodies than the paper had.
std::string gardenTable();
/// Runs ticks of the paper's last scene, with 35 bodies, and prints the median time. The probe strokes one body; if
/// `awake`, all bodies were poked before and still move. tests/bench/mat/instructions counts the instructions, which do
/// not depend on the load of the machine.
void strokeGarden(const char* dynamics, bool awake, int ticks);
/// Returns a table of searches on ten skeletons, compared with brute force.
std::string skeletonTable();
/// Returns one table per knob: accuracy against speed.
std::string knobTables();
/// Returns the tables of medial meshes: one cone, one slab, and bodies of up to 10,000 slabs.
std::string meshTables();
/// Returns the table of the volume of pressed bodies, with and without VolumeKeeper.
std::string volumeTable();

/// Returns the tables of felt surfaces: the moduli compared with those of continuous tissue, and the largest stiffness
/// that an arm can render.
std::string feltTables();

/// Returns the time per call [s] of `work(i)`: the median of `batches` batches of `calls` calls each.
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

/// Returns the time per call [s] of `work(i)`: the least of `batches` batches. It is meant for work so short that every
/// interruption would show in the median.
template <class Work>
double leastTime(int batches, int calls, Work&& work) {
  double least = 1e300;
  for (int b = 0; b < batches; ++b) least = std::min(least, medianTime(1, calls, work));
  return least;
}

}  // namespace hapticd::bench_mat
