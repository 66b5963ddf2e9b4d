// SPDX-License-Identifier: MIT
/// One instance of a shape plugin, from create to destroy. Set-up calls may fail with a message; step() is real time.
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "hapticd/shape.h"
#include "host/contour.hpp"
#include "host/library.hpp"
#include "host/services.hpp"

namespace hapticd::host {

class ShapeInstance {
 public:
  /// [main] Loads the library (once a process), creates the instance and sets the parameters of the model.
  static Result<std::unique_ptr<ShapeInstance>> create(const scene::Model& model, Services::Log log);
  ~ShapeInstance();  ///< [main] deactivates and destroys
  ShapeInstance(const ShapeInstance&) = delete;
  ShapeInstance& operator=(const ShapeInstance&) = delete;

  Result<void> activate(const hsp_activation& activation);  ///< [main]
  void deactivate();                                        ///< [main]

  /// [rt] Adds to `step` where vertices are to be written, if somebody looks.
  hsp_status step(hsp_step& step) noexcept HSP_RT {
    if (contour_ == nullptr) return class_->step(shape_, &step);
    step.viz_xyz = contour_->offer(step.dt_s);
    step.viz_capacity = contour_->vertices();
    const hsp_status status = class_->step(shape_, &step);
    contour_->close(status >= 0);
    return status;
  }
  void reset() noexcept HSP_RT { class_->reset(shape_); }  ///< [rt]

  const std::string& name() const { return name_; }
  const hsp_class& description() const { return *class_; }
  const hsp_report& report() const { return report_; }  ///< valid while active
  /// [N s/m] The damping that the shape was asked for: the largest of its parameters in that unit.
  double claimedDamping() const { return damping_; }
  const hsp_ext_surfaces* surfaces() const { return surfaces_; }  ///< nullptr: the shape traces itself
  const hsp_ext_geometry* geometry() const { return geometry_; }
  const hsp_ext_energy* energy() const { return energy_; }
  Contour* contour() const { return contour_.get(); }  ///< nullptr: its steps write no vertices
  hsp_shape* handle() const { return shape_; }
  bool active() const { return active_; }

 private:
  ShapeInstance(std::shared_ptr<Library> library, const scene::Model& model, Services::Log log);
  std::shared_ptr<Library> library_;
  std::string name_;
  Services services_;
  const hsp_class* class_ = nullptr;
  hsp_shape* shape_ = nullptr;
  hsp_report report_{};
  const hsp_ext_surfaces* surfaces_ = nullptr;
  const hsp_ext_geometry* geometry_ = nullptr;
  const hsp_ext_energy* energy_ = nullptr;
  std::unique_ptr<Contour> contour_;
  double damping_ = 0;
  bool active_ = false;
};

}  // namespace hapticd::host
