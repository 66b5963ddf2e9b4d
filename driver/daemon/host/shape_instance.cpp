// SPDX-License-Identifier: MIT
#include "host/shape_instance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/call_name.hpp"
#include "base/owner_file.hpp"
#include "host/catalog.hpp"
#include "host/class_params.hpp"
#include "host/class_table.hpp"
#include "host/file_stamp.hpp"

namespace hapticd::host {
namespace {

/// Returns the extension if its struct contains all members of revision 1; otherwise nullptr.
template <class Extension>
const Extension* extensionOf(const hsp_class& shape_class, hsp_shape* shape, const char* name, size_t needed) {
  if (!HSP_HAS(&shape_class, extension) || shape_class.extension == nullptr) return nullptr;
  const auto* found = static_cast<const Extension*>(shape_class.extension(shape, name));
  return found != nullptr && found->struct_size >= needed ? found : nullptr;
}

bool complete(const hsp_ext_surfaces& surfaces) {
  return surfaces.nearby != nullptr && surfaces.activate != nullptr && surfaces.deactivate != nullptr;
}

bool complete(const hsp_ext_geometry& geometry) {
  return geometry.tessellate != nullptr && geometry.bounds != nullptr;
}

bool complete(const hsp_ext_energy& energy) {
  return energy.stored != nullptr;
}

constexpr uint32_t kMostSurfaces = 1'000'000;  ///< limit, since the search keeps an entry per surface and probe
constexpr uint32_t kMostVertices = 1'000'000;  ///< limit for drawing: three buffers of 12 MB each

/// Returns what is wrong with the claims of a report, or "". The host uses claims as bounds, and a claim that is not
/// finite would disable its checks.
std::string wrongIn(const hsp_report& report) {
  for (const double claim : {report.max_stiffness, report.max_force, report.size_m, report.max_jump})
    if (!std::isfinite(claim) || claim < 0)
      return "its report claims " + std::to_string(claim) + " as a stiffness, force, size or jump; expected 0 or more";
  if (report.viz_vertices > kMostVertices)
    return "its report claims " + std::to_string(report.viz_vertices) + " vertices to draw; expected at most " +
           std::to_string(kMostVertices);
  return "";
}

/// Returns the place of the model in its scene file; "" for a model that is in no file.
std::string placeOf(const scene::Model& model) {
  if (model.place.file.empty() || model.place.line == 0) return model.place.file;
  return model.place.file + ":" + std::to_string(model.place.line);
}

/// Returns the largest damping among the parameters; parameters that are not given count with their defaults.
double dampingOf(const hsp_class& shape, const std::vector<scene::Value>& given) {
  double most = 0;
  for (uint32_t i = 0; i < shape.param_count; ++i) {
    if (!damps(shape, i)) continue;
    double value = paramAt(shape, i).def;
    for (const scene::Value& v : given)
      if (v.index == i) value = v.number;
    most = std::max(most, value);
  }
  return most;
}

}  // namespace

ShapeInstance::ShapeInstance(std::shared_ptr<Library> library, const scene::Model& model, Services::Log log)
    : library_(std::move(library)),
      name_(model.name),
      services_(model.name, std::move(log)),
      owner_(ownerOf(model.plugin, model.name)) {}

Result<std::unique_ptr<ShapeInstance>> ShapeInstance::create(const scene::Model& model, Services::Log log) {
  auto library = Library::open(model.library);
  const std::string who = "model '" + model.name + "': ";
  if (!library) return Error{who + library.error()};
  auto entry = (*library)->shapes();
  if (!entry) return Error{who + entry.error()};

  std::unique_ptr<ShapeInstance> instance(new ShapeInstance(*library, model, std::move(log)));
  instance->class_ = findClass<hsp_class>(**entry, model.plugin);
  if (instance->class_ == nullptr)
    return Error{who + model.library.string() + " has no plugin named '" + model.plugin + "'"};
  if (!complete(*instance->class_))
    return Error{who + "plugin '" + model.plugin + "' of " + model.library.string() +
                 " lacks a required function; expected all functions of version 1.0 of the interface"};

  setCodeOwner(reinterpret_cast<const void*>(instance->class_->create), instance->owner_);
  setPlaceOfOwner(instance->owner_, placeOf(model));
  setFileOfOwner(instance->owner_, {model.library.string(), identityLoaded(model.library), !ships(model.library)});
  const OwnerScope calling(instance->owner_);
  const CallName creating("create");
  instance->shape_ = instance->class_->create(instance->class_, instance->services_.abi());
  if (instance->shape_ == nullptr)
    return Error{who + "plugin '" + model.plugin +
                 "' could not create an instance: " + reasonOf(HSP_E_NOMEM, instance->services_)};
  const CallName setting("set");
  const auto set = setAll(
      model.parameters, instance->class_->param_count, instance->services_,
      [&](uint32_t index, const hsp_value* value) { return instance->class_->set(instance->shape_, index, value); });
  if (!set) return Error{who + set.error()};
  instance->damping_ = dampingOf(*instance->class_, model.parameters);
  return instance;
}

ShapeInstance::~ShapeInstance() {
  const OwnerScope calling(owner_);
  deactivate();
  const CallName destroying("destroy");
  if (shape_ != nullptr) class_->destroy(shape_);
}

Result<void> ShapeInstance::activate(const hsp_activation& activation) {
  const std::string who = "model '" + name_ + "': ";
  if (active_) return Error{who + "is active already"};
  report_ = {};
  report_.struct_size = sizeof report_;
  services_.forgetError();
  const OwnerScope calling(owner_);
  const CallName activating("activate");
  const hsp_status status = class_->activate(shape_, &activation, &report_);
  if (status < 0) return Error{who + "cannot be set up: " + reasonOf(status, services_)};
  active_ = true;
  if (const std::string wrong = wrongIn(report_); !wrong.empty()) {
    deactivate();
    return Error{who + wrong};
  }
  if (const std::string wrong = findExtensions(); !wrong.empty()) {
    deactivate();
    return Error{who + wrong};
  }
  if (report_.viz_vertices > 0) contour_ = std::make_unique<Contour>(report_.viz_vertices);
  return {};
}

/// Asks the shape for its extensions. @return what is wrong with one of them, or ""
std::string ShapeInstance::findExtensions() {
  surfaces_ = extensionOf<hsp_ext_surfaces>(*class_, shape_, HSP_EXT_SURFACES, sizeof(hsp_ext_surfaces));
  geometry_ = extensionOf<hsp_ext_geometry>(*class_, shape_, HSP_EXT_GEOMETRY, sizeof(hsp_ext_geometry));
  energy_ = extensionOf<hsp_ext_energy>(*class_, shape_, HSP_EXT_ENERGY, sizeof(hsp_ext_energy));
  const char* const hollow = surfaces_ != nullptr && !complete(*surfaces_)   ? HSP_EXT_SURFACES
                             : geometry_ != nullptr && !complete(*geometry_) ? HSP_EXT_GEOMETRY
                             : energy_ != nullptr && !complete(*energy_)     ? HSP_EXT_ENERGY
                                                                             : nullptr;
  if (hollow != nullptr)
    return std::string("its extension ") + hollow + " lacks a function; expected all of them, or NULL in its place";
  surface_count_ = surfaces_ != nullptr ? surfaces_->surface_count : 0;
  if (surface_count_ <= kMostSurfaces) return "";
  return "it has " + std::to_string(surface_count_) + " surfaces; expected at most " + std::to_string(kMostSurfaces) +
         "\n  fix: divide the model, or repair the plugin";
}

void ShapeInstance::deactivate() {
  if (!active_) return;
  const OwnerScope calling(owner_);
  const CallName deactivating("deactivate");
  class_->deactivate(shape_);
  surfaces_ = nullptr;
  geometry_ = nullptr;
  energy_ = nullptr;
  contour_.reset();
  active_ = false;
}

size_t ShapeInstance::nearby(const double p_model[3], double radius_m, std::span<hsp_near> near) const noexcept {
  const OwnerScope calling(owner_);
  const CallName searching("nearby");
  const int64_t found = surfaces_->nearby(shape_, p_model, radius_m, near.data(), near.size());
  const size_t count = found > 0 ? std::min(static_cast<size_t>(found), near.size()) : 0;
  const auto sound = [&](const hsp_near& foot) {
    return foot.surface < surface_count_ && std::isfinite(foot.param[0]) && std::isfinite(foot.param[1]) &&
           std::isfinite(foot.distance_m);
  };
  const auto end = near.begin() + static_cast<std::ptrdiff_t>(count);
  return static_cast<size_t>(std::remove_if(near.begin(), end, std::not_fn(sound)) - near.begin());
}

hsp_status ShapeInstance::tessellate(double chord_error_m, hsp_mesh& mesh) const {
  mesh = {};
  mesh.struct_size = sizeof mesh;
  if (geometry_ == nullptr) return HSP_E_UNSUPPORTED;
  const OwnerScope calling(owner_);
  const CallName drawing("tessellate");
  const hsp_status status = geometry_->tessellate(shape_, chord_error_m, &mesh);
  if (status < 0) return status;
  const bool lacks =
      (mesh.vertex_count > 0 && mesh.xyz == nullptr) || (mesh.triangle_count > 0 && mesh.indices == nullptr);
  if (lacks) return HSP_E_NUMERIC;
  const std::span corners(mesh.indices, 3 * size_t{mesh.triangle_count});
  const std::span places(mesh.xyz, 3 * size_t{mesh.vertex_count});
  const bool sound = std::all_of(corners.begin(), corners.end(), [&](uint32_t i) { return i < mesh.vertex_count; }) &&
                     std::all_of(places.begin(), places.end(), [](float x) { return std::isfinite(x); });
  return sound ? status : HSP_E_NUMERIC;
}

bool ShapeInstance::bounds(double min[3], double max[3]) const {
  if (geometry_ == nullptr) return false;
  const OwnerScope calling(owner_);
  const CallName bounding("bounds");
  if (geometry_->bounds(shape_, min, max) != HSP_OK) return false;
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(min[i]) || !std::isfinite(max[i]) || min[i] > max[i]) return false;
  return true;
}

}  // namespace hapticd::host
