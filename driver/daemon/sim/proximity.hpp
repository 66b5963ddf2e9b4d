// SPDX-License-Identifier: MIT
/// The global, slow work: which surfaces are near a probe? Sends activation records to the servo and keeps a mirror of
/// the models' transforms. (Thompson et al. 1999, section 4.2: 10 cm on, 5 cm of hysteresis, bounding boxes first.)
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <mutex>
#include <vector>

#include "host/shape_instance.hpp"
#include "link/link.hpp"

namespace hapticd::sim {

/// Period of the search: at 2 m/s a probe moves 10 mm of the 100 mm at which surfaces are activated.

struct ProximitySettings {
  double activation_radius = 0.10;  ///< [m]
  double hysteresis = 0.05;         ///< [m]
};

/// How much searching there is to do.
enum class Searching {
  kNone,   ///< no model has surfaces
  kSmall,  ///< one small surface: a search takes microseconds, so it needs no thread
  kLarge
};

class Proximity {
 public:
  /// [main] @param models in the order of the scene; those that trace themselves are not searched.
  Proximity(const std::vector<host::ShapeInstance*>& models, const std::vector<hsp_pose>& poses, uint32_t probe_count,
            const ProximitySettings& settings, link::Link& link);

  /// [main] Adds a model while searches go on, in a place of the scene that is empty.
  void add(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count);

  /// [main] The model of a place is no longer searched: nothing is sent for it after the return.
  void remove(uint32_t place);

  /// [sim] One search with the newest state of the arm: starts, offers and stops tracing.
  void search();

  /// [any] Models that have surfaces to search.
  size_t modelCount() const;
  /// [any] How much searching they need; it changes as models come and leave.
  Searching amount() const;

 private:
  mutable std::mutex mutex_;  ///< models come and leave between two searches
  struct Model {
    uint32_t index;  ///< in the scene; UINT32_MAX: it has left
    const host::ShapeInstance* shape;
    uint32_t surfaces;                 ///< how many it has
    uint64_t bytes;                    ///< of the shape
    Eigen::Vector3d box_min, box_max;  ///< model frame; empty if it is unknown, so that it is always searched
    bool has_box;
    Eigen::Vector3d position;
    Eigen::Quaterniond orientation;
    std::vector<uint8_t> active;  ///< [probe * surface_count + surface]
    uint32_t active_count = 0;
  };

  void addModel(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count);
  void receiveTransforms();
  void searchModel(Model& model, uint32_t probe, const Eigen::Vector3d& p_world);
  void stopLeft(Model& model, uint32_t probe);
  bool send(const Model& model, link::ActivationRecord::Order order, const hsp_near& near);

  ProximitySettings settings_;
  link::Link& link_;
  std::vector<Model> models_;
  std::vector<uint32_t> of_scene_;  ///< scene index to index in models_
  std::vector<hsp_near> found_;
  std::vector<uint8_t> seen_;
};

}  // namespace hapticd::sim
