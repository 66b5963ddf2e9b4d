// SPDX-License-Identifier: MIT
#include "kernels/medial/felt_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/medial/unilateral.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

/// Greatest slope of a dent that is used. On the inside of a bend the foot may move at any speed, and without this
/// limit the slope would grow with it.
constexpr double kSteepestDent = 1;
constexpr uint32_t kLooksForSleep = 8;  ///< number of ticks between two searches for nodes that have come to rest
constexpr double kNearby = 1e-6;        ///< [m] a probe that is nearer to the surface than this touches it
constexpr int kMostSweeps = 64;         ///< most passes over several contacts
/// [N] The passes end if no force changes by more than this plus kSameForce times the force.
constexpr double kSettled = 1e-15;
constexpr double kSameForce = 1e-13;

bool sameTissue(const Tissue& a, const Tissue& b) {
  return a.stiffness == b.stiffness && a.damping == b.damping && a.mass == b.mass &&
         a.relaxation_share == b.relaxation_share && a.relaxation_time == b.relaxation_time;
}

Vector4d inwardOf(const Vector3d& normal) noexcept {
  Vector4d inward;
  inward << -normal, -1;
  return inward;
}

}  // namespace

FeltSurface::FeltSurface(Nodes& nodes, const std::vector<Tissue>& tissue, std::vector<double> compliance, double ratio,
                         double dt)
    : nodes_(&nodes), compliance_(std::move(compliance)), ratio_(ratio) {
  if (tissue.size() != 1 && tissue.size() != nodes.count())
    throw std::invalid_argument("felt surface: " + std::to_string(tissue.size()) + " materials, expected 1 or " +
                                std::to_string(nodes.count()));
  if (compliance_.size() != nodes.count())
    throw std::invalid_argument("felt surface: there must be one compliance per node");
  const double g = nodes.options().split;
  shares_ << g, g, g, 1 - g;
  for (const Tissue& t : tissue) share_ = std::max(share_, t.relaxation_share);
  take(tissue, dt);
  touched_.assign(nodes.count(), 0);
}

void FeltSurface::take(const std::vector<Tissue>& tissue, double dt) {
  std::vector<Tissue> known;
  std::vector<uint16_t> which;
  for (const Tissue& t : tissue) {
    auto found = std::find_if(known.begin(), known.end(), [&t](const Tissue& other) { return sameTissue(t, other); });
    if (found == known.end()) {
      if (known.size() > UINT16_MAX) throw std::invalid_argument("more than 65536 materials");
      found = known.insert(known.end(), t);
      Material& material = materials_.emplace_back();
      material.element = elementOf(t, ratio_);
      if (material.element.branch > 0) branch_.assign(nodes_->count(), Vector4d::Zero());
      if (dt > 0) prepare(material, dt);
      settle_ = std::max(settle_, medial::settleTime(material.damped, kAsleep));
    }
    which.push_back(static_cast<uint16_t>(found - known.begin()));
  }
  materials_.shrink_to_fit();
  if (materials_.size() > 1) which_ = std::move(which);
}

void FeltSurface::prepare(Material& material, double dt) noexcept {
  if (std::fabs(dt - material.prepared) <= kSameStep * dt) return;
  material.prepared = dt;
  material.damped = dampedForTick(material.element, dt);
  const SurfaceElement& e = material.damped;
  material.time_scale2 = e.stiffness > 0 ? e.mass / e.stiffness : 0;
  ViscoelasticStep s = viscoelasticStep(e, dt);
  for (double* x : {&s.xx, &s.xv, &s.xy, &s.vx, &s.vv, &s.vy, &s.yx, &s.yv, &s.yy}) *x *= 1 - kRoundingLoss;
  material.step = s;
}

/// The compliance of a held press is h = sum of weight^2 * compliance / stiffness of the nodes. The scale is chosen so
/// that scale^2 * h is the compliance of the material at this place.
void FeltSurface::fit(FeltPlace& place) const noexcept {
  double h = 0, hu = 0, hv = 0, yields = 0;
  const bool uniform = this->uniform();
  for (std::size_t i = 0; i < place.count; ++i) {
    const PlaceNode& part = place.nodes[i];
    double soft = part.weight * compliance_[part.node];
    yields += part.weight * soft;
    if (!uniform) {
      const double stiffness = materialOf(part.node).element.stiffness;
      if (!(stiffness > 0)) continue;
      soft /= stiffness;
      h += part.weight * soft;
    }
    hu += part.weight_u * soft;
    hv += part.weight_v * soft;
  }
  place.contact = place.scale = 0;
  place.yields = yields;
  const double of_all = materials_.front().element.stiffness, whole = uniform ? yields : h;
  if (uniform) h = of_all > 0 ? yields / of_all : 0;
  if (!(h > 0) || !(place.stiffness > 0)) return;
  const double ratio = contactRatio();
  place.contact = ratio * place.stiffness;
  place.scale = 1 / std::sqrt(place.stiffness * ratio / (ratio - 1) * h);
  place.ripple = {-hu / whole, -hv / whole};
}

/// Returns the displacement [m] of the contour at a place.
double FeltSurface::shift(const FeltPlace& place) const noexcept {
  Vector4d sum = Vector4d::Zero();
  for (std::size_t i = 0; i < place.count; ++i) sum += place.nodes[i].weight * nodes_->nodes_[place.nodes[i].node].x;
  return place.scale * inwardOf(place.normal).dot(sum);
}

/// Returns the displacement [m/N] of the contour at `a` within a tick, per force at `b`.
double FeltSurface::complianceBetween(const FeltPlace& a, const FeltPlace& b, double dt) noexcept {
  const double along = inwardOf(a.normal).cwiseProduct(shares_).dot(inwardOf(b.normal));
  if (&a == &b && uniform()) {
    prepare(materials_.front(), dt);
    return a.scale * a.scale * along * a.yields * materials_.front().step.xf;
  }
  double sum = 0;
  const auto add = [&](uint32_t node, double weights) {
    Material& material = materialOf(node);
    prepare(material, dt);
    sum += weights * compliance_[node] * material.step.xf;
  };
  if (&a == &b) {
    for (std::size_t i = 0; i < a.count; ++i) add(a.nodes[i].node, a.nodes[i].weight * a.nodes[i].weight);
  } else {
    for (std::size_t i = 0; i < a.count; ++i)
      for (std::size_t j = 0; j < b.count; ++j)
        if (a.nodes[i].node == b.nodes[j].node) add(a.nodes[i].node, a.nodes[i].weight * b.nodes[j].weight);
  }
  return a.scale * b.scale * along * sum;
}

void FeltSurface::wake(uint32_t node) noexcept {
  if (nodes_->is_awake_[node] == 0) nodes_->wake(node);
  touched_[node] = tick_;
}

/// Moves the surface inward to a displacement [m], if the present one is less, as a long press does. Moving toward the
/// rest position removes energy, and so does stopping what moves.
void FeltSurface::setDisplacement(const FeltPlace& place, double displacement) noexcept {
  const double ratio = contactRatio();
  const double lag = displacement - shift(place);
  if (!(lag > 0) || !(place.scale > 0)) return;
  const double force = lag * place.stiffness * ratio / (ratio - 1);
  const Vector4d push = place.scale * force * shares_.cwiseProduct(inwardOf(place.normal));
  for (std::size_t i = 0; i < place.count; ++i) {
    const PlaceNode& part = place.nodes[i];
    const double stiffness = materialOf(part.node).element.stiffness;
    if (!(stiffness > 0) || part.weight == 0) continue;
    wake(part.node);
    const Vector4d moved = part.weight * compliance_[part.node] / stiffness * push;
    nodes_->nodes_[part.node].x += moved;
    nodes_->nodes_[part.node].v.setZero();
    if (!branch_.empty()) branch_[part.node] += moved;
  }
}

void FeltSurface::stepFree(double dt) noexcept {
  if (nodes_->awake_.empty()) return;
  if (uniform() && branch_.empty()) {
    prepare(materials_.front(), dt);
    return stepFreeUniform(materials_.front().step);
  }
  for (const uint32_t i : nodes_->awake_) {
    Nodes::Node& node = nodes_->nodes_[i];
    Material& material = materialOf(i);
    prepare(material, dt);
    const ViscoelasticStep& s = material.step;
    Vector4d x = s.xx * node.x + s.xv * node.v, v = s.vx * node.x + s.vv * node.v;
    if (!branch_.empty()) {
      Vector4d& y = branch_[i];
      x += s.xy * y;
      v += s.vy * y;
      y = s.yx * node.x + s.yv * node.v + s.yy * y;
    }
    node.x = x;
    node.v = v;
  }
}

void FeltSurface::stepFreeUniform(const ViscoelasticStep& step) noexcept {
  const double xx = step.xx, xv = step.xv, vx = step.vx, vv = step.vv;
  Nodes::Node* const nodes = nodes_->nodes_.data();
  for (const uint32_t i : nodes_->awake_) {
    Nodes::Node& node = nodes[i];
    const Vector4d moved = xx * node.x + xv * node.v;
    node.v = vx * node.x + vv * node.v;
    node.x = moved;
  }
}

/// Computes the forces of all contacts together. In each pass every contact reacts to the surface that the others have
/// left, until no force changes. This converges because the surface yields symmetrically, and at each contact more to
/// its own force than to another one.
void FeltSurface::solve(double dt, std::span<FeltContact> contacts) noexcept {
  Give gives;
  std::array<double, kMaxContacts> ahead;
  const std::size_t count = contacts.size();
  for (std::size_t i = 0; i < count; ++i) {
    contacts[i].mean = 0;
    ahead[i] = contacts[i].depth - shift(contacts[i].place);
    for (std::size_t j = 0; j <= i; ++j)
      gives[i][j] = gives[j][i] = complianceBetween(contacts[i].place, contacts[j].place, dt);
  }
  for (int sweep = 0; sweep < (count > 1 ? kMostSweeps : 1); ++sweep) {
    bool settled = true;
    for (std::size_t i = 0; i < count; ++i) {
      FeltContact& contact = contacts[i];
      double rest = ahead[i];
      for (std::size_t j = 0; j < count; ++j)
        if (j != i) rest -= gives[i][j] * contacts[j].mean;
      const double force = meanContactForce(contact.place.contact, contact.before, rest, gives[i][i]);
      settled &= std::fabs(force - contact.mean) <= kSettled + kSameForce * force;
      contact.mean = force;
      contact.inside = rest - gives[i][i] * force;
    }
    if (settled) break;
  }
  for (FeltContact& contact : contacts) push(contact);
}

void FeltSurface::push(const FeltContact& contact) noexcept {
  const FeltPlace& place = contact.place;
  if (!(contact.mean > 0)) return;
  const Vector4d pushed = place.scale * contact.mean * shares_.cwiseProduct(inwardOf(place.normal));
  Nodes::Node* const nodes = nodes_->nodes_.data();
  const bool uniform = this->uniform(), relaxes = !branch_.empty();
  const Vector4d to_x = materials_.front().step.xf * pushed, to_v = materials_.front().step.vf * pushed;
  for (std::size_t i = 0; i < place.count; ++i) {
    const PlaceNode& part = place.nodes[i];
    if (part.weight == 0) continue;
    wake(part.node);
    Nodes::Node& node = nodes[part.node];
    const double share = part.weight * compliance_[part.node];
    if (uniform) {
      node.x += share * to_x;
      node.v += share * to_v;
    } else {
      const ViscoelasticStep& s = materialOf(part.node).step;
      node.x += share * s.xf * pushed;
      node.v += share * s.vf * pushed;
    }
    if (relaxes) branch_[part.node] += share * materialOf(part.node).step.yf * pushed;
  }
}

/// Keeps nodes awake at a place that a probe touches, or nearly touches, however little they move: no node is put to
/// rest under a probe.
void FeltSurface::wakeContacts(std::span<const FeltContact> contacts) noexcept {
  for (const FeltContact& contact : contacts)
    if (contact.inside > -kNearby)
      for (std::size_t i = 0; i < contact.place.count; ++i) touched_[contact.place.nodes[i].node] = tick_;
}

/// Puts nodes to rest that no contact holds and whose motion nobody feels.
/// @return true if a node was put to rest
bool FeltSurface::trySleep() noexcept {
  bool some = false;
  std::vector<uint32_t>& awake = nodes_->awake_;
  for (std::size_t k = 0; k < awake.size();) {
    const uint32_t i = awake[k];
    Nodes::Node& node = nodes_->nodes_[i];
    double amplitude2 = node.x.squaredNorm() + materialOf(i).time_scale2 * node.v.squaredNorm();
    if (!branch_.empty()) amplitude2 += branch_[i].squaredNorm();
    if (touched_[i] == tick_ || amplitude2 > kAsleep * kAsleep) {
      ++k;
      continue;
    }
    node = Nodes::Node{};  // also if its displacement is NaN
    if (!branch_.empty()) branch_[i].setZero();
    nodes_->is_awake_[i] = 0;
    awake[k] = awake.back();
    awake.pop_back();
    some = true;
  }
  return some;
}

/// Returns the gradient of the displacement s(u, v, normal) over the position of the probe. The displacement changes
/// with the foot and with the direction from the foot to the probe.
Vector3d FeltSurface::slopeAt(const FeltPlace& place) const noexcept {
  Vector4d here = Vector4d::Zero(), along_u = Vector4d::Zero(), along_v = Vector4d::Zero();
  for (std::size_t i = 0; i < place.count; ++i) {
    const PlaceNode& part = place.nodes[i];
    const Vector4d& x = nodes_->nodes_[part.node].x;
    here += part.weight * x;
    along_u += part.weight_u * x;
    along_v += part.weight_v * x;
  }
  const Vector4d inward = inwardOf(place.normal);
  const Vector3d moved = here.head<3>();
  const double s = inward.dot(here);
  double su = inward.dot(along_u), sv = inward.dot(along_v);
  su += place.ripple[0] * s;
  sv += place.ripple[1] * s;
  const Vector3d aside = place.turn * (moved - moved.dot(place.normal) * place.normal);
  su += aside.dot(place.tangent_u);  // the foot follows only a part of the probe's motion; the rest turns the normal
  sv += aside.dot(place.tangent_v);
  const Vector3d slope = place.scale * (su * place.toward_u + sv * place.toward_v - aside);
  const double steepness = slope.norm();
  return steepness > kSteepestDent ? Vector3d(kSteepestDent / steepness * slope) : slope;
}

void FeltSurface::advance(double dt, std::span<FeltContact> contacts) noexcept {
  contacts = contacts.first(std::min(contacts.size(), static_cast<std::size_t>(kMaxContacts)));
  ++tick_;
  for (FeltContact& contact : contacts) {
    fit(contact.place);
    if (contact.placed)
      setDisplacement(contact.place, contact.depth * (1 - 1 / contactRatio()));
    else if (contact.fresh)
      setDisplacement(contact.place, std::min(contact.depth, 0.0));
    if (!contact.known || contact.placed) contact.before = contact.depth - shift(contact.place);
  }
  if (dt > 0) {
    if (dt >= settle_ && contacts.empty()) return reset();
    stepFree(dt);
    solve(dt, contacts);
  } else {
    for (FeltContact& contact : contacts) contact.inside = contact.depth - shift(contact.place);
  }
  wakeContacts(contacts);
  const bool changed = tick_ % kLooksForSleep == 0 && trySleep();
  for (FeltContact& contact : contacts) {
    if (changed && contact.inside <= -kNearby) contact.inside = contact.depth - shift(contact.place);
    contact.force = contact.place.contact * std::max(0.0, contact.inside);
    contact.slope = contact.force > 0 ? slopeAt(contact.place) : Vector3d(Vector3d::Zero());
  }
}

void FeltSurface::reset() noexcept {
  if (!branch_.empty())
    for (const uint32_t i : nodes_->awake_) branch_[i].setZero();
  nodes_->clear();
  std::fill(touched_.begin(), touched_.end(), 0);  // the search for sleepers begins anew
  tick_ = 0;
}

double FeltSurface::energy(std::span<const FeltContact> contacts) const noexcept {
  double sum = 0;
  for (const FeltContact& contact : contacts)
    sum += 0.5 * contact.place.contact * std::pow(std::max(0.0, contact.inside), 2);
  const Vector4d twice = uniform() && branch_.empty() ? twiceEnergyAlike() : twiceEnergy();
  for (Eigen::Index k = 0; k < 4; ++k) sum += shares_[k] > 0 ? 0.5 * twice[k] / shares_[k] : 0;
  return sum;
}

/// Returns twice the energy of the nodes for each component of the displacement, not yet divided by the shares_.
Vector4d FeltSurface::twiceEnergy() const noexcept {
  Vector4d twice = Vector4d::Zero();
  for (const uint32_t i : nodes_->awake_) {
    if (!(compliance_[i] > 0)) continue;
    const Nodes::Node& node = nodes_->nodes_[i];
    const SurfaceElement& e = materialOf(i).damped;
    const double share = 1 / compliance_[i];
    twice += share * e.stiffness * node.x.cwiseAbs2() + share * e.mass * node.v.cwiseAbs2();
    if (!branch_.empty()) twice += share * e.branch * (node.x - branch_[i]).cwiseAbs2();
  }
  return twice;
}

Vector4d FeltSurface::twiceEnergyAlike() const noexcept {
  const Nodes::Node* const nodes = nodes_->nodes_.data();
  Vector4d x2 = Vector4d::Zero(), v2 = Vector4d::Zero();
  for (const uint32_t i : nodes_->awake_) {
    if (!(compliance_[i] > 0)) continue;
    const double share = 1 / compliance_[i];
    x2 += share * nodes[i].x.cwiseAbs2();
    v2 += share * nodes[i].v.cwiseAbs2();
  }
  const SurfaceElement& e = materials_.front().damped;
  return e.stiffness * x2 + e.mass * v2;
}

std::size_t FeltSurface::bytes() const noexcept {
  return sizeof *this + materials_.capacity() * sizeof(Material) + which_.capacity() * sizeof(uint16_t) +
         compliance_.capacity() * sizeof(double) + branch_.capacity() * sizeof(Vector4d) +
         touched_.capacity() * sizeof(uint32_t);
}

}  // namespace hapticd::medial
