// SPDX-License-Identifier: MIT
/// A model as its file gives it, with what its plugin says about its parameters. Checks of unusual values use it.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "description/class_info.hpp"
#include "description/scene.hpp"
#include "diagnostics/unread_keys.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

class GivenModel {
 public:
  /// @param box box around the model in its own frame; nothing if unknown  @param info description of its plugin. Scene
  /// and info must outlive this object.  @param unread what was not read of the model
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

  /// Begins another judgement. If a judgement asks for a value that was not read, it cannot warn until the next begins.
  void begin() const { unsure_ = false; }

  /// Adds a warning at the first of these parameters that the file gives; if it gives none, at the model under the name
  /// of the first. Warns only once.
  /// @param also true for a reason of its own, beside which another warning at the same parameter may stand
  void warn(std::initializer_list<std::string_view> ids, const std::string& what, bool also = false) const;

 private:
  const scene::Value* given(std::string_view id) const;

  const scene::Scene& scene_;
  size_t index_;
  const std::optional<Eigen::AlignedBox3d>& box_;
  const host::ClassInfo& info_;
  UnreadModel unread_;
  mutable bool unsure_ = false;  ///< the judgement that is made now asked for a value that was not read
  document::Problems& warnings_;
  size_t first_;  ///< index of the first warning about this model
};

}  // namespace hapticd::diagnostics
