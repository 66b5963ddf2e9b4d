// SPDX-License-Identifier: MIT
/// Makes a single active model of a plugin, to measure how it will be felt.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "host/catalog.hpp"
#include "host/shape_instance.hpp"
#include "import/triangles.hpp"

namespace hapticd::importing {

/// [main] Makes an active model of `plugin` with this geometry for this number of probes. `more` has further parameters
/// as in a scene file, with a comma before each. `warnings` receives a line for each warning of the plugin.
Result<std::unique_ptr<host::ShapeInstance>> activated(const char* plugin, const std::filesystem::path& geometry,
                                                       host::Catalog& catalog, const std::string& more = "",
                                                       uint32_t probes = 1, std::string* warnings = nullptr);

/// [main] Returns the contact of a resting probe that was placed at `p` [m], in the model's frame.
Result<hsp_contact> touched(host::ShapeInstance& body, const Eigen::Vector3d& p);

/// [main] Returns the triangles of a model as it is drawn. @param share largest error, as a share of the model's size
Result<Triangles> tessellated(host::ShapeInstance& shape, double share);

}  // namespace hapticd::importing
