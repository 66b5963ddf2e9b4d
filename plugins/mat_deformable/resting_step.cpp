// SPDX-License-Identifier: MIT
/// A step of a body whose dynamics are not felt: each probe feels the body at rest.
#include <algorithm>

#include "mat_deformable.hpp"

namespace hapticd {

using Eigen::Vector3d;

hsp_status MatDeformable::touch(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                                hsp_contact& contact) noexcept HSP_RT {
  const LocatedSurface located = locate(probe, step, index, contact);
  if (!located.found) return located.status;
  if (located.surface.depth > 0) {
    push(probe, located, tracks_[index], contact);
  } else {
    tracks_[index].friction.reset();
    tracks_[index].pressed = false;
  }
  return located.status;
}

void MatDeformable::push(const hsp_probe& probe, const LocatedSurface& located, Track& track,
                         hsp_contact& contact) noexcept HSP_RT {
  const Vector3d p(probe.position), velocity(probe.velocity);
  const Felt& felt = located.surface;
  const double closing = -velocity.dot(felt.normal);
  medial::BodyForce whole = body_->press(p, track.foot, felt, closing);
  for (Vector3d* part : {&whole.force, &whole.elastic}) *part *= felt.steep;  // the slope of the energy in a valley
  whole.normal *= felt.steep;
  const medial::BodyForce answer = whole.weakened(restingShare(whole, located.moved, track), felt.normal);
  track.exerted = answer.force;
  const contact::FrictionLaw law{std::max(friction_static_, friction_dynamic_), friction_dynamic_, answer.stiffness,
                                 viscosity_};
  const Vector3d surface = p + felt.depth * felt.normal;
  const Vector3d rub = track.friction.step(law, surface, felt.normal, answer.normal, velocity);
  Eigen::Map<Vector3d>(contact.force) = answer.force + rub;
  contact.stiffness = answer.stiffness;
  stored_ += std::min(answer.energy, track.account.held()) + track.friction.energy(law);
  presses_.push_back(  // has room for all probes
      {track.foot.u, track.foot.v, felt.normal, felt.depth, closing, track.foot.element});
}

/// Returns the share of the springs' force that a probe on a body at rest feels, see EnergyAccount. What a damper takes
/// may be given back too: the account is that of the whole force.
double MatDeformable::restingShare(const medial::BodyForce& whole, const Vector3d& moved,
                                   Track& track) noexcept HSP_RT {
  double work = 0;
  if (track.pressed) {
    const Vector3d drag = whole.force - whole.elastic;
    track.account.add(-0.5 * (track.exerted + drag).dot(moved));
    work = -0.5 * whole.elastic.dot(moved);
  } else {
    track.account = {};
    track.account.add(firstWork(whole.elastic, moved, whole.energy));
  }
  track.pressed = true;
  return track.account.share(work, whole.energy);
}

}  // namespace hapticd
