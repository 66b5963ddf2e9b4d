// SPDX-License-Identifier: MIT
/// The settings of a scene's models that trade speed for accuracy, and the values that are tried for each.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::tune {

/// One setting. A parameter that a plugin marks with HSP_P_ACCURACY is one knob for all models of that plugin.
struct Knob {
  std::string plugin;  ///< "nurbs_rigid"
  std::string key;     ///< "tolerance"
  std::string unit;
  uint32_t index = 0, kind = 0;     ///< index of the parameter in the plugin's table
  std::vector<double> numbers;      ///< values for set(); for a list, all its members
  std::vector<std::string> values;  ///< the same values for people and files: "1e-09", "newton"
  size_t current = 0;               ///< the value that the scene has
  size_t finest = 0;                ///< the value of the converged reference

  std::string name() const { return plugin + "." + key; }
};

/// One value per knob, in the order of the knobs.
using Choice = std::vector<size_t>;

/// [main] The knobs of a scene. The reference takes the smallest of a real parameter (a tolerance), the largest of a
/// whole one (a count) or of a list of them, and the default of an enumeration, which plugins choose to be exact. A
/// switch (off, on) adds something to the model: there the reference is what the scene asks for.
std::vector<Knob> findKnobs(const scene::Scene& scene, host::Catalog& catalog);

/// [main] The scene with other settings.
scene::Scene applied(scene::Scene scene, const std::vector<Knob>& knobs, const Choice& choice);

Choice currentOf(const std::vector<Knob>& knobs);
Choice finestOf(const std::vector<Knob>& knobs);

/// "nurbs_rigid.tolerance 1e-06, nurbs_rigid.method dpt": where a choice differs from another; "" where nowhere.
std::string difference(const std::vector<Knob>& knobs, const Choice& choice, const Choice& from);

}  // namespace hapticd::tune
