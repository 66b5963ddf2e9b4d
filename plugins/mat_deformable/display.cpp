// SPDX-License-Identifier: MIT
#include "display.hpp"

#include <algorithm>
#include <utility>

namespace hapticd {

namespace {
/// most attempts to read a complete set of displacements; they suffice, because a set is written in microseconds, and
/// only 60 times a second
constexpr int kAttempts = 100;
}  // namespace

void DisplacementBuffer::publish(const medial::Nodes& body) noexcept HSP_RT {
  const uint32_t version = version_.load(std::memory_order_relaxed);
  version_.store(version + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  for (std::size_t i = 0; i < body.count(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      values_[4 * i + k].store(static_cast<float>(body.displacement(i)[static_cast<Eigen::Index>(k)]),
                               std::memory_order_relaxed);
  values_.back().store(static_cast<float>(body.bulge()), std::memory_order_relaxed);
  version_.store(version + 2, std::memory_order_release);
}

float DisplacementBuffer::read(medial::Displacements& out) const {
  out.resize(values_.size() / 4);
  float bulge = 0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const uint32_t before = version_.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < out.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        out[i][static_cast<Eigen::Index>(k)] = values_[4 * i + k].load(std::memory_order_relaxed);
    bulge = values_.back().load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) break;
  }
  return bulge;
}

Frames::Frames(std::unique_ptr<medial::MovingMesh> contour, std::size_t nodes)
    : contour_(std::move(contour)), moved_(nodes) {
  if (contour_->vertexCount() > kPart) whole_ = work_ = contour_->atRest();
}

void Frames::begin(const medial::Nodes& body) noexcept HSP_RT {
  for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = body.displacement(i).cast<float>();
  bulge_ = static_cast<float>(body.bulge());
}

void Frames::write(float* xyz, std::size_t first, std::size_t count) noexcept HSP_RT {
  contour_->write([this](std::size_t i) -> const Eigen::Vector4f& { return moved_[i]; }, xyz, count, bulge_, first);
}

void Frames::step(const medial::Nodes& body, float* xyz, std::size_t capacity) noexcept HSP_RT {
  if (whole_.empty()) {
    if (xyz == nullptr) return;
    begin(body);
    return write(xyz, 0, capacity);
  }
  if (working_) {
    const std::size_t count = std::min(kPart, contour_->vertexCount() - done_);
    write(work_.data() + 3 * done_, done_, count);
    done_ += count;
    working_ = done_ < contour_->vertexCount();
    if (!working_) std::swap(whole_, work_);
  }
  if (xyz == nullptr) return;
  std::copy_n(whole_.data(), 3 * std::min(capacity, contour_->vertexCount()), xyz);
  if (working_) return;
  begin(body);
  done_ = 0;
  working_ = true;
}

std::size_t Frames::bytes() const noexcept {
  return sizeof *this + contour_->bytes() + moved_.capacity() * sizeof moved_[0] +
         (whole_.capacity() + work_.capacity()) * sizeof(float);
}

void Display::show(const SoftBody& body, const DisplacementBuffer& displaced, double chord_error, hsp_mesh& out) {
  if (!contour_ || chord_error != chord_error_) {
    contour_ = body.contour(chord_error);
    chord_error_ = chord_error;
  }
  const float bulge = displaced.read(moved_);
  xyz_.resize(3 * contour_->vertexCount());
  contour_->write([this](std::size_t i) -> const Eigen::Vector4f& { return moved_[i]; }, xyz_.data(),
                  contour_->vertexCount(), bulge);
  normals_ = contour_->normalsOf(xyz_);
  out.vertex_count = static_cast<uint32_t>(contour_->vertexCount());
  out.triangle_count = static_cast<uint32_t>(contour_->indices().size() / 3);
  out.xyz = xyz_.data();
  out.normals = normals_.data();
  out.indices = contour_->indices().data();
}

}  // namespace hapticd
