// SPDX-License-Identifier: MIT
/// A step of a body whose surface is felt: first all probes are located on the present surface, then the surface moves
/// under all of them at once.
#include <algorithm>

#include "crease.hpp"
#include "mat_deformable.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;

/// [m] greatest distance outside the contour at rest at which a swinging surface may meet a probe
constexpr double kSwingsOut = 5e-3;
constexpr double kShallow = 1e-6;  ///< [m] least depth of the held press from which the direction of the force is taken

/// Returns half the work [J] of a hand that left the surface in this tick: on the way to the surface, not beyond.
double lastWork(const Track& track, const Vector3d& moved) noexcept {
  return std::max(-0.5 * track.exerted.dot(moved), -0.5 * track.exerted.norm() * std::max(0.0, track.inside));
}

}  // namespace

hsp_status MatDeformable::stepFelt(const hsp_step& step) noexcept HSP_RT {
  met_.clear();
  stored_ = 0;
  const hsp_status worst = touchEach(step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t i) {
    return addContact(probe, step, i, contact);
  });
  const std::span<medial::FeltContact> contacts(contacts_.data(), met_.size());
  body_->feltSurface()->advance(elapsed(step), contacts);
  for (std::size_t k = 0; k < met_.size(); ++k) {
    const hsp_probe& probe = *HSP_AT(const hsp_probe, step.in, step.in_stride, met_[k].probe);
    met_[k].force = feltForce(probe, contacts[k], met_[k].felt, tracks_[met_[k].probe]);
  }
  const double share = feltShare(step.dt_s);
  for (std::size_t k = 0; k < met_.size(); ++k) {
    const uint32_t i = met_[k].probe;
    answer(*HSP_AT(const hsp_probe, step.in, step.in_stride, i), contacts[k], met_[k].felt,
           met_[k].force.weakened(share, met_[k].felt.normal), tracks_[i],
           *HSP_AT(hsp_contact, step.out, step.out_stride, i));
  }
  if (keeper_) keeper_->volume.step(body_->nodes());
  show(step);
  return worst;
}

/// Finds the surface at a probe, and records a contact if the two may touch.
hsp_status MatDeformable::addContact(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                                     hsp_contact& contact) noexcept HSP_RT {
  const LocatedSurface located = locate(probe, step, index, contact);
  if (!located.found) {
    if (index < tracks_.size()) tracks_[index].near = false;
    return located.status;
  }
  Track& track = tracks_[index];
  const double depth = located.surface.depth;
  const bool near = depth > 0 || (body_->nodes().awake() > 0 && depth > -kSwingsOut);
  if (near && met_.size() < contacts_.size()) {
    medial::FeltContact& met = contacts_[met_.size()];
    met_.push_back({index, located.surface, located.moved, {}});  // has room for all probes
    met.depth = depth;
    met.before = track.inside;
    met.known = track.counted;
    met.placed = !track.met || track.hopped;
    met.fresh = !track.near;
    const medial::Envelope envelope = searchOptions().newton.envelope;
    body_->placeOf(Vector3d(probe.position), track.foot, located.surface, envelope, met.place);
    if (located.surface.share > 0) {
      body_->placeOf(Vector3d(probe.position), track.rival, located.surface, envelope, *beside_);
      mixPlaces(*beside_, 0.5 * located.surface.share, met.place);
    }
  } else if (depth > 0) {  // too many probes for one surface: this one feels the body at rest
    push(probe, located, step, track, contact);
  } else {  // no contact: the surface here is at rest
    account_.add(lastWork(track, located.moved));
    track.exerted.setZero();
    track.pressed = false;
    track.inside = depth;
    track.counted = true;
    track.friction.reset();
  }
  track.met = true;
  track.near = near;
  return located.status;
}

/// Returns the force on a probe: that of a held press at this place, at the present force of the surface, plus a part
/// along the slope of the dent.
medial::BodyForce MatDeformable::feltForce(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt,
                                           const Track& track) noexcept HSP_RT {
  if (!(met.force > 0)) return {};
  const double deep = std::max(felt.depth, kShallow);
  medial::BodyForce force = body_->press(Vector3d(probe.position), track.foot, {felt.normal, deep}, 0);
  const double normal_spring = met.place.stiffness * deep;
  force.force = felt.steep * met.force / normal_spring * force.force + met.force * met.slope;
  force.elastic = force.force;
  force.normal = std::max(0.0, force.force.dot(felt.normal));
  force.energy /= 0.5 * normal_spring * deep;
  return force;
}

/// Returns the share of the force that the probes feel, see EnergyAccount. All probes have one account, because one
/// hand may get what another one has put into the surface.
double MatDeformable::feltShare(double dt) noexcept HSP_RT {
  double work = 0, energy = 0;
  bool touched = false;
  for (std::size_t k = 0; k < met_.size(); ++k) {
    const medial::FeltContact& contact = contacts_[k];
    const Track& track = tracks_[met_[k].probe];
    const Vector3d& moved = met_[k].moved;
    if (!(contact.force > 0)) {
      account_.add(lastWork(track, moved));
      continue;
    }
    // of springs in balance; those of shear_offset make the surface stiffer than it is
    const double stored = 0.5 * contact.force * contact.depth * met_[k].force.energy;
    const Vector3d& force = met_[k].force.elastic;
    account_.add(track.pressed ? -0.5 * track.exerted.dot(moved) : firstWork(force, moved, stored));
    if (track.pressed) work -= 0.5 * force.dot(moved);
    energy += stored;
    touched = true;
  }
  if (!touched && account_.held() != 0) account_.keep(body_->feltSurface()->energy({contacts_.data(), met_.size()}));
  return touched ? account_.share(work, energy, dt) : 1;
}

/// Writes the result for a probe.
void MatDeformable::answer(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt,
                           const medial::BodyForce& force, Track& track, hsp_contact& contact) noexcept HSP_RT {
  track.inside = met.inside;
  track.counted = true;
  track.exerted = force.elastic;
  track.pressed = met.force > 0;
  if (!track.pressed) return track.friction.reset();
  const Vector3d p(probe.position), velocity(probe.velocity);
  const contact::FrictionLaw law{std::max(friction_static_, friction_dynamic_), friction_dynamic_, force.stiffness,
                                 viscosity_};
  const Vector3d rub = track.friction.step(law, p + felt.depth * felt.normal, felt.normal, force.normal, velocity);
  Eigen::Map<Vector3d>(contact.force) = force.force + rub;
  contact.stiffness = met.place.contact;
  stored_ += track.friction.energy(law);
}

}  // namespace hapticd
