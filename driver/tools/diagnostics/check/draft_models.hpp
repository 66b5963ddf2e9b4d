// SPDX-License-Identifier: MIT
/// Judges the models of a draft, which is as much of a scene with problems as could be read.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "description/class_info.hpp"
#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// What is known of the hands of a draft: nothing, where they start, or also how they move.
enum class KnownHands { kNothing, kStart, kMotion };

class DraftModels {
 public:
  /// `draft` must outlive this object.
  DraftModels(const scene::Scene& draft, const UnreadKeys& unread, host::Catalog& catalog);

  /// [main] Sets up all models that can be set up, with the values that were read.
  /// @param setup_seconds [s] longest time of one call of a plugin
  ModelTrial attempt(double max_force, double setup_seconds) const;

  /// [main] Returns the warnings about hands, and about how the models lie beside each other, with the models that have
  /// no problem.
  /// @param moved becomes true if there is such a model, so that the hands were moved
  document::Problems hands(const ModelTrial& trial, const document::Problems& problems, KnownHands known,
                           bool& moved) const;

  /// Returns true if a warning about one value of a model can be trusted.
  bool isRead(const document::Problem& one) const;

 private:
  bool isUnread(size_t model, const std::string& id) const;
  /// Returns true if it is not known which instances of its part a model has.
  bool isPartUnknown(size_t model) const;
  /// Returns true if a warning is about the surfaces of a model that may not be its own.
  bool isOfUnknownPart(const document::Problem& one) const;
  /// Returns the stiffness that a model claims, or 0 if it may come from a value that was not read.
  double claimOf(size_t model, double claimed) const;
  /// Returns true if a plugin's message names a parameter that was not read. A message about a file names such
  /// parameters in backquotes; other words of it are keys of the file.
  bool dependsOnUnread(const document::Problem& one) const;
  /// Returns true if a plugin objects to the number that was taken instead of one out of range. Of lists, the other
  /// numbers are as given.
  bool objectsToStandIn(const document::Problem& one, size_t model) const;
  /// Returns true if a message about a model that lacks a needed parameter is about those that it has.
  bool concernsGiven(const document::Problem& one, size_t model) const;

  const scene::Scene& draft_;
  host::Catalog& catalog_;
  std::vector<const host::ClassInfo*> plugins_;
  std::vector<UnreadModel> unread_;
  std::vector<bool> left_out_, lacks_;  ///< of each model: it is not tried; it lacks a needed parameter
};

}  // namespace hapticd::diagnostics
