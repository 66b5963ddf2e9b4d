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

}  // namespace

hsp_status MatDeformable::stepFelt(const hsp_step& step) noexcept HSP_RT {
  met_.clear();
  stored_ = 0;
  hsp_status worst = HSP_OK;
  for (uint32_t i = 0; i < step.count; ++i) {
    const hsp_status status = addContact(*HSP_AT(const hsp_probe, step.in, step.in_stride, i), step, i,
                                         *HSP_AT(hsp_contact, step.out, step.out_stride, i));
    if (status < 0 || (status > 0 && worst == HSP_OK)) worst = worst < 0 ? worst : status;
  }
  body_->feltSurface()->advance(elapsed(step), {contacts_.data(), met_.size()});
  for (std::size_t k = 0; k < met_.size(); ++k) {
    const uint32_t i = met_[k].probe;
    answer(*HSP_AT(const hsp_probe, step.in, step.in_stride, i), contacts_[k], met_[k].felt, tracks_[i],
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
    met_.push_back({index, located.surface});  // has room for all probes
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
    push(probe, located.surface, track, contact);
  } else {  // no contact: the surface here is at rest
    track.inside = depth;
    track.counted = true;
    track.friction.reset();
  }
  track.met = true;
  track.near = near;
  return located.status;
}

/// Writes the result for a probe: the force in the direction of a held press at this place, plus a part along the slope
/// of the dent.
void MatDeformable::answer(const hsp_probe& probe, const medial::FeltContact& met, const Felt& felt, Track& track,
                           hsp_contact& contact) noexcept HSP_RT {
  track.inside = met.inside;
  track.counted = true;
  if (!(met.force > 0)) return track.friction.reset();
  const Vector3d p(probe.position), velocity(probe.velocity);
  const double deep = std::max(felt.depth, kShallow);
  const medial::BodyForce held = body_->press(p, track.foot, {felt.normal, deep}, 0);
  const double unit = met.force / (met.place.stiffness * deep);
  const Vector3d force = felt.steep * unit * held.force + met.force * met.slope;
  const double normal = std::max(0.0, force.dot(felt.normal));
  const contact::FrictionLaw law{std::max(friction_static_, friction_dynamic_), friction_dynamic_, held.stiffness,
                                 viscosity_};
  const Vector3d rub = track.friction.step(law, p + felt.depth * felt.normal, felt.normal, normal, velocity);
  Eigen::Map<Vector3d>(contact.force) = force + rub;
  contact.stiffness = met.place.contact;
  stored_ += track.friction.energy(law);
}

}  // namespace hapticd
