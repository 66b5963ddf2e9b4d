// SPDX-License-Identifier: MIT
/// The parameters of a scene's models that trade speed for accuracy, and the values that are tried for each.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::tune {

/// One such parameter. If several models have the same plugin, a parameter that the plugin marks with HSP_P_ACCURACY is
/// one knob for all of them.
struct Knob {
  std::string plugin;  ///< name of the plugin, such as "nurbs_rigid"
  std::string key;     ///< parameter, such as "tolerance"
  std::string unit;
  uint32_t index = 0, kind = 0;     ///< index of the parameter in the plugin's table
  std::vector<double> numbers;      ///< the values to try, for set(); for a list, the value of all its members
  std::vector<std::string> values;  ///< the same values as text, such as "1e-09" or "newton"
  size_t current = 0;               ///< index of the value that the scene has
  size_t finest = 0;                ///< index of the value that the converged reference has, see findKnobs()

  std::string name() const { return plugin + "." + key; }
};

/// The index of one value per knob, in the order of the knobs.
using Choice = std::vector<size_t>;

/// [main] Finds the knobs of a scene, and the value of each knob in the reference. A real parameter (a tolerance) has
/// its smallest value there, and a whole number (a count) or a list of them its largest. An enumeration has its
/// default, because plugins make their exact method the default. A switch (off, on) adds something to the model, so the
/// reference keeps the value of the scene.
std::vector<Knob> findKnobs(const scene::Scene& scene, host::Catalog& catalog);

/// [main] Returns the scene with the chosen values of the knobs.
scene::Scene applied(scene::Scene scene, const std::vector<Knob>& knobs, const Choice& choice);

Choice currentOf(const std::vector<Knob>& knobs);
Choice finestOf(const std::vector<Knob>& knobs);

/// Returns the settings in which a choice differs from another, such as "nurbs_rigid.tolerance 1e-06,
/// nurbs_rigid.method dpt"; "" if they are equal.
std::string difference(const std::vector<Knob>& knobs, const Choice& choice, const Choice& from);

}  // namespace hapticd::tune
