// SPDX-License-Identifier: MIT
/// The present shape of a body, for drawing: the servo thread writes displacements, and another thread reads them.
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <vector>

#include "hapticd/shape.h"
#include "soft_body.hpp"

namespace hapticd {

/// The newest displacements of all nodes. One thread writes them and another thread reads them. Neither waits for the
/// other: if the writer has overwritten the values during a read, the reader reads them again.
class DisplacementBuffer {
 public:
  explicit DisplacementBuffer(std::size_t nodes) : values_(4 * nodes + 1) {}  ///< [main]

  /// [rt] Copies the displacements of all nodes.
  void publish(const medial::Nodes& body) noexcept HSP_RT;
  /// [main] Reads the newest complete set.
  /// @return the bulge [m]
  float read(medial::Displacements& out) const;
  std::size_t bytes() const noexcept { return values_.size() * sizeof(std::atomic<float>); }

 private:
  std::vector<std::atomic<float>> values_;  ///< four values per node, then the bulge
  std::atomic<uint32_t> version_{0};        ///< odd while values_ is being written
};

/// Writes the vertices of a contour for a host that takes the vertices from step() (hsp_step::viz_xyz). A contour that
/// is too large for one step is computed over several steps, from the displacements at the first of them. Meanwhile the
/// host gets the last complete frame.
class Frames {
 public:
  Frames(std::unique_ptr<medial::MovingMesh> contour, std::size_t nodes);  ///< [main] allocates all memory

  /// [rt] Computes at most kPart vertices.
  /// @param xyz memory for a frame if the host wants one now; else nullptr
  void step(const medial::Nodes& body, float* xyz, std::size_t capacity) noexcept HSP_RT;
  const medial::MovingMesh& contour() const noexcept { return *contour_; }
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t kPart = 1024;  ///< most vertices per step; they take about 30 us

  void begin(const medial::Nodes& body) noexcept HSP_RT;
  void write(float* xyz, std::size_t first, std::size_t count) noexcept HSP_RT;

  std::unique_ptr<medial::MovingMesh> contour_;
  medial::Displacements moved_;  ///< displacements of the frame that is being computed
  float bulge_ = 0;              ///< [m] bulge of this frame
  /// the newest complete frame, and the one that is being computed; empty if one step computes a whole frame
  std::vector<float> whole_, work_;
  std::size_t done_ = 0;  ///< number of vertices computed so far
  bool working_ = false;
};

/// [main] The mesh of a body in its present shape.
class Display {
 public:
  /// Fills `out` with the displaced contour, to within `chord_error` [m]. Its pointers are valid until the next call.
  void show(const SoftBody& body, const DisplacementBuffer& displaced, double chord_error, hsp_mesh& out);

 private:
  std::unique_ptr<medial::MovingMesh> contour_;
  double chord_error_ = 0;
  medial::Displacements moved_;
  std::vector<float> xyz_, normals_;
};

}  // namespace hapticd
