/// Any bytes as a medial mesh: read, built, searched and pressed.
#include "kernels/medial/mesh_body.hpp"
#include "mat_deformable/ma_file.hpp"
#include "traced_shape/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hapticd::medial;
  MeshData mesh;
  try {
    mesh = hapticd::parseMa({reinterpret_cast<const char*>(data), size}, "fuzz.ma");
  } catch (const hapticd::ModelFileError&) {
    return 0;
  }
  try {
    MeshBody body({mesh, {300}, {.5}, {.01}}, {});
    for (const Eigen::Vector3d p :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(.01, -.02, .03), Eigen::Vector3d(1e9, 0, 0)}) {
      const SkeletonFoot foot = body.foot(p, MedialMesh::kNoStart, 1e-3);
      if (foot.element >= body.mesh().elements().size()) __builtin_trap();
      const Press press{foot.u, foot.v, foot.normal, .001, 0, foot.element};
      body.deformation().press({&press, 1});
      body.deformation().advance(1e-3);
    }
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
