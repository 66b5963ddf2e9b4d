// SPDX-License-Identifier: MIT
/// A model with the parameters from its file and the parameter table of its plugin. The checks for unusual values use
/// it.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "description/class_info.hpp"
#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

class GivenModel {
 public:
  /// @param box box around the model in its own frame; nothing if unknown
  /// @param info description of its plugin. `scene` and `info` must outlive this object
  /// @param unread keys and parameters of the model that could not be read
  GivenModel(const scene::Scene& scene, size_t index, const std::optional<Eigen::AlignedBox3d>& box,
             const host::ClassInfo& info, document::Problems& warnings, UnreadModel unread)
      : scene_(scene),
        index_(index),
        box_(box),
        info_(info),
        unread_(std::move(unread)),
        warnings_(warnings),
        first_(warnings.size()) {}

  const scene::Scene& scene() const { return scene_; }
  const scene::Model& model() const { return scene_.models[index_]; }
  Eigen::Vector3d gravity() const;  ///< [m/s^2] in the model's frame, as the model stands at the start
  const host::ClassInfo& plugin() const { return info_; }
  const std::optional<Eigen::AlignedBox3d>& box() const { return box_; }
  double size() const { return box_ ? box_->diagonal().norm() : 0; }  ///< [m] diagonal of the box; 0 if unknown

  /// Returns the value that the file gives, or nullptr if it gives none.
  const scene::Value* find(std::string_view id) const;
  /// Returns the number that the file gives, or else the plugin's default; 0 if there is no such parameter.
  double number(std::string_view id) const;
  Eigen::Vector3d vector(std::string_view id) const;  ///< zero if the value does not have three numbers
  /// Returns the chosen word of an enumeration, or "" if the plugin has no such parameter.
  std::string choice(std::string_view id) const;

  /// Call it before each check. If a check then asks for a value that could not be read, warn() does nothing until the
  /// next begin().
  void begin() const { unsure_ = false; }

  /// Adds a warning at the first of these parameters that the file gives. If the file gives none, the warning is at the
  /// model, under the name of the first parameter. If there is already a warning at this parameter, adds nothing.
  /// @param also true adds the warning although the parameter has one, because its reason is another
  void warn(std::initializer_list<std::string_view> ids, const std::string& what, bool also = false) const;

 private:
  const scene::Scene& scene_;
  size_t index_;
  const std::optional<Eigen::AlignedBox3d>& box_;
  const host::ClassInfo& info_;
  UnreadModel unread_;
  mutable bool unsure_ = false;  ///< true if the present check has asked for a value that could not be read
  document::Problems& warnings_;
  size_t first_;  ///< index of the first warning about this model
};

}  // namespace hapticd::diagnostics
