#include "mat_deformable.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "medial_file.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;
using medial::SkeletonFoot;

constexpr double kNewPlace = 0.25;     ///< a probe that moved by this share of a cell is looked for all over the body
constexpr double kWithinReach = 0.02;  ///< [m] farther bodies wait for the search of the simulation side
constexpr double kOtherFoot = 0.02;    ///< difference of parameters from which an offered foot is another one
constexpr double kShowPeriod = 1.0 / 60;  ///< [s] between two sets of displacements for drawing
constexpr double kFinestMesh = 1e-6;      ///< [m] finer meshes are for files, not for drawing
constexpr double kGapFactor = 1.5;        ///< so many ticks without a step: the body was left alone meanwhile

}  // namespace

medial::BodyOptions MatDeformable::bodyOptions() const {
  medial::BodyOptions options;
  options.degree = degree_;
  options.form = evaluation_ == 0 ? spline::Form::kTable : spline::Form::kNet;
  options.shear_offset = shear_offset_;
  options.damping_scale = damping_scale_;
  options.deformation.split = split_;
  options.deformation.influence = {static_cast<int>(influence_[0]), static_cast<int>(influence_[1])};
  options.deformation.dynamics = dynamics_ == 1;
  return options;
}

void MatDeformable::activate(const hsp_activation& activation, hsp_report& report) {
  const medial::BodyData data = readMedialFile(geometry_);
  try {
    body_ = std::make_unique<medial::Body>(data, bodyOptions());
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(geometry_ + ": medial: " + e.what());
  }
  const uint32_t probes = std::max(activation.max_probes, 1u);
  tracks_.assign(probes, Track{});
  presses_.clear();
  presses_.reserve(probes);
  last_time_ns_ = 0;
  stored_ = since_shown_ = 0;
  shown_at_rest_ = true;
  displaced_ = std::make_unique<Displaced>(body_->deformation().controlPoints());
  display_ = Display{};
  contour_.reset();
  if (display_tolerance_ > 0) {
    contour_ = std::make_unique<medial::Contour>(body_->skeleton(), std::max(display_tolerance_, kFinestMesh));
    report.viz_vertices = static_cast<uint32_t>(contour_->vertexCount());
  }
  const auto positive = [](double x) { return x > 0; };
  const bool swings = dynamics_ == 1 && std::any_of(data.mass.begin(), data.mass.end(), positive);
  const bool damps = std::any_of(data.damping.begin(), data.damping.end(), positive);
  if (swings || damps || viscosity_ > 0) report.flags |= HSP_R_VELOCITY;
  report.max_stiffness = body_->greatestStiffness();
  report.size_m = body_->skeleton().bounds().diagonal().norm();
  report.locked_bytes = body_->bytes() + displaced_->bytes() + probes * sizeof(Track) + sizeof *this;
  describe();
}

/// What a person should know of a body before they touch it.
void MatDeformable::describe() const {
  if (host() == nullptr || host()->log == nullptr) return;
  const medial::MonotonicityReport check = body_->checkMonotonicity();
  char text[512];
  if (check.holds()) {
    std::snprintf(text, sizeof text,
                  "%zu control points, asleep until touched; shear springs: force grows with every depth (least slope "
                  "%.0f %% of the normal spring's)",
                  body_->deformation().controlPoints(), 100 * check.slope);
  } else {
    std::snprintf(text, sizeof text,
                  "%s: near u = %.3g, v = %.3g the shear springs may pull inward: rest length over least length is "
                  "%.3g, expected below %.3g; use a smaller shear_offset, or 0",
                  geometry_.c_str(), check.u, check.v, check.ratio, check.limit);
  }
  host()->log(host(), check.holds() ? HSP_LOG_INFO : HSP_LOG_WARNING, text);
}

void MatDeformable::deactivate() {
  tracks_.clear();
  display_ = Display{};
  contour_.reset();
  displaced_.reset();
  body_.reset();
}

void MatDeformable::reset() noexcept HSP_RT {
  for (Track& track : tracks_) {
    track.known = track.offered = false;
    track.side = 0;
    track.friction.reset();
  }
  body_->deformation().reset();
  stored_ = 0;
  shown_at_rest_ = false;
}

/// Time since the last step. A body that no probe was near to has not been stepped: it catches up when one comes back.
double MatDeformable::elapsed(const hsp_step& step) noexcept HSP_RT {
  if (step.count == 0) return step.dt_s;
  const uint64_t now = step.in->time_ns, before = last_time_ns_;
  last_time_ns_ = now;
  if (before == 0 || now <= before || !(step.dt_s > 0)) return step.dt_s;
  const double gap = 1e-9 * static_cast<double>(now - before);
  return gap > kGapFactor * step.dt_s ? gap : step.dt_s;
}

hsp_status MatDeformable::step(const hsp_step& step) noexcept HSP_RT {
  body_->deformation().advance(elapsed(step));
  presses_.clear();
  stored_ = 0;
  hsp_status worst = HSP_OK;
  for (uint32_t i = 0; i < step.count; ++i) {
    const hsp_status status = touch(*HSP_AT(const hsp_probe, step.in, step.in_stride, i), step, i,
                                    *HSP_AT(hsp_contact, step.out, step.out_stride, i));
    if (status < 0 || (status > 0 && worst == HSP_OK)) worst = worst < 0 ? worst : status;
  }
  body_->deformation().press(presses_);
  show(step);
  return worst;
}

/// Leaves displacements for drawing 60 times a second while the body moves, and once when it has come to rest.
void MatDeformable::show(const hsp_step& step) noexcept HSP_RT {
  const medial::Deformation& moved = body_->deformation();
  if (contour_ && step.viz_xyz != nullptr)
    contour_->write([&moved](std::size_t i) -> Eigen::Vector4f { return moved.displacement(i).cast<float>(); },
                    step.viz_xyz, step.viz_capacity);
  since_shown_ += step.dt_s;
  const bool at_rest = moved.awake() == 0;
  if (since_shown_ < kShowPeriod || (at_rest && shown_at_rest_)) return;
  displaced_->publish(moved);
  since_shown_ = 0;
  shown_at_rest_ = at_rest;
}

hsp_status MatDeformable::mesh(double chord_error, hsp_mesh& out) {
  if (!body_) return HSP_E_STATE;
  if (!(chord_error > 0)) return HSP_E_ARG;
  display_.show(body_->skeleton(), *displaced_, std::max(chord_error, kFinestMesh), out);
  return HSP_OK;
}

medial::NewtonOptions MatDeformable::newtonOptions(const hsp_step& step) const noexcept HSP_RT {
  medial::NewtonOptions options;
  options.envelope = envelope_ == 0 ? medial::Envelope::kExact : medial::Envelope::kFoot;
  options.tolerance = step.tolerance_m > 0 ? step.tolerance_m : tolerance_;
  if (step.max_iterations > 0)
    options.max_evaluations = static_cast<int>(std::min<uint32_t>(step.max_iterations, options.max_evaluations));
  return options;
}

/// Follows the foot; looks all over the body where following may have lost it.
void MatDeformable::find(const Vector3d& p, uint32_t flags, const medial::NewtonOptions& options,
                         Track& track) noexcept HSP_RT {
  const medial::Skeleton& skeleton = body_->skeleton();
  if (search_ == 1) {
    track.foot = skeleton.bisect(p, options.envelope, depth_);
  } else {
    const bool jumped = (flags & HSP_IN_JUMP) != 0;
    if (!track.known && track.offered && !jumped) {  // the search that started it has looked all over the body
      track.foot.u = track.offered_u;
      track.foot.v = track.offered_v;
      track.known = true;
      track.last = p;
    }
    const bool far = (p - track.last).squaredNorm() > std::pow(kNewPlace * skeleton.spacing(), 2);
    const bool lost = !track.known || far || jumped;
    const bool matters = skeleton.leastDistance(p) < kWithinReach;
    if (!lost || !matters) track.foot = skeleton.nearest(p, track.foot.u, track.foot.v, options);
    if (matters && (lost || !track.foot.converged)) {
      track.foot = skeleton.search(p, options);
    } else if (track.offered &&
               std::fabs(track.offered_u - track.foot.u) + std::fabs(track.offered_v - track.foot.v) > kOtherFoot) {
      const SkeletonFoot other = skeleton.nearest(p, track.offered_u, track.offered_v, options);
      if (other.depth > track.foot.depth) track.foot = other;
    }
  }
  track.offered = false;
  track.known = true;
  track.last = p;
}

MatDeformable::Felt MatDeformable::felt(Track& track) noexcept HSP_RT {
  const SkeletonFoot& foot = track.foot;
  const double cosine = foot.normal.dot(foot.across);
  const int side = cosine < 0 ? -1 : 1;
  if (!(foot.depth > 0)) {
    track.side = 0;
  } else if (track.side == 0 || foot.rim || foot.across.isZero(0)) {
    track.side = side;  // round the rim it is free to go
  } else if (side != track.side) {
    return {foot.normal - 2 * cosine * foot.across, 2 * foot.radius - foot.depth};
  }
  return {foot.normal, foot.depth};
}

hsp_status MatDeformable::touch(const hsp_probe& probe, const hsp_step& step, uint32_t index,
                                hsp_contact& contact) noexcept HSP_RT {
  if (index >= tracks_.size()) return HSP_E_ARG;
  Track& track = tracks_[index];
  if (!track.active || (probe.flags & HSP_IN_INVALID) != 0) {
    track.friction.reset();
    return HSP_OK;
  }
  const Vector3d p(probe.position);
  if (!p.allFinite()) return HSP_E_NUMERIC;
  if ((probe.flags & HSP_IN_JUMP) != 0) track.side = 0;
  find(p, probe.flags, newtonOptions(step), track);
  const SkeletonFoot& foot = track.foot;
  Eigen::Map<Vector3d>(contact.point) = foot.center + foot.radius * foot.normal;
  Eigen::Map<Vector3d>(contact.normal) = foot.normal;
  contact.depth_m = foot.depth;
  contact.param[0] = foot.u;
  contact.param[1] = foot.v;
  contact.residual_m = foot.residual;
  contact.iterations = static_cast<uint32_t>(foot.evaluations);
  contact.flags = HSP_OUT_TRACED;
  if (foot.rim) contact.flags |= HSP_OUT_EDGE;
  const Felt surface = felt(track);
  if (surface.depth > 0) {
    contact.flags |= HSP_OUT_CONTACT;
    push(probe, surface, track, contact);
  } else {
    track.friction.reset();
  }
  return foot.converged ? HSP_OK : HSP_DEGRADED;
}

void MatDeformable::push(const hsp_probe& probe, const Felt& felt, Track& track, hsp_contact& contact) noexcept HSP_RT {
  const Vector3d p(probe.position), velocity(probe.velocity);
  const double closing = -velocity.dot(felt.normal);
  const medial::BodyForce answer = body_->press(p, track.foot, felt.normal, felt.depth, closing);
  const contact::FrictionLaw law{std::max(friction_static_, friction_dynamic_), friction_dynamic_, answer.stiffness,
                                 viscosity_};
  const Vector3d surface = p + felt.depth * felt.normal;
  const Vector3d rub = track.friction.step(law, surface, felt.normal, answer.normal, velocity);
  Eigen::Map<Vector3d>(contact.force) = answer.force + rub;
  contact.stiffness = answer.stiffness;
  stored_ += answer.energy + track.friction.energy(law);
  presses_.push_back({track.foot.u, track.foot.v, felt.normal, felt.depth, closing});  // reserved: one a probe
}

int64_t MatDeformable::nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const {
  const Vector3d p(p_model);
  if (!p.allFinite() || body_->skeleton().leastDistance(p) > radius) return 0;
  medial::NewtonOptions options;
  options.envelope = envelope_ == 0 ? medial::Envelope::kExact : medial::Envelope::kFoot;
  const SkeletonFoot foot = body_->skeleton().search(p, options);
  const double distance = std::max(0.0, -foot.depth);
  if (distance > radius) return 0;
  if (cap > 0) out[0] = {0, 0, {foot.u, foot.v}, distance};
  return 1;
}

hsp_status MatDeformable::start(const hsp_near& near) noexcept HSP_RT {
  if (near.probe >= tracks_.size() || near.surface != 0) return HSP_E_ARG;
  Track& track = tracks_[near.probe];
  if (!track.active) track.known = false;
  track.active = track.offered = true;
  track.offered_u = near.param[0];
  track.offered_v = near.param[1];
  return HSP_OK;
}

hsp_status MatDeformable::stop(uint32_t probe) noexcept HSP_RT {
  if (probe >= tracks_.size()) return HSP_E_ARG;
  tracks_[probe] = Track{};
  return HSP_OK;
}

const void* MatDeformable::extension(const char* name) {
  const std::string_view wanted = name;
  if (wanted == HSP_EXT_SURFACES && body_) {
    surfaces_extension_ = {
        sizeof(hsp_ext_surfaces), 1,
        [](const hsp_shape* shape, const double p_model[3], double radius, hsp_near* out, uint64_t cap) -> int64_t {
          return reinterpret_cast<const MatDeformable*>(shape)->nearby(p_model, radius, out, cap);
        },
        [](hsp_shape* shape, const hsp_near* near)
            HSP_RT -> hsp_status { return reinterpret_cast<MatDeformable*>(shape)->start(*near); },
        [](hsp_shape* shape, uint32_t probe, uint32_t)
            HSP_RT -> hsp_status { return reinterpret_cast<MatDeformable*>(shape)->stop(probe); }};
    return &surfaces_extension_;
  }
  if (wanted == HSP_EXT_GEOMETRY && body_) {
    geometry_extension_ = {sizeof(hsp_ext_geometry), 0,
                           [](hsp_shape* shape, double chord_error, hsp_mesh* out) -> hsp_status {
                             return reinterpret_cast<MatDeformable*>(shape)->mesh(chord_error, *out);
                           },
                           [](hsp_shape* shape, double min[3], double max[3]) -> hsp_status {
                             const auto& body = reinterpret_cast<MatDeformable*>(shape)->body_;
                             if (!body) return HSP_E_STATE;
                             Eigen::Map<Vector3d>(min, 3) = body->skeleton().bounds().min();
                             Eigen::Map<Vector3d>(max, 3) = body->skeleton().bounds().max();
                             return HSP_OK;
                           }};
    return &geometry_extension_;
  }
  if (wanted == HSP_EXT_ENERGY) {
    energy_extension_ = {sizeof(hsp_ext_energy), 0, [](hsp_shape* shape) HSP_RT -> double {
                           const MatDeformable& body = *reinterpret_cast<MatDeformable*>(shape);
                           return body.stored_ + body.body_->deformation().energy();
                         }};
    return &energy_extension_;
  }
  return nullptr;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::MatDeformable)
