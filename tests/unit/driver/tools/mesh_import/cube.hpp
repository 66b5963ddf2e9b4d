// SPDX-License-Identifier: MIT
/// A cube as text of an OBJ file, and the part of such a text.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "kernels/part/check.hpp"
#include "mesh_import/mesh_part.hpp"

namespace hapticd::importing {

inline const char* const kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

inline brep::Part partOf(const std::string& obj, MeshReport& report, const MeshOptions& options = {}) {
  const auto mesh = parseObjMesh(obj, "x.obj");
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error());
  brep::Part part = meshPart(*mesh, options, "x.obj", report);
  brep::checkPart(part);
  return part;
}

}  // namespace hapticd::importing
