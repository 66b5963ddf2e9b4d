// SPDX-License-Identifier: MIT
/// A model of a plugin by itself, for who wants to measure it as it will be felt.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "host/catalog.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::importing {

/// [main] An active model of `plugin` with this geometry for this number of probes. `more` has further parameters, each
/// after a comma, as in a scene file.
Result<std::unique_ptr<host::ShapeInstance>> activated(const char* plugin, const std::filesystem::path& geometry,
                                                       host::Catalog& catalog, const std::string& more = "",
                                                       uint32_t probes = 1);

/// [main] What a resting probe meets that was placed at `p` [m], in the model's frame.
Result<hsp_contact> touched(host::ShapeInstance& body, const Eigen::Vector3d& p);

}  // namespace hapticd::importing
