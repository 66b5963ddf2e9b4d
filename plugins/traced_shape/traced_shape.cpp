// SPDX-License-Identifier: MIT
#include "traced_shape.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "base/file_beginning.hpp"
#include "base/regular_file.hpp"
#include "document.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/limit.hpp"
#include "model_file.hpp"
#include "model_warnings.hpp"
#include "part_mesh.hpp"

namespace hapticd {
namespace {

constexpr double kFarthestMesh = 1e-6;  // [m] least chord error of a mesh for drawing
/// evaluations of a foot that a ball has at least, also under load: with wrong feet it goes into the model
constexpr int kLeastForBall = 4;

/// Reads a model file, and logs what is doubtful in one with problems.
ModelFile readLogged(const std::string& text, const std::string& file, const Shape& shape) {
  try {
    return parseModelFile(text, file);
  } catch (const ModelFileError& error) {
    for (const std::string& odd : error.odd) shape.writeLog(HSP_LOG_WARNING, "geometry: " + odd);
    throw;
  }
}

/// Returns the bytes of a part, or the text of a model file. The first bytes say which of them it is, because a part
/// may be larger than any model file. A file that cannot be read is left to readModelText(), which says why.
std::string readGeometry(const std::string& file) {
  constexpr size_t kEnough = 64;
  const auto beginning = readBeginning(file, kEnough);
  if (!beginning || !brep::looksLikePart(std::as_bytes(std::span(*beginning)))) return readModelText(file);
  auto bytes = readRegular(file, brep::kMostPartBytes);
  if (!bytes) throw ModelFileError(file + ": " + bytes.error() + "; divide the part, and import each of the pieces");
  return *std::move(bytes);
}

}  // namespace

void TracedShape::load(const hsp_activation& activation, hsp_report& report) {
  part_.reset();
  searches_ = {};
  balls_.assign(tip_radius_ > 0 ? std::max(activation.max_probes, 1u) : 0, contact::BallProxy{});
  takeFormerNames();
  const std::string text = readGeometry(geometry_);
  if (brep::looksLikePart(std::as_bytes(std::span(text)))) return loadPart(text, activation, report);
  if (sides_ == kAuto) sides_ = kFront;
  ModelFile file = readLogged(text, geometry_, *this);
  for (const auto& [parameter, name] : {std::pair("instance", instance_), std::pair("without", without_)})
    if (!name.empty())
      throw std::invalid_argument(std::string(parameter) + ": '" + name + "', but " + geometry_ +
                                  " is a model file, which has no instances; geometry must be a part (.hpart)");
  trace::ModelOptions options;
  options.edges = std::move(file.edges);
  options.form = evaluation_ == 0 ? spline::Form::kTable : spline::Form::kNet;
  model_ = std::make_unique<trace::Model>(file.surfaces, options);
  for (const auto& warnings : {&warnOfJoints, &warnOfModel})
    for (const std::string& odd : warnings(file, *model_, text, geometry_))
      writeLog(HSP_LOG_WARNING, "geometry: " + odd);
  const uint32_t probes = std::max(activation.max_probes, 1u);
  tracers_.clear();
  tracers_.reserve(probes);
  for (uint32_t i = 0; i < probes; ++i) tracers_.emplace_back(*model_);
  offers_.assign(probes, OfferedFeet{});
  searched_.assign(probes, 1);
  report.size_m = model_->bounds().diagonal().norm();
  report.locked_bytes = model_->bytes();
}

void TracedShape::deactivate() {
  searches_ = {};
  tracers_.clear();
  model_.reset();
  part_tracers_.clear();
  part_.reset();
  balls_.clear();
}

void TracedShape::reset() noexcept HSP_RT {
  for (trace::Tracer& tracer : tracers_) tracer.reset();
  for (brep::Tracer& tracer : part_tracers_) tracer.reset();
  for (contact::BallProxy& ball : balls_) ball.forget();
  for (OfferedFeet& offers : offers_) offers.count = 0;
  std::fill(searched_.begin(), searched_.end(), 1);
}

void TracedShape::takeFormerNames() {
  if (hold_ == kNotGiven) return;
  contact_hysteresis_ = std::max(hold_, 0.0);
  hold_ = kNotGiven;
  writeLog(HSP_LOG_WARNING, "hold: this parameter is now called contact_hysteresis; write contact_hysteresis instead");
}

contact::ContactRule TracedShape::contactRule() const noexcept HSP_RT {
  contact::ContactRule rule;
  rule.sides = static_cast<contact::Sides>(sides_);
  if (contact_hysteresis_ < kHoldAlways) rule.hysteresis = contact_hysteresis_;
  rule.deepest = deepest_;
  return rule;
}

trace::TraceOptions TracedShape::optionsOf(const hsp_step& step) const noexcept HSP_RT {
  trace::TraceOptions options;
  options.method = method_ == 0 || step.order == 1 ? trace::Method::kDirect : trace::Method::kNewton;
  options.iterations = iterations_;
  options.tolerance = step.tolerance_m > 0 ? step.tolerance_m : tolerance_;
  options.rule = contactRule();
  options.unite = sides_ == kFront;  // seen from the back, a union of solids is not a union
  if (step.max_iterations > 0)
    options.max_evaluations = static_cast<int>(
        std::clamp<uint32_t>(step.max_iterations, balls_.empty() ? 1 : kLeastForBall, options.max_evaluations));
  return options;
}

Touch TracedShape::trace(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  if (part_) return tracePart(probe, step, contact);
  Touch touch;
  const uint32_t index = indexOf(probe, step);
  if (index >= tracers_.size()) {
    touch.status = HSP_E_ARG;
    return touch;
  }
  if ((probe.flags & HSP_IN_INVALID) != 0) {
    forgetContact(index);
    return touch;
  }
  if ((probe.flags & HSP_IN_JUMP) != 0) searched_[index] = 0;
  if (searched_[index] == 0) beginAnew(index);
  offers_[index].count = 0;
  const auto foot_at = [&, options = optionsOf(step)](const Eigen::Vector3d& p) {
    return tracers_[index].step(p, options);
  };
  touch = answer(footOf(probe, index, foot_at), contact);
  if (searched_[index] == 0 && touch.traced) {
    // The old foot is no longer near, and a foot on the way from it would push in a wrong direction. Until the next
    // search the foot is reported, but there is no force.
    contact.depth_m = touch.depth = -touch.foot.distance;
    contact.flags &= ~uint32_t{HSP_OUT_CONTACT | HSP_OUT_HELD};
    touch.status = HSP_DEGRADED;
    if (!balls_.empty()) balls_[index].forget();
  }
  return touch;
}

/// True if a ball about p certainly does not meet the model. A part is searched as a whole. The tracer of a model file
/// follows feet from where it was, so its box has to do.
bool TracedShape::fitsAt(const Eigen::Vector3d& p, uint32_t probe) noexcept HSP_RT {
  if (!part_) return model_->bounds().exteriorDistance(p) > tip_radius_;
  const contact::Foot foot = part_tracers_[probe].nearest(p, {});
  const double out = sides_ == kBoth ? foot.distance : -foot.depth;
  return foot.status == contact::FootStatus::kNearest && out > tip_radius_;
}

void TracedShape::forgetContact(uint32_t probe) noexcept HSP_RT {
  if (part_) part_tracers_[probe].forgetContact();
  if (model_) tracers_[probe].forgetContact();
  if (!balls_.empty()) balls_[probe].forget();
}

/// After a jump, traces only the feet that a search has offered since then, if there are any.
void TracedShape::beginAnew(uint32_t probe) noexcept HSP_RT {
  forgetContact(probe);
  const uint32_t count = offers_[probe].count;
  if (count == 0) return;
  tracers_[probe].reset();
  for (uint32_t i = 0; i < count; ++i) start(offers_[probe].near[i]);
  searched_[probe] = 1;
}

/// Writes a foot to the contact record for the host.
Touch TracedShape::answer(const contact::Foot& foot, hsp_contact& contact) const noexcept HSP_RT {
  Touch touch;
  touch.foot = foot;
  if (foot.status == contact::FootStatus::kInvalid) touch.status = HSP_E_NUMERIC;
  if (foot.status == contact::FootStatus::kDegraded) touch.status = HSP_DEGRADED;
  if (foot.surface < 0) return touch;
  touch.depth = foot.depth;
  touch.normal = foot.normal;
  touch.traced = true;
  Eigen::Map<Eigen::Vector3d>(contact.point) = foot.point;
  Eigen::Map<Eigen::Vector3d>(contact.normal) = foot.normal;
  contact.depth_m = foot.depth;
  contact.param[0] = foot.u;
  contact.param[1] = foot.v;
  contact.residual_m = foot.residual;
  contact.feature = static_cast<uint32_t>(foot.surface);
  contact.iterations = static_cast<uint32_t>(foot.evaluations);
  contact.flags = HSP_OUT_TRACED;
  if (foot.depth > 0) contact.flags |= HSP_OUT_CONTACT;
  if (foot.on_edge) contact.flags |= HSP_OUT_EDGE;
  if (foot.status == contact::FootStatus::kHeld) contact.flags |= HSP_OUT_HELD;
  return touch;
}

void TracedShape::popThrough(uint32_t probe) noexcept HSP_RT {
  if (sides_ == kBoth && probe < part_tracers_.size()) part_tracers_[probe].popThrough();
  if (sides_ == kBoth && probe < tracers_.size()) tracers_[probe].popThrough();
}

/// Returns a search result for p, if possible an old one. A hand moves little between two searches: a result from up to
/// two millimetres away leads to the same feet, and its distances minus this path are still lower bounds. Only a valley
/// that appears in the meantime is found later, as also happens at 0.4 m/s. After twenty uses (100 ms) there is a new
/// search. A hand that has just arrived here, or has jumped, has followed no foot on the way; it gets a new search at
/// its own place.
const TracedShape::CachedSearch& TracedShape::searchAbout(const Eigen::Vector3d& p, double radius) const {
  constexpr double kSamePlace = 2e-3;  // [m] greatest distance of p from the place of the search
  constexpr double kSameHand = 1e-3;   // [m] greatest path of the same hand between two requests: 0.2 m/s
  constexpr int kMostUses = 20;
  for (CachedSearch& search : searches_)
    if (search.radius == radius && (search.at - p).norm() < kSamePlace && (search.asked - p).norm() < kSameHand) {
      search.asked = p;
      if (search.uses++ < kMostUses) return search;
      search.radius = -1;
    }
  CachedSearch& search = searches_[next_search_];
  next_search_ = (next_search_ + 1) % searches_.size();
  search.at = search.asked = p;
  search.radius = radius;
  search.uses = 1;
  model_->search(p, radius, search.found);
  return search;
}

/// Writes one record per surface, then the rivals: feet at other local minima of the distance on the same surfaces.
/// Returns the number of all records, which may be larger than `cap`. The distances are those of the ball, else it
/// would be deep in a surface before that is traced.
int64_t TracedShape::nearby(const double p_model[3], double radius, hsp_near* out, uint64_t cap) const {
  const Eigen::Vector3d p(p_model);
  const CachedSearch& search = searchAbout(p, radius + tip_radius_);
  const double nearer = (p - search.at).norm() + tip_radius_;
  uint64_t count = 0;
  for (const auto* records : {&search.found.nearest, &search.found.rivals})
    for (const trace::Near& near : *records) {
      if (count < cap)
        out[count] = {static_cast<uint32_t>(near.surface), 0, {near.u, near.v}, std::max(0.0, near.distance - nearer)};
      ++count;
    }
  return static_cast<int64_t>(count);
}

hsp_status TracedShape::start(const hsp_near& near) noexcept HSP_RT {
  if (near.probe >= tracers_.size() || near.surface >= static_cast<uint32_t>(model_->surfaceCount())) return HSP_E_ARG;
  const double lag = balls_.empty() ? 0 : balls_[near.probe].lag();
  const double farther = near.distance_m > 0 ? tip_radius_ - lag : 0;  // from the centre whose foot was the last
  tracers_[near.probe].activate(static_cast<int>(near.surface), near.param[0], near.param[1],
                                std::max(near.distance_m + farther, 0.0));
  OfferedFeet& offers = offers_[near.probe];
  if (offers.count < offers.near.size()) offers.near[offers.count++] = near;
  return HSP_OK;
}

hsp_status TracedShape::stop(uint32_t probe, uint32_t surface) noexcept HSP_RT {
  if (probe >= tracers_.size() || surface >= static_cast<uint32_t>(model_->surfaceCount())) return HSP_E_ARG;
  tracers_[probe].deactivate(static_cast<int>(surface));
  return HSP_OK;
}

hsp_status TracedShape::mesh(double chord_error, hsp_mesh& out) {
  if (!model_ && !part_) return HSP_E_STATE;
  if (!(chord_error > 0)) return HSP_E_ARG;
  chord_error = std::max(chord_error, kFarthestMesh);
  mesh_ = part_ ? tessellate(*part_, chord_error) : tessellate(*model_, chord_error);
  out.vertex_count = static_cast<uint32_t>(mesh_.xyz.size() / 3);
  out.triangle_count = static_cast<uint32_t>(mesh_.indices.size() / 3);
  out.xyz = mesh_.xyz.data();
  out.normals = mesh_.normals.data();
  out.indices = mesh_.indices.data();
  if (HSP_HAS(&out, colours) && !mesh_.colours.empty()) out.colours = mesh_.colours.data();
  return HSP_OK;
}

hsp_status TracedShape::bounds(double min[3], double max[3]) const {
  if (!model_ && !part_) return HSP_E_STATE;
  const Eigen::AlignedBox3d& box = part_ ? part_->bounds() : model_->bounds();
  Eigen::Map<Eigen::Vector3d>(min, 3) = box.min().array() - tip_radius_;
  Eigen::Map<Eigen::Vector3d>(max, 3) = box.max().array() + tip_radius_;
  return HSP_OK;
}

}  // namespace hapticd
