// SPDX-License-Identifier: MIT
/// The proximity search: finds which surfaces are near a probe, and sends activation records to the servo. It keeps
/// copies of the models' transforms. A surface is activated at 10 cm and stopped 5 cm farther away; bounding boxes are
/// tested first (Thompson et al. 1999, section 4.2).
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <mutex>
#include <vector>

#include "host/shape_instance.hpp"
#include "link/link.hpp"

namespace hapticd::sim {

/// Distances of the search. In one period of the search (5 ms) a probe at 2 m/s moves 10 mm, which is much less than
/// activation_radius. While a probe touches a model, the surfaces about its foot point stay traced, however short these
/// distances are.
struct ProximitySettings {
  double activation_radius = 0.10;  ///< [m] a surface nearer than this to a probe is traced
  double hysteresis = 0.05;         ///< [m] tracing stops at activation_radius plus this distance
};

/// How long a search takes.
enum class Searching {
  kNone,   ///< no model has surfaces
  kSmall,  ///< one small surface: a search takes microseconds, so it needs no thread
  kLarge
};

class Proximity {
 public:
  /// [main] @param models in the order of the scene. Shapes without surfaces() find their foot points by themselves, so
  /// they are left out of the search.
  Proximity(const std::vector<host::ShapeInstance*>& models, const std::vector<hsp_pose>& poses, uint32_t probe_count,
            const ProximitySettings& settings, link::Link& link);

  /// [main] Adds a model to an empty place while searches run.
  void add(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count);

  /// [main] Removes the model of a place. After the return, no records are sent for it.
  void remove(uint32_t place);

  /// [main] True if the model of a place is searched.
  bool contains(uint32_t place) const;

  /// [sim] Searches once with the newest positions of the probes, and starts, updates or stops the tracing of surfaces.
  /// The servo sees all records of a search at once.
  void search();

  /// [any] Returns the number of models that have surfaces to search.
  size_t modelCount() const;
  /// [any] Returns how long a search takes now; this changes as models come and leave.
  Searching amount() const;

 private:
  mutable std::mutex mutex_;  ///< because other threads add and remove models between two searches
  struct Model {
    uint32_t index;  ///< place of the model, which is its number in the scene; UINT32_MAX: it has left
    const host::ShapeInstance* shape;
    uint32_t surfaces;  ///< number of its surfaces
    uint64_t bytes;     ///< locked memory of the shape
    Eigen::Vector3d box_min,
        box_max;  ///< [m] corners of the box, model frame; a model without a box is searched every time
    bool has_box;
    Eigen::Vector3d position;
    Eigen::Quaterniond orientation;
    std::vector<uint8_t> active;  ///< [probe * surface_count + surface]
    uint32_t active_count = 0;
  };

  void addModel(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count);
  void receiveTransforms();
  void searchModel(Model& model, uint32_t probe, const Eigen::Vector3d& p_world, double depth);
  void stopLeft(Model& model, uint32_t probe);
  bool send(const Model& model, link::ActivationRecord::Order order, const hsp_near& near);

  ProximitySettings settings_;
  link::Link& link_;
  std::vector<Model> models_;
  std::vector<uint32_t> of_scene_;  ///< index in models_, by the model's place in the scene
  std::vector<hsp_near> found_;
  std::vector<uint8_t> seen_;
};

}  // namespace hapticd::sim
