// SPDX-License-Identifier: MIT
/// Passes the vertices of a deforming shape from its step to the program that draws them.
#pragma once
#include <atomic>
#include <vector>

#include "base/triple_buffer.hpp"
#include "hapticd/shape.h"

namespace hapticd::host {

/// While a program asks for frames, the shape writes 60 frames per second directly into one of three buffers, and
/// another thread takes the newest. Neither thread waits. If no program asks, nothing is written.
class Contour {
 public:
  static constexpr double kRate = 60;  ///< [Hz]
  struct Frame {
    uint64_t number = 0;     ///< number of the frame, from 1; 0: none has come yet
    std::vector<float> xyz;  ///< [m] vertices in the model's frame
  };

  /// [main] Allocates the memory of all frames.
  explicit Contour(uint32_t vertices) : vertices_(vertices) {
    for (int slot = 0; slot < 3; ++slot) {  // so each of the three buffers is the back buffer once
      frames_.back().xyz.resize(3 * std::size_t{vertices});
      frames_.update();
      frames_.publish();
    }
  }

  /// [rt] Called before a step of dt [s]. Returns where the step must write vertices; nullptr if it must not.
  float* offer(double dt) noexcept HSP_RT {
    since_ += dt;
    offered_ = since_ >= 1 / kRate && wanted_.load(std::memory_order_relaxed) > 0;
    if (!offered_) return nullptr;
    since_ = since_ < 2 / kRate ? since_ - 1 / kRate : 0;
    return frames_.back().xyz.data();
  }
  /// [rt] Called after that step. `written` says that it succeeded.
  void close(bool written) noexcept HSP_RT {
    if (!offered_ || !written) return;
    frames_.back().number = ++number_;
    frames_.publish();
    wanted_.fetch_sub(1, std::memory_order_relaxed);
  }

  /// [any] Called from one thread only. Returns the newest frame, which is valid until the next call. The shape makes
  /// frames only as long as this function is called.
  const Frame& newest() noexcept {
    wanted_.store(kPatience, std::memory_order_relaxed);
    frames_.update();
    return frames_.front();
  }
  uint32_t vertices() const noexcept { return vertices_; }

 private:
  static constexpr int kPatience = 60;  ///< number of frames that are made after the last call of newest()
  uint32_t vertices_;
  TripleBuffer<Frame> frames_;
  std::atomic<int> wanted_{0};
  double since_ = 1 / kRate;  ///< [s] time since the last frame
  uint64_t number_ = 0;
  bool offered_ = false;
};

}  // namespace hapticd::host
