#include "kernels/medial/deformation.hpp"

#include <algorithm>

#include "kernels/spline/basis.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector4d;

Influence whole(std::span<const double> basis, int span) noexcept {
  Influence all;
  all.count = static_cast<int>(basis.size());
  all.first = span - all.count + 1;
  std::copy(basis.begin(), basis.end(), all.basis.begin());
  return all;
}

std::size_t total(const ControlGrid& grid) {
  return static_cast<std::size_t>(grid.count[0]) * static_cast<std::size_t>(grid.count[1]);
}

/// The control points of an influence each way, with the products of their weights.
template <class Weights>
void list(const std::array<Influence, 2>& influence, int columns, Weights weights, auto& out) noexcept {
  out.count = 0;
  for (int i = 0; i < influence[0].count; ++i)
    for (int j = 0; j < influence[1].count; ++j)
      out.parts[out.count++] = {
          static_cast<uint32_t>((influence[0].first + i) * columns + influence[1].first + j),
          (influence[0].*weights)[static_cast<std::size_t>(i)] * (influence[1].*weights)[static_cast<std::size_t>(j)]};
}

}  // namespace

Deformation::Deformation(const Skeleton& skeleton, const std::vector<Oscillator>& material,
                         const DeformationOptions& options)
    : Nodes(total(skeleton.control()), material, options), skeleton_(&skeleton) {}

Deformation::Reach Deformation::reachOf(double u, double v) const noexcept {
  const ControlGrid& grid = skeleton_->control();
  const std::array<double, 2> at{u, v};
  std::array<Influence, 2> moved, all;
  for (std::size_t a = 0; a < 2; ++a) {
    std::array<double, spline::kMaxDegree + 1> values{};
    const int span = spline::findSpan(grid.knots[a], grid.degree[a], at[a]);
    spline::basisFunctions(grid.knots[a], grid.degree[a], span, at[a], values);
    const std::span<const double> basis(values.data(), static_cast<std::size_t>(grid.degree[a]) + 1);
    moved[a] = influence(basis, span, options().influence[a], Choice::kLargest);
    all[a] = whole(basis, span);
  }
  Reach reach;
  list(moved, grid.count[1], &Influence::alpha, reach.moved);
  list(all, grid.count[1], &Influence::basis, reach.all);
  return reach;
}

void Deformation::press(std::span<const Press> contacts) noexcept {
  if (!options().dynamics) clear();
  const std::size_t count = std::min(contacts.size(), static_cast<std::size_t>(kMaxContacts));
  std::array<Reach, kMaxContacts> reach;
  for (std::size_t i = 0; i < count; ++i) reach[i] = reachOf(contacts[i].u, contacts[i].v);
  const int sweeps = count > 1 ? kSweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t i = 0; i < count; ++i)
      yield({contacts[i].normal, contacts[i].depth, contacts[i].speed}, reach[i].all.span(), reach[i].moved.span());
}

Vector4d Deformation::at(double u, double v) const noexcept {
  Vector4d sum = Vector4d::Zero();
  if (awake() == 0) return sum;
  const Reach reach = reachOf(u, v);
  for (const NodeWeight& part : reach.all.span()) sum += part.weight * displacement(part.node);
  return sum;
}

}  // namespace hapticd::medial
