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
