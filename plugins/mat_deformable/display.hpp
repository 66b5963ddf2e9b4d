// SPDX-License-Identifier: MIT
/// What a body looks like now, for whoever draws it: displacements that the servo leaves and another thread takes.
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <vector>

#include "hapticd/shape.h"
#include "soft_body.hpp"

namespace hapticd {

/// Newest displacements of all nodes, written by one thread and read by another without waiting for each
/// other: a reader that was overtaken tries again.
class Displaced {
 public:
  explicit Displaced(std::size_t nodes) : values_(4 * nodes + 1) {}  ///< [main]

  /// [rt]
  void publish(const medial::Nodes& body) noexcept HSP_RT;
  /// [main] The newest whole set. @returns the bulge
  float read(medial::Displacements& out) const;
  std::size_t bytes() const noexcept { return values_.size() * sizeof(std::atomic<float>); }

 private:
  std::vector<std::atomic<float>> values_;  ///< four a node, and the bulge
  std::atomic<uint32_t> version_{0};        ///< odd while it is written
};

/// Writes the vertices of a contour for a host that draws them in its steps. One that is too large for a step is
/// written in parts, of the body as it was when the first was written; then a frame is one of those of before.
class Frames {
 public:
  Frames(std::unique_ptr<medial::MovingMesh> contour, std::size_t nodes);  ///< [main] memory is taken here

  /// [rt] At most kPart vertices are made. `xyz`: where the host wants a frame now; nullptr: nowhere.
  void step(const medial::Nodes& body, float* xyz, std::size_t capacity) noexcept HSP_RT;
  const medial::MovingMesh& contour() const noexcept { return *contour_; }
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t kPart = 1024;  ///< vertices: some 30 us

  void begin(const medial::Nodes& body) noexcept HSP_RT;
  void write(float* xyz, std::size_t first, std::size_t count) noexcept HSP_RT;

  std::unique_ptr<medial::MovingMesh> contour_;
  medial::Displacements moved_;      ///< of the frame at work
  float bulge_ = 0;                  ///< likewise
  std::vector<float> whole_, work_;  ///< the newest frame, and the one at work; empty: a step makes all
  std::size_t done_ = 0;             ///< vertices of the frame at work
  bool working_ = false;
};

/// The mesh of a body as it is now. [main]
class Display {
 public:
  /// Fills `out` with the contour within `chord_error` [m], displaced; its pointers live until the next call.
  void show(const SoftBody& body, const Displaced& displaced, double chord_error, hsp_mesh& out);

 private:
  std::unique_ptr<medial::MovingMesh> contour_;
  double chord_error_ = 0;
  medial::Displacements moved_;
  std::vector<float> xyz_, normals_;
};

}  // namespace hapticd
