// SPDX-License-Identifier: MIT
#include "mat_deformable.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "crease.hpp"
#include "medial_file.hpp"
#include "state.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;
using medial::SkeletonFoot;

constexpr double kShowPeriod = 1.0 / 60;  ///< [s] time between two sets of displacements for drawing
constexpr double kFinestMesh = 1e-6;      ///< [m] least chord error of a mesh for drawing
/// if more ticks than this have passed since the last step, no probe was near in the meantime
constexpr double kGapFactor = 1.5;
/// A foot has jumped to another part of the skeleton if its centre moves farther in one tick than kHop times the radius
/// of its sphere plus kSweep times the path of the probe in that tick. On the inside of a bend, a foot moves farther
/// than the probe.
constexpr double kHop = 0.2, kSweep = 4;

bool hasHopped(const SkeletonFoot& foot, const Vector3d& center, const Vector3d& moved) noexcept {
  return (foot.center - center).norm() > kHop * foot.radius + kSweep * moved.norm();
}

/// Writes a foot and the surface that is felt there to the contact record for the host.
void writeContact(const SkeletonFoot& foot, const Felt& surface, hsp_contact& contact) noexcept HSP_RT {
  Eigen::Map<Vector3d>(contact.point) = foot.center + foot.radius * surface.normal;
  Eigen::Map<Vector3d>(contact.normal) = surface.normal;
  contact.depth_m = surface.depth;
  contact.feature = foot.element;
  contact.param[0] = foot.u;
  contact.param[1] = foot.v;
  contact.residual_m = foot.residual;
  contact.iterations = static_cast<uint32_t>(foot.evaluations);
  contact.flags = HSP_OUT_TRACED;
  if (foot.rim) contact.flags |= HSP_OUT_EDGE;
  if (surface.depth > 0) contact.flags |= HSP_OUT_CONTACT;
}

}  // namespace

MatDeformable::Dynamics MatDeformable::dynamicsOf(const MedialFile& file) const {
  int chosen = dynamics_;
  if (chosen == kAsFile) chosen = file.revision >= 2 ? kAuto : kSeen;
  if (chosen == kAuto) chosen = file.swings || file.damps || relaxation_share_ > 0 ? kFelt : kOff;
  return chosen == kOn ? kSeen : static_cast<Dynamics>(chosen);
}

medial::BodyOptions MatDeformable::bodyOptions(const MedialFile& file, double rate_hz) const {
  const Dynamics dynamics = dynamicsOf(file);
  medial::BodyOptions options;
  options.degree = degree_;
  options.form = evaluation_ == 0 ? spline::Form::kTable : spline::Form::kNet;
  options.shear_distance = shear_distance_;
  options.shear_offset = shear_distance_ > 0 || file.revision >= 2 ? 0 : shear_offset_;
  options.envelope = envelope_ == 0 ? medial::Envelope::kExact : medial::Envelope::kFoot;
  options.damping_scale = damping_scale_;
  options.deformation.split = split_;
  options.deformation.influence = {static_cast<int>(influence_[0]), static_cast<int>(influence_[1])};
  options.deformation.rings = rings_;
  options.deformation.dynamics = dynamics == kSeen;
  options.felt.on = dynamics == kFelt;
  options.felt.contact_ratio = contact_ratio_;
  options.felt.relaxation_share = relaxation_share_;
  options.felt.relaxation_time = relaxation_time_;
  if (rate_hz > 0) options.felt.tick = 1 / rate_hz;
  return options;
}

void MatDeformable::openBody(const MedialFile& file, double rate) {
  try {
    const medial::BodyOptions options = bodyOptions(file, rate);
    const auto make = [&options](const MedialFile& one) {
      return one.grid ? makeSoftBody(*one.grid, options) : makeSoftBody(*one.mesh, options);
    };
    drawn_body_ = tip_radius_ > 0 ? make(file) : nullptr;
    body_ = tip_radius_ > 0 ? make(grownBy(tip_radius_, file)) : make(file);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(geometry_ + ": medial: " + e.what());
  }
}

void MatDeformable::openContacts(uint32_t probes) {
  tracks_.assign(probes, Track{});
  presses_.clear();
  presses_.reserve(probes);
  contacts_.clear();
  met_.clear();
  if (body_->feltSurface() == nullptr) return;
  contacts_.resize(std::min<std::size_t>(probes, medial::kMaxContacts));
  met_.reserve(probes);
  beside_ = std::make_unique<medial::FeltPlace>();
}

std::size_t MatDeformable::openVolume() {
  keeper_.reset();
  if (volume_ != 1) return 0;
  auto hull = drawn().hull();
  const medial::VolumeKeeper volume(*hull, drawn().greatestRadius());
  const std::size_t bytes = hull->bytes() + volume.bytes();
  keeper_.reset(new VolumeControl{std::move(hull), volume});
  return bytes;
}

uint32_t MatDeformable::openDisplay() {
  last_time_ns_ = 0;
  stored_ = since_shown_ = 0;
  shown_at_rest_ = true;
  displaced_ = std::make_unique<DisplacementBuffer>(body_->nodes().count());
  display_.reset();
  frames_.reset();
  if (display_tolerance_ <= 0) return 0;
  frames_ = std::make_unique<Frames>(drawn().contour(displayed()), body_->nodes().count());
  return static_cast<uint32_t>(frames_->contour().vertexCount());
}

void MatDeformable::activate(const hsp_activation& activation, hsp_report& report) {
  const MedialFile file = readFile();
  const uint32_t probes = std::max(activation.max_probes, 1u);
  openBody(file, activation.rate_hz);
  openContacts(probes);
  if (const uint32_t vertices = openDisplay(); vertices > 0) report.viz_vertices = vertices;
  const std::size_t volume_bytes = openVolume();
  const medial::FeltSurface* const surface = body_->feltSurface();
  const std::vector<unsigned char> loaded = std::exchange(states_->loaded, {});
  if (!loaded.empty() && !restoreState(loaded, body_->nodes(), body_->feltSurface()))
    throw std::invalid_argument(geometry_ + ": the saved state that was loaded belongs to another body");
  openAccount();
  if (viscosity_ > 0 || (surface == nullptr && (file.swings || file.damps))) report.flags |= HSP_R_VELOCITY;
  report.max_stiffness = body_->greatestStiffness() * (surface != nullptr ? surface->contactRatio() : 1);
  // A felt surface can push a hand that does not move: the surface swings back, or another hand lets go of it.
  if (surface != nullptr) reportJumps(report, report.max_stiffness * kDeepPress);
  report.size_m = body_->bounds().diagonal().norm();
  report.locked_bytes = body_->bytes() + displaced_->bytes() + volume_bytes + probes * sizeof(Track) + sizeof *this +
                        (frames_ ? frames_->bytes() : 0);
  describe(file, activation.rate_hz > 0 ? 1 / activation.rate_hz : medial::FeltOptions{}.tick);
}

void MatDeformable::openAccount() {
  const medial::FeltSurface* const surface = body_->feltSurface();
  account_ = {};
  if (surface != nullptr) account_.add(surface->energy({}));
}

void MatDeformable::deactivate() {
  if (body_) states_->kept = stateOf(body_->nodes(), body_->feltSurface());
  tracks_.clear();
  display_.reset();
  frames_.reset();
  keeper_.reset();
  displaced_.reset();
  body_.reset();
  drawn_body_.reset();
}

void MatDeformable::reset() noexcept HSP_RT {
  for (Track& track : tracks_) {
    const bool active = track.active;
    track = Track{};
    track.active = active;
  }
  body_->nodes().reset();
  if (medial::FeltSurface* const surface = body_->feltSurface(); surface != nullptr) surface->reset();
  if (keeper_) keeper_->volume.reset();
  stored_ = 0;
  account_ = {};
  shown_at_rest_ = false;
}

/// Returns the time since the last step. While no probe was near, the body was not stepped; it catches up when a probe
/// comes back.
double MatDeformable::elapsed(const hsp_step& step) noexcept HSP_RT {
  if (step.count == 0) return step.dt_s;
  const uint64_t now = step.in->time_ns, before = last_time_ns_;
  last_time_ns_ = now;
  if (before == 0 || now <= before || !(step.dt_s > 0)) return step.dt_s;
  const double gap = 1e-9 * static_cast<double>(now - before);
  return gap > kGapFactor * step.dt_s ? gap : step.dt_s;
}

hsp_status MatDeformable::step(const hsp_step& step) noexcept HSP_RT {
  if (body_->feltSurface() != nullptr) return stepFelt(step);
  body_->nodes().advance(elapsed(step));
  presses_.clear();
  stored_ = 0;
  const hsp_status worst = touchEach(
      step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t i) { return touch(probe, step, i, contact); });
  body_->yield(presses_);
  if (keeper_) keeper_->volume.step(body_->nodes());
  show(step);
  return worst;
}

double MatDeformable::energy() const noexcept HSP_RT {
  const medial::FeltSurface* const surface = body_->feltSurface();
  if (surface == nullptr) return stored_ + body_->nodes().energy();
  return stored_ + std::min(surface->energy({contacts_.data(), met_.size()}), account_.held());
}

/// Publishes displacements for drawing: 60 times a second while the body moves, and once when it has come to rest.
void MatDeformable::show(const hsp_step& step) noexcept HSP_RT {
  const medial::Nodes& moved = body_->nodes();
  if (frames_) frames_->step(moved, step.viz_xyz, step.viz_capacity);
  since_shown_ += step.dt_s;
  const bool at_rest = moved.awake() == 0;
  if (since_shown_ < kShowPeriod || (at_rest && shown_at_rest_)) return;
  displaced_->publish(moved);
  since_shown_ = 0;
  shown_at_rest_ = at_rest;
}

double MatDeformable::displayed() const {
  return std::max(display_tolerance_, kFinestMesh);
}

hsp_status MatDeformable::mesh(double chord_error, hsp_mesh& out) {
  if (!body_) return HSP_E_STATE;
  if (chord_error == 0 && frames_) chord_error = displayed();  // the mesh whose vertices the steps write
  if (!(chord_error > 0)) return HSP_E_ARG;
  if (!display_) display_ = std::make_unique<Display>();
  display_->show(drawn(), *displaced_, std::max(chord_error, kFinestMesh), out);
  return HSP_OK;
}

FindOptions MatDeformable::searchOptions() const noexcept {
  FindOptions options;
  options.newton.envelope = envelope_ == 0 ? medial::Envelope::kExact : medial::Envelope::kFoot;
  options.newton.tolerance = tolerance_;
  options.binary = search_ == 1;
  options.halvings = depth_;
  options.crease = crease_;
  return options;
}

FindOptions MatDeformable::findOptions(const hsp_step& step) const noexcept HSP_RT {
  FindOptions options = searchOptions();
  if (step.tolerance_m > 0) options.newton.tolerance = step.tolerance_m;
  if (step.max_iterations > 0)
    options.newton.max_evaluations =
        static_cast<int>(std::min<uint32_t>(step.max_iterations, options.newton.max_evaluations));
  return options;
}

MatDeformable::LocatedSurface MatDeformable::locate(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                                                    hsp_contact& contact) noexcept HSP_RT {
  if (index >= tracks_.size()) return {HSP_E_ARG, false, {}, {}};
  Track& track = tracks_[index];
  const Vector3d p(probe.position);
  if (!track.active || (probe.flags & HSP_IN_INVALID) != 0 || !p.allFinite()) {
    track.friction.reset();
    track.counted = false;
    track.missed = true;
    track.forgetPress();
    const bool said = !track.active || (probe.flags & HSP_IN_INVALID) != 0;
    return {said ? HSP_OK : HSP_E_NUMERIC, false, {}, {}};
  }
  const bool jumped = (probe.flags & HSP_IN_JUMP) != 0;
  const bool missed = std::exchange(track.missed, false), put = jumped || missed;  // nobody knows how it came here
  if (jumped) {
    track.side = 0;
    track.pushed.setZero();
    track.forgetPress();
  }
  const Vector3d moved = track.known ? Vector3d(p - track.last) : Vector3d(Vector3d::Zero());
  const Vector3d center = track.foot.center, rival = track.rival.center;
  const bool followed = track.known, two = followed && track.apart > 0;
  body_->find(p, probe.flags, findOptions(step), track);
  track.swapped = two && (track.foot.center - rival).squaredNorm() < (track.foot.center - center).squaredNorm();
  track.hopped = followed && !track.swapped && hasHopped(track.foot, center, moved);
  track.offered = false;
  track.known = true;
  track.last = p;
  const SkeletonFoot& foot = track.foot;
  const Felt surface = feltInCrease(body_->felt(p, moved, track), track, crease_);
  writeContact(foot, surface, contact);
  return {foot.converged ? HSP_OK : HSP_DEGRADED, true, surface, put ? Vector3d(Vector3d::Zero()) : moved};
}

int64_t MatDeformable::nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const {
  const Vector3d p(p_model);
  if (!p.allFinite() || body_->bounds().exteriorDistance(p) > radius) return 0;
  FindOptions options = searchOptions();
  options.newton.tolerance = medial::NewtonOptions{}.tolerance;
  const SkeletonFoot foot = body_->search(p, options);
  const double distance = std::max(0.0, -foot.depth);
  if (distance > radius) return 0;
  if (cap > 0) out[0] = {0, 0, {foot.u, foot.v}, distance};
  return 1;
}

hsp_status MatDeformable::start(const hsp_near& near) noexcept HSP_RT {
  if (near.probe >= tracks_.size() || near.surface != 0) return HSP_E_ARG;
  Track& track = tracks_[near.probe];
  if (!track.active) track.known = track.met = false;
  track.active = track.offered = true;
  track.offer = {near.param[0], near.param[1]};
  return HSP_OK;
}

hsp_status MatDeformable::stop(uint32_t probe) noexcept HSP_RT {
  if (probe >= tracks_.size()) return HSP_E_ARG;
  tracks_[probe] = Track{};
  return HSP_OK;
}

/// Writes the state of the body: before activation the loaded state, after deactivation the last one.
int64_t MatDeformable::save(void* buffer, uint64_t capacity) const {
  const std::vector<unsigned char> state = body_                     ? stateOf(body_->nodes(), body_->feltSurface())
                                           : states_->loaded.empty() ? states_->kept
                                                                     : states_->loaded;
  if (buffer != nullptr && state.size() <= capacity)
    std::copy(state.begin(), state.end(), static_cast<unsigned char*>(buffer));
  return static_cast<int64_t>(state.size());
}

/// Stores the bytes of a state. activate() checks that they belong to this body, because only then the body is known.
hsp_status MatDeformable::load(const void* buffer, uint64_t length) {
  if (body_) return HSP_E_STATE;
  const auto* bytes = static_cast<const unsigned char*>(buffer);
  if (!isState({bytes, static_cast<std::size_t>(length)})) return HSP_E_ARG;
  states_->loaded.assign(bytes, bytes + length);
  return HSP_OK;
}

const void* MatDeformable::surfacesExtension() {
  static constexpr hsp_ext_surfaces kExtension = {
      sizeof(hsp_ext_surfaces), 1,
      [](const hsp_shape* shape, const double p_model[3], double radius, hsp_near* out, uint64_t cap) -> int64_t {
        return reinterpret_cast<const MatDeformable*>(shape)->nearby(p_model, radius, out, cap);
      },
      [](hsp_shape* shape, const hsp_near* near)
          HSP_RT -> hsp_status { return reinterpret_cast<MatDeformable*>(shape)->start(*near); },
      [](hsp_shape* shape, uint32_t probe, uint32_t)
          HSP_RT -> hsp_status { return reinterpret_cast<MatDeformable*>(shape)->stop(probe); }};
  return &kExtension;
}

const void* MatDeformable::geometryExtension() {
  static constexpr hsp_ext_geometry kExtension = {
      sizeof(hsp_ext_geometry), 0,
      [](hsp_shape* shape, double chord_error, hsp_mesh* out) -> hsp_status {
        return reinterpret_cast<MatDeformable*>(shape)->mesh(chord_error, *out);
      },
      [](hsp_shape* shape, double min[3], double max[3]) -> hsp_status {
        const auto& body = reinterpret_cast<MatDeformable*>(shape)->body_;
        if (!body) return HSP_E_STATE;
        Eigen::Map<Vector3d>(min, 3) = body->bounds().min();
        Eigen::Map<Vector3d>(max, 3) = body->bounds().max();
        return HSP_OK;
      }};
  return &kExtension;
}

const void* MatDeformable::energyExtension() {
  static constexpr hsp_ext_energy kExtension = {sizeof(hsp_ext_energy), 0, [](hsp_shape* shape) HSP_RT -> double {
                                                  const MatDeformable& body = *reinterpret_cast<MatDeformable*>(shape);
                                                  return body.energy();
                                                }};
  return &kExtension;
}

const void* MatDeformable::stateExtension() {
  static constexpr hsp_ext_state kExtension = {sizeof(hsp_ext_state), 0,
                                               [](hsp_shape* shape, void* buffer, uint64_t capacity) -> int64_t {
                                                 return reinterpret_cast<MatDeformable*>(shape)->save(buffer, capacity);
                                               },
                                               [](hsp_shape* shape, const void* buffer, uint64_t length) -> hsp_status {
                                                 return reinterpret_cast<MatDeformable*>(shape)->load(buffer, length);
                                               }};
  return &kExtension;
}

const void* MatDeformable::extension(const char* name) {
  const std::string_view wanted = name;
  if (wanted == HSP_EXT_SURFACES && body_) return surfacesExtension();
  if (wanted == HSP_EXT_GEOMETRY && body_) return geometryExtension();
  if (wanted == HSP_EXT_ENERGY) return energyExtension();
  if (wanted == HSP_EXT_STATE) return stateExtension();
  return nullptr;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::MatDeformable)
