// SPDX-License-Identifier: MIT
#include "kernels/medial/medial_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// most levels of the tree; every level halves the elements, so 64 levels suffice for 2^63 of them
constexpr std::size_t kStack = 64;

/// Sorts the corners, so that the order in the file does not matter.
template <std::size_t kCount>
std::array<int, kCount> sorted(std::array<int, kCount> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

template <std::size_t kCount>
void requireCorners(const std::array<int, kCount>& corners, std::size_t vertices, const char* what, std::size_t i) {
  for (std::size_t k = 0; k < kCount; ++k) {
    if (corners[k] < 0 || static_cast<std::size_t>(corners[k]) >= vertices)
      throw std::invalid_argument(std::string(what) + " " + std::to_string(i) + ": vertex " +
                                  std::to_string(corners[k]) + ", expected 0 to " + std::to_string(vertices - 1));
    if (corners[k] == corners[(k + 1) % kCount])
      throw std::invalid_argument(std::string(what) + " " + std::to_string(i) + ": vertex " +
                                  std::to_string(corners[k]) + " is named twice; its vertices must be different");
  }
}

}  // namespace

MedialMesh::MedialMesh(const MeshData& data) : vertices_(data.vertices) {
  if (vertices_.empty()) throw std::invalid_argument("there are no vertices; at least one is needed");
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Sphere& s = vertices_[i];
    if (!s.center.allFinite() || !std::isfinite(s.radius) || s.radius < 0)
      throw std::invalid_argument("vertex " + std::to_string(i) + ": radius " + std::to_string(s.radius) +
                                  "; all numbers must be finite, and the radius at least 0");
  }
  gather(data);
  least_radius_ = std::numeric_limits<double>::infinity();
  for (const Sphere& s : vertices_) {
    bounds_.extend((s.center.array() - s.radius).matrix());
    bounds_.extend((s.center.array() + s.radius).matrix());
    if (s.radius > 0) least_radius_ = std::min(least_radius_, s.radius);
  }
  if (!std::isfinite(least_radius_)) least_radius_ = 0;
  buildTree();
}

void MedialMesh::gather(const MeshData& data) {
  std::set<std::array<int, 2>> edges, covered;
  std::set<std::array<int, 3>> triangles;
  std::vector<bool> used(vertices_.size(), false);
  for (std::size_t i = 0; i < data.triangles.size(); ++i) {
    requireCorners(data.triangles[i], vertices_.size(), "triangle", i);
    const auto t = sorted(data.triangles[i]);
    triangles.insert(t);
    covered.insert({t[0], t[1]});
    covered.insert({t[0], t[2]});
    covered.insert({t[1], t[2]});
    for (const int v : t) used[static_cast<std::size_t>(v)] = true;
  }
  for (std::size_t i = 0; i < data.edges.size(); ++i) {
    requireCorners(data.edges[i], vertices_.size(), "edge", i);
    const auto e = sorted(data.edges[i]);
    if (!covered.contains(e)) edges.insert(e);
    for (const int v : e) used[static_cast<std::size_t>(v)] = true;
  }
  const auto at = [this](int v) -> const Sphere& { return vertices_[static_cast<std::size_t>(v)]; };
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (used[v]) continue;
    const auto alone = static_cast<uint32_t>(v);
    elements_.push_back({{alone, alone, alone}, 1});
    cones_.emplace_back(vertices_[v], vertices_[v]);
  }
  for (const auto& e : edges) {
    elements_.push_back({{static_cast<uint32_t>(e[0]), static_cast<uint32_t>(e[1]), static_cast<uint32_t>(e[0])}, 2});
    cones_.emplace_back(at(e[0]), at(e[1]));
  }
  for (const auto& t : triangles) {
    elements_.push_back({{static_cast<uint32_t>(t[0]), static_cast<uint32_t>(t[1]), static_cast<uint32_t>(t[2])}, 3});
    slabs_.emplace_back(std::array<Sphere, 3>{at(t[0]), at(t[1]), at(t[2])});
  }
}

MedialMesh::Node MedialMesh::boxOf(uint32_t element) const {
  Node node;
  node.low = node.high = vertices_[elements_[element].vertex[0]].center;
  for (const uint32_t v : elements_[element].vertex) {
    node.low = node.low.cwiseMin(vertices_[v].center);
    node.high = node.high.cwiseMax(vertices_[v].center);
    node.radius = std::max(node.radius, vertices_[v].radius);
  }
  node.child = element;
  node.leaf = true;
  return node;
}

/// Returns the node that contains all members.
MedialMesh::Node MedialMesh::boundsOf(const std::vector<Node>& boxes, std::span<const uint32_t> members) {
  Node node = boxes[members.front()];
  for (const uint32_t i : members) {
    node.low = node.low.cwiseMin(boxes[i].low);
    node.high = node.high.cwiseMax(boxes[i].high);
    node.radius = std::max(node.radius, boxes[i].radius);
  }
  return node;
}

std::size_t MedialMesh::halve(const std::vector<Node>& boxes, std::span<uint32_t> members) {
  Eigen::AlignedBox3d middles;
  for (const uint32_t i : members) middles.extend((boxes[i].low + boxes[i].high) / 2);
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const std::size_t half = members.size() / 2;
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half), members.end(),
                   [&](uint32_t a, uint32_t b) {
                     const double x = boxes[a].low[axis] + boxes[a].high[axis];
                     const double y = boxes[b].low[axis] + boxes[b].high[axis];
                     return x < y || (x == y && a < b);
                   });
  return half;
}

void MedialMesh::buildTree() {
  std::vector<uint32_t> order(elements_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Node> boxes;
  for (uint32_t i = 0; i < elements_.size(); ++i) boxes.push_back(boxOf(i));
  struct Task {
    std::size_t node, first, last;
  };
  std::vector<Task> tasks{{0, 0, order.size()}};
  nodes_.reserve(2 * elements_.size());
  nodes_.resize(1);
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const std::span<uint32_t> members(order.data() + task.first, task.last - task.first);
    Node node = boundsOf(boxes, members);
    node.leaf = members.size() == 1;
    if (!node.leaf) {
      const std::size_t middle = task.first + halve(boxes, members);
      node.child = static_cast<uint32_t>(nodes_.size());
      nodes_.resize(nodes_.size() + 2);
      tasks.push_back({node.child, task.first, middle});
      tasks.push_back({node.child + 1, middle, task.last});
    }
    nodes_[task.node] = node;
  }
}

HullFoot MedialMesh::footOn(uint32_t element, const Vector3d& p) const noexcept {
  return element < cones_.size() ? cones_[element].foot(p) : slabs_[element - cones_.size()].foot(p);
}

/// Returns a distance that no sphere of the node goes below: each centre lies in the box, and no radius is greater than
/// node.radius.
double MedialMesh::lowerBound(const Node& node, const Vector3d& p) noexcept {
  return (node.low - p).cwiseMax(p - node.high).cwiseMax(0.0).norm() - node.radius;
}

void MedialMesh::enter(const HullFoot& foot, uint32_t element, double band, MeshFeet& out) noexcept {
  ++out.evaluations;
  const double best = out.count > 0 ? out.feet[0].distance : std::numeric_limits<double>::infinity();
  if (!(foot.distance < best + band) && out.count > 0) return;
  std::size_t place = std::min(out.count, MeshFeet::kMost - 1);  // if the list is full, the farthest foot is replaced
  if (out.count == MeshFeet::kMost && !(foot.distance < out.feet[place].distance)) return;
  for (; place > 0 && foot.distance < out.feet[place - 1].distance; --place) out.feet[place] = out.feet[place - 1];
  static_cast<HullFoot&>(out.feet[place]) = foot;
  out.feet[place].element = element;
  out.count = std::min(out.count + 1, MeshFeet::kMost);
  while (out.count > 1 && !(out.feet[out.count - 1].distance < out.feet[0].distance + band)) --out.count;
}

void MedialMesh::nearest(const Vector3d& p, uint32_t start, double band, MeshFeet& out,
                         int most_visits) const noexcept {
  out.count = 0;
  out.evaluations = out.visits = 0;
  out.doubt = 0;
  const auto look = [&](uint32_t element) { enter(footOn(element, p), element, band, out); };
  if (start < elements_.size()) look(start);
  struct Entry {
    uint32_t node;
    double bound;
  };
  std::array<Entry, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, lowerBound(nodes_[0], p)};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (out.count > 0 && !(entry.bound < out.feet[0].distance + band)) continue;
    if (out.visits >= most_visits && out.count > 0) {
      out.doubt = std::max(out.doubt, out.feet[0].distance - entry.bound);
      continue;
    }
    ++out.visits;
    const Node& node = nodes_[entry.node];
    if (node.leaf) {
      if (node.child != start) look(node.child);
      continue;
    }
    const Entry a{node.child, lowerBound(nodes_[node.child], p)};
    const Entry b{node.child + 1, lowerBound(nodes_[node.child + 1], p)};
    stack[depth++] = a.bound < b.bound ? b : a;  // the nearer child is examined first
    stack[depth++] = a.bound < b.bound ? a : b;
  }
}

double MedialMesh::distance(const Vector3d& p) const noexcept {
  MeshFeet feet;
  nearest(p, kNoStart, 0, feet);
  return feet.feet[0].distance;
}

Vector3d MedialMesh::across(uint32_t element) const noexcept {
  return element < cones_.size() ? Vector3d(Vector3d::Zero()) : slabs_[element - cones_.size()].across();
}

std::array<double, 3> MedialMesh::weights(uint32_t element, const Eigen::Array2d& parameter) const noexcept {
  if (elements_[element].count == 1) return {1, 0, 0};
  if (elements_[element].count == 2) return {1 - parameter[0], parameter[0], 0};
  return {1 - parameter[0] - parameter[1], parameter[0], parameter[1]};
}

std::size_t MedialMesh::bytes() const noexcept {
  return sizeof *this + vertices_.capacity() * sizeof(Sphere) + elements_.capacity() * sizeof(Element) +
         cones_.capacity() * sizeof(Cone) + slabs_.capacity() * sizeof(Slab) + nodes_.capacity() * sizeof(Node);
}

}  // namespace hapticd::medial
