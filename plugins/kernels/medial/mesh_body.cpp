// SPDX-License-Identifier: MIT
#include "kernels/medial/mesh_body.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "kernels/medial/bounds.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kMostRings = 8;
/// share of its weight that a vertex keeps when the weight is spread; the rest goes to its neighbours
constexpr double kOwnShare = 0.5;
constexpr double kAside = 1e-6;  ///< [m] the probe is moved by this much to measure how its foot follows
/// share of the radius; feet on joined parts that are farther apart count as two feet
constexpr double kApart = 0.1;
constexpr double kOneTube = 0.5;  ///< [rad] joined parts that turn by less than this are one tube or sheet
/// share of the radius; feet that are nearer to each other than this count as one
constexpr double kRoundingOfFeet = 1e-6;
/// If 1 + cosine of the normals of the nearest foot and a rival (a foot on another part of the body) is below 1 / this,
/// the rival counts less; it does not count if the normals are opposite.
constexpr double kOpposite = 4;

/// Checks the values of a material. If all vertices have the same value, returns only this one.
std::vector<double> oneOrAll(const std::vector<double>& values, std::size_t vertices, const char* what) {
  if (values.empty()) return {0};
  if (values.size() != 1 && values.size() != vertices)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(values.size()) + " values, expected " +
                                std::to_string(vertices) + ", one for each vertex");
  for (const double value : values)
    if (!(value >= 0) || !std::isfinite(value))
      throw std::invalid_argument(std::string(what) + ": " + std::to_string(value) +
                                  ", but it must be a finite number of at least 0");
  if (std::all_of(values.begin(), values.end(), [&](double x) { return x == values[0]; })) return {values[0]};
  return values;
}

double pick(const std::vector<double>& values, std::size_t i) noexcept {
  return values[values.size() == 1 ? 0 : i];
}

}  // namespace

MeshDeformation::MeshDeformation(const MedialMesh& mesh, const std::vector<Oscillator>& material,
                                 const DeformationOptions& options)
    : Nodes(mesh.vertices().size(), material, options), mesh_(&mesh), ends_(endsOf(mesh)) {
  join(mesh);
  place_.assign(mesh.vertices().size(), UINT32_MAX);
  reaches_.resize(kMaxContacts);
}

void MeshDeformation::join(const MedialMesh& mesh) {
  std::set<std::array<uint32_t, 2>> pairs;
  for (const MedialMesh::Element& element : mesh.elements())
    for (const uint32_t a : element.vertex)
      for (const uint32_t b : element.vertex)
        if (a != b) pairs.insert({a, b});
  first_.assign(mesh.vertices().size() + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++first_[a + 1];
    neighbour_.push_back(b);  // the pairs are sorted by a
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

void MeshDeformation::add(Reach& reach, uint32_t node, double weight) noexcept {
  if (place_[node] == UINT32_MAX) {
    if (reach.moved_count == kMostMoved) return;
    place_[node] = static_cast<uint32_t>(reach.moved_count);
    reach.moved[reach.moved_count++] = {node, 0};
  }
  reach.moved[place_[node]].weight += weight;
}

/// Spreads the weights: every vertex keeps kOwnShare of its weight, and gives the rest to its neighbours in equal
/// parts.
void MeshDeformation::spread(Reach& reach) noexcept {
  const std::size_t count = reach.moved_count;
  std::array<double, kMostMoved> before;
  for (std::size_t k = 0; k < count; ++k) before[k] = reach.moved[k].weight;
  for (std::size_t k = 0; k < count; ++k) {
    const uint32_t node = reach.moved[k].node, begin = first_[node], end = first_[node + 1];
    if (begin == end) continue;
    reach.moved[k].weight -= (1 - kOwnShare) * before[k];
    const double each = (1 - kOwnShare) * before[k] / (end - begin);
    for (uint32_t n = begin; n < end; ++n) add(reach, neighbour_[n], each);
  }
}

void MeshDeformation::reach(const Press& contact, Reach& out) noexcept {
  const MedialMesh::Element& element = mesh_->elements()[contact.element];
  const std::array<double, 3> weights = mesh_->weights(contact.element, {contact.u, contact.v});
  out.felt_count = element.count;
  out.moved_count = 0;
  for (std::size_t i = 0; i < element.count; ++i) {
    out.felt[i] = {element.vertex[i], weights[i]};
    if (weights[i] > 0) add(out, element.vertex[i], weights[i]);
  }
  for (int ring = std::min(options().rings, kMostRings); ring > 0; --ring) spread(out);
  double sum = 0;
  for (std::size_t i = 0; i < element.count; ++i)
    if (place_[element.vertex[i]] != UINT32_MAX) sum += weights[i] * out.moved[place_[element.vertex[i]]].weight;
  for (std::size_t k = 0; k < out.moved_count; ++k) {
    place_[out.moved[k].node] = UINT32_MAX;
    out.moved[k].weight = sum > 0 ? out.moved[k].weight / sum : 0;
  }
}

PlaceNode& MeshDeformation::nodeOf(FeltPlace& place, uint32_t node) noexcept {
  if (place_[node] == UINT32_MAX && place.count < FeltPlace::kMost) {
    place_[node] = static_cast<uint32_t>(place.count);
    place.nodes[place.count++] = {node, 0, 0, 0};
  }
  // if the list is full, the weight is added to that of the first corner
  return place.nodes[place_[node] == UINT32_MAX ? 0 : place_[node]];
}

void MeshDeformation::spread(FeltPlace& place) noexcept {
  const std::size_t count = place.count;
  std::array<PlaceNode, FeltPlace::kMost> before;
  std::copy_n(place.nodes.begin(), count, before.begin());
  for (std::size_t k = 0; k < count; ++k) {
    const uint32_t begin = first_[before[k].node], end = first_[before[k].node + 1];
    if (begin == end) continue;
    const auto give = [&](PlaceNode& to, double share) {
      to.weight += share * before[k].weight;
      to.weight_u += share * before[k].weight_u;
      to.weight_v += share * before[k].weight_v;
    };
    give(place.nodes[k], kOwnShare - 1);
    for (uint32_t n = begin; n < end; ++n) give(nodeOf(place, neighbour_[n]), (1 - kOwnShare) / (end - begin));
  }
}

void MeshDeformation::nodesAt(uint32_t element, const Eigen::Array2d& parameter, FeltPlace& place) noexcept {
  const MedialMesh::Element& corners = mesh_->elements()[element];
  const CornerWeights weights = weightsTowardEnds(*mesh_, ends_, element, parameter);
  place.count = 0;
  for (std::size_t i = 0; i < corners.count; ++i) {
    PlaceNode& corner = nodeOf(place, corners.vertex[i]);
    corner.weight = weights.value[i];
    corner.weight_u = weights.along_u[i];
    corner.weight_v = weights.along_v[i];
  }
  for (int ring = std::min(options().rings, kMostRings); ring > 0; --ring) spread(place);
  for (std::size_t k = 0; k < place.count; ++k) place_[place.nodes[k].node] = UINT32_MAX;
}

void MeshDeformation::press(std::span<const Press> contacts) noexcept {
  if (!options().dynamics) clear();
  const std::size_t count = std::min(contacts.size(), static_cast<std::size_t>(kMaxContacts));
  for (std::size_t i = 0; i < count; ++i) reach(contacts[i], reaches_[i]);
  const int sweeps = count > 1 ? kSweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t i = 0; i < count; ++i)
      yield({contacts[i].normal, contacts[i].depth, contacts[i].speed},
            {reaches_[i].felt.data(), reaches_[i].felt_count}, {reaches_[i].moved.data(), reaches_[i].moved_count});
}

Vector4d MeshDeformation::at(uint32_t element, const Eigen::Array2d& parameter) const noexcept {
  const std::array<double, 3> weights = mesh_->weights(element, parameter);
  Vector4d sum = Vector4d::Zero();
  for (std::size_t i = 0; i < mesh_->elements()[element].count; ++i)
    sum += weights[i] * displacement(mesh_->elements()[element].vertex[i]);
  return sum;
}

std::size_t MeshDeformation::bytes() const noexcept {
  return Nodes::bytes() + ends_.capacity() +
         (first_.capacity() + neighbour_.capacity() + place_.capacity()) * sizeof(uint32_t) +
         reaches_.capacity() * sizeof(Reach);
}

MeshBody::MeshBody(const MeshBodyData& data, const BodyOptions& options) : options_(options), mesh_(data.mesh) {
  const std::size_t count = mesh_.vertices().size();
  stiffness_ = oneOrAll(data.stiffness, count, "stiffness");
  damping_ = oneOrAll(data.damping, count, "damping");
  const std::vector<double> mass = oneOrAll(data.mass, count, "mass");
  std::vector<Oscillator> material;
  const bool same = stiffness_.size() == 1 && damping_.size() == 1 && mass.size() == 1;
  for (std::size_t i = 0; i < (same ? 1 : count); ++i)
    material.push_back({pick(mass, i), pick(damping_, i), pick(stiffness_, i)});
  deformation_.emplace(mesh_, material, options.deformation);
  if (!options.felt.on) return;
  std::vector<Tissue> tissue;
  for (const Oscillator& o : material)
    tissue.push_back({o.stiffness, o.damping, o.mass, options.felt.relaxation_share, options.felt.relaxation_time});
  felt_.emplace(*deformation_, tissue, std::vector<double>(count, 1.0), options.felt.contact_ratio, options.felt.tick);
}

/// The gradients of the parameters are computed by differences on the foot's cone or slab, whose closed form is cheap.
void MeshBody::placeOf(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal, double direct,
                       FeltPlace& place) noexcept {
  deformation_->nodesAt(foot.element, {foot.u, foot.v}, place);
  place.normal = normal;
  place.stiffness = material(stiffness_, foot);
  const MedialMesh::Element& element = mesh_.elements()[foot.element];
  const auto center = [&](std::size_t corner) { return mesh_.vertices()[element.vertex[corner]].center; };
  place.toward_u = place.toward_v = Vector3d::Zero();
  for (Eigen::Index k = 0; k < 3 && element.count > 1; ++k) {
    const Vector3d aside = kAside * Vector3d::Unit(k);
    const Eigen::Array2d there = mesh_.footOn(foot.element, p + aside).parameter;
    const Eigen::Array2d back = mesh_.footOn(foot.element, p - aside).parameter;
    place.toward_u[k] = (there[0] - back[0]) / (2 * kAside);
    place.toward_v[k] = (there[1] - back[1]) / (2 * kAside);
  }
  place.tangent_u = element.count > 1 ? Vector3d(center(1) - center(0)) : Vector3d(Vector3d::Zero());
  place.tangent_v = element.count > 2 ? Vector3d(center(2) - center(0)) : Vector3d(Vector3d::Zero());
  const double distance = (p - foot.center).norm();
  place.turn = distance > kNearAxis ? direct * std::min(1.0, distance / kNearAxis - 1) / distance : 0;
}

/// The foot on a cone or slab may lie at its end, where the next one begins. Such a foot does not count as another part
/// of the body, so that a flat sheet of many slabs stays flat.
double MeshBody::apart(const MeshFoot& a, const MeshFoot& b) const noexcept {
  const MedialMesh::Element &one = mesh_.elements()[a.element], &other = mesh_.elements()[b.element];
  const auto begin = one.vertex.begin(), end = begin + one.count;
  const bool joined = std::any_of(other.vertex.begin(), other.vertex.begin() + other.count,
                                  [&](uint32_t vertex) { return std::find(begin, end, vertex) != end; });
  if (!joined) return 1;
  const double gap = std::min((mesh_.footOn(a.element, b.center).center - b.center).norm(),
                              (mesh_.footOn(b.element, a.center).center - a.center).norm());
  const double whole = kApart * std::max(a.radius, b.radius);
  return gap < whole ? gap / whole : 1;
}

double MeshBody::bend(const MedialMesh::Element& one, const MedialMesh::Element& other, uint32_t a,
                      uint32_t b) const noexcept {
  const auto begin = one.vertex.begin(), end = begin + one.count;
  const auto shared = std::find_first_of(begin, end, other.vertex.begin(), other.vertex.begin() + other.count);
  if (shared == end || one.count != other.count || one.count < 2) return -1;
  if (one.count == 3) {
    const double cosine = std::abs(mesh_.across(a).dot(mesh_.across(b)));
    return cosine > 0 ? std::acos(std::min(1.0, cosine)) : -1;
  }
  const Sphere& joint = mesh_.vertices()[*shared];
  std::array<Vector3d, 2> away;
  std::array<double, 2> flare{};  // [rad] angle between the cone's side and its axis, seen from the joint
  const std::array<const MedialMesh::Element*, 2> both = {&one, &other};
  for (std::size_t i = 0; i < 2; ++i) {
    const Sphere& far = mesh_.vertices()[both[i]->vertex[both[i]->vertex[0] == *shared ? 1 : 0]];
    away[i] = far.center - joint.center;
    const double length = away[i].norm();
    if (!(length > std::abs(far.radius - joint.radius))) return -1;  // one sphere contains the other
    away[i] /= length;
    flare[i] = std::asin((far.radius - joint.radius) / length);
  }
  return std::acos(std::clamp(-away[0].dot(away[1]), -1.0, 1.0)) + std::abs(flare[0] + flare[1]);
}

/// Along a tube of many cones, or a sheet of many slabs, the nearest sphere of the neighbouring element is the shared
/// one. Its normal is tilted, but it does not belong to another part. There is a crease only in a bend between two
/// separate feet, and each of them can be off the joint only by an amount that grows with the bend.
double MeshBody::besideStraight(const MeshFoot& a, const MeshFoot& b) const noexcept {
  const double turn = bend(mesh_.elements()[a.element], mesh_.elements()[b.element], a.element, b.element);
  if (turn < 0 || turn > kOneTube) return 1;
  const double gap = std::min((mesh_.footOn(a.element, b.center).center - b.center).norm(),
                              (mesh_.footOn(b.element, a.center).center - a.center).norm());
  const double whole = std::max(0.25 * turn * turn, kRoundingOfFeet) * std::max(a.radius, b.radius);
  return std::min(1.0, gap / whole);
}

SkeletonFoot MeshBody::footOf(const MeshFoot& found) const noexcept {
  SkeletonFoot foot;
  foot.element = found.element;
  foot.u = found.parameter[0];
  foot.v = found.parameter[1];
  foot.center = found.center;
  foot.radius = found.radius;
  foot.depth = -found.distance;
  foot.normal = found.normal;
  foot.across = mesh_.across(found.element);
  return foot;
}

double MeshBody::feet(const Vector3d& p, uint32_t start, double crease, SkeletonFoot& foot,
                      SkeletonFoot& rival) const noexcept {
  foot = this->foot(p, start, 0, MedialMesh::kMostVisits);
  if (!(foot.depth > 0) || !(crease > 0) || foot.residual > 0) return 0;
  MeshFeet feet;
  mesh_.nearest(p, foot.element, crease, feet, MedialMesh::kMostVisits);
  double most = 0, two = 0;
  for (std::size_t i = 1; i < feet.count; ++i) {
    double away = 1;
    for (std::size_t k = 0; k < i; ++k) away *= apart(feet.feet[k], feet.feet[i]);
    const double counts = away * (1 - (feet.feet[i].distance - feet.feet[0].distance) / crease);
    if (!(counts > most)) continue;
    most = counts;
    two = away;
    rival = footOf(feet.feet[i]);
  }
  return two;
}

SkeletonFoot MeshBody::foot(const Vector3d& p, uint32_t start, double crease, int most_visits) const noexcept {
  MeshFeet feet;
  mesh_.nearest(p, start, 0, feet, most_visits);
  int evaluations = feet.evaluations;
  const double doubt = feet.doubt;
  const bool inside = feet.feet[0].distance < 0;
  if (inside && crease > 0 && !(doubt > 0)) {  // a search with doubt ended in the middle of a body, which has no crease
    mesh_.nearest(p, feet.feet[0].element, crease, feet, most_visits);
    evaluations += feet.evaluations;
  }
  const MeshFoot& best = feet.feet[0];
  SkeletonFoot foot = footOf(best);
  foot.evaluations = evaluations;
  foot.residual = doubt;
  foot.converged = std::isfinite(best.distance) && !(doubt > 0);
  if (feet.count < 2) return foot;
  // In the middle of a sheet or tube the opposite side is equally near, but this is not a crease.
  Vector3d sum = best.normal;
  for (std::size_t i = 1; i < feet.count; ++i) {
    const double cosine = feet.feet[i].normal.dot(best.normal);
    double opposite = std::min(1.0, kOpposite * (1 + cosine));
    for (std::size_t k = 0; k < i && opposite > 0; ++k) opposite *= besideStraight(feet.feet[k], feet.feet[i]);
    sum += opposite * (1 - (feet.feet[i].distance - best.distance) / crease) * feet.feet[i].normal;
  }
  foot.normal = sum.normalized();
  return foot;
}

double MeshBody::material(const std::vector<double>& values, const SkeletonFoot& foot) const noexcept {
  if (values.size() == 1) return values[0];
  const std::array<double, 3> weights = mesh_.weights(foot.element, {foot.u, foot.v});
  const MedialMesh::Element& element = mesh_.elements()[foot.element];
  double sum = 0;
  for (std::size_t i = 0; i < element.count; ++i) sum += weights[i] * values[element.vertex[i]];
  return std::max(0.0, sum);
}

double MeshBody::greatestStiffness() const noexcept {
  return *std::max_element(stiffness_.begin(), stiffness_.end());
}

std::size_t MeshBody::bytes() const noexcept {
  return sizeof *this - sizeof mesh_ + mesh_.bytes() + (stiffness_.capacity() + damping_.capacity()) * sizeof(double) +
         deformation_->bytes() + (felt_ ? felt_->bytes() : 0);
}

}  // namespace hapticd::medial
