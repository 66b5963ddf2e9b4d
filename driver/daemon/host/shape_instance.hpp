// SPDX-License-Identifier: MIT
/// One instance of a shape plugin, from create() to destroy(). The calls of the set-up may fail with a message; step()
/// is a real-time call.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "base/code_owner.hpp"
#include "base/result.hpp"
#include "description/scene.hpp"
#include "hapticd/shape.h"
#include "host/contour.hpp"
#include "host/library.hpp"
#include "host/services.hpp"

namespace hapticd::host {

class ShapeInstance {
 public:
  /// [main] Loads the library (once per process), creates the instance and sets the parameters of the model.
  static Result<std::unique_ptr<ShapeInstance>> create(const scene::Model& model, Services::Log log);
  ~ShapeInstance();  ///< [main] deactivates and destroys
  ShapeInstance(const ShapeInstance&) = delete;
  ShapeInstance& operator=(const ShapeInstance&) = delete;

  Result<void> activate(const hsp_activation& activation);  ///< [main]
  void deactivate();                                        ///< [main]

  /// [rt] Steps the shape. If a program asks for vertices, `step` also gets the place where the shape must write them.
  hsp_status step(hsp_step& step) noexcept HSP_RT {
    const OwnerScope calling(owner_);
    if (contour_ == nullptr) return class_->step(shape_, &step);
    step.viz_xyz = contour_->offer(step.dt_s);
    step.viz_capacity = contour_->vertices();
    const hsp_status status = class_->step(shape_, &step);
    contour_->close(status >= 0);
    return status;
  }
  void reset() noexcept HSP_RT {  ///< [rt]
    const OwnerScope calling(owner_);
    class_->reset(shape_);
  }
  /// [rt] Starts to trace a surface, or offers the shape a second foot point on a traced surface. Only for a shape with
  /// surfaces.
  void activate(const hsp_near& near) noexcept HSP_RT {
    const OwnerScope calling(owner_);
    surfaces_->activate(shape_, &near);
  }
  void deactivate(uint32_t probe, uint32_t surface) noexcept HSP_RT {  ///< [rt]
    const OwnerScope calling(owner_);
    surfaces_->deactivate(shape_, probe, surface);
  }
  /// [sim] Finds the surfaces within radius_m [m] of a point [m] in the model frame; invalid answers are left out.
  /// @return how many were written to `near`
  size_t nearby(const double p_model[3], double radius_m, std::span<hsp_near> near) const noexcept;
  /// [rt] Returns the energy [J] that the shape stores, as the shape reports it; 0 if it reports none, or if its answer
  /// is invalid.
  double storedEnergy() const noexcept HSP_RT {
    if (energy_ == nullptr) return 0;
    const OwnerScope calling(owner_);
    const double stored = energy_->stored(shape_);
    return stored >= 0 ? stored : 0;
  }
  /// [main] Makes triangles of the shape in its current form. It checks them: every number must be finite, and every
  /// corner must be the index of a vertex.
  hsp_status tessellate(double chord_error_m, hsp_mesh& mesh) const;
  /// [main] Gives a box [m] around the shape in the model frame. Returns false if the shape gives no box, or if its
  /// answer is not a box.
  bool bounds(double min[3], double max[3]) const;

  const std::string& name() const { return name_; }
  const hsp_class& description() const { return *class_; }
  const hsp_report& report() const { return report_; }  ///< valid while active
  /// Returns the damping [N s/m] that was set on the shape: the largest of its parameters with this unit.
  double claimedDamping() const { return damping_; }
  /// nullptr if the shape finds its foot points by itself
  const hsp_ext_surfaces* surfaces() const { return surfaces_; }
  uint32_t surfaceCount() const noexcept { return surface_count_; }
  const hsp_ext_geometry* geometry() const { return geometry_; }
  const hsp_ext_energy* energy() const { return energy_; }
  const std::filesystem::path& file() const { return library_->file(); }  ///< [main] file of the plugin
  const Owner* owner() const noexcept { return owner_; }
  Contour* contour() const { return contour_.get(); }  ///< nullptr if its steps write no vertices
  hsp_shape* handle() const { return shape_; }
  bool active() const { return active_; }

 private:
  std::string findExtensions();
  ShapeInstance(std::shared_ptr<Library> library, const scene::Model& model, Services::Log log);
  std::shared_ptr<Library> library_;
  std::string name_;
  Services services_;
  const Owner* owner_;
  const hsp_class* class_ = nullptr;
  hsp_shape* shape_ = nullptr;
  hsp_report report_{};
  const hsp_ext_surfaces* surfaces_ = nullptr;
  const hsp_ext_geometry* geometry_ = nullptr;
  const hsp_ext_energy* energy_ = nullptr;
  std::unique_ptr<Contour> contour_;
  double damping_ = 0;
  uint32_t surface_count_ = 0;  ///< number of surfaces at activation
  bool active_ = false;
};

}  // namespace hapticd::host
