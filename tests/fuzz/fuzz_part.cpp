// SPDX-License-Identifier: MIT
/// Fuzzes part files: any bytes go through the reader. Parts with spoilt words, past the checksum of a file, go through
/// the checks, the model and some ticks. A part that passes the checks must give finite answers in bounded time.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/model/empty_balls.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/sections.hpp"
#include "unit/plugins/kernels/brep/sample_meshes.hpp"
#include "unit/plugins/kernels/brep/sample_solids.hpp"

namespace {

using namespace hapticd;
using brep::Part;
using Eigen::Vector3d;

void need(bool good) {
  if (!good) std::abort();
}

/// A triangle with colours, felt from both sides.
Part colouredTriangle() {
  Part part;
  brep::Body body;
  body.kind = brep::BodyKind::kMesh;
  body.point_count = 3, body.triangle_count = 1;
  part.points = {{0, 0, 0}, {0.05, 0, 0}, {0, 0.05, 0}};
  part.triangles = {{{0, 1, 2}, {brep::kNone, brep::kNone, brep::kNone}}};
  part.colours = {{{0xff0000ffu, 0, 0xffff0000u}}};
  part.bodies = {body};
  brep::Instance instance;
  instance.body = 0;
  part.instances = {instance};
  return part;
}

/// A closed mesh with its empty balls.
Part bumpyBall() {
  Part part = brep::samples::bumpyBall(200);
  brep::findEmptyBalls(part);
  return part;
}

const std::vector<Part>& samples() {
  static const std::vector<Part> parts{brep::samples::cappedCylinder(10, 20),
                                       brep::samples::bracket(),
                                       brep::samples::sphere(15),
                                       brep::samples::cone(10, 20),
                                       brep::samples::torus(20, 6),
                                       brep::samples::plate(3, 2, 1.5, 5, 3),
                                       colouredTriangle(),
                                       bumpyBall()};
  return parts;
}

/// Returns a sample part with spoilt words. Each change takes six bytes of the input: section, place and four bytes to
/// write there.
Part spoilt(std::span<const std::uint8_t> input) {
  constexpr int kSections = 15;
  Part part = samples()[input[0] % samples().size()];
  for (std::size_t at = 1; at + 6 <= input.size(); at += 6) {
    std::uint32_t value = 0;
    std::memcpy(&value, input.data() + at + 2, sizeof value);
    int section = 0;
    forEachSection(part, [&](const char*, auto& records) {
      if (section++ != input[at] % kSections || records.empty()) return;
      const std::size_t words = records.size() * sizeof records[0] / 4;
      const std::size_t word = input[at + 1] * words / 256 + (input[at] / kSections) % (words / 256 + 1);
      std::memcpy(reinterpret_cast<char*>(records.data()) + 4 * (word % words), &value, sizeof value);
    });
  }
  return part;
}

void trace(Part part) {
  const brep::Model model(std::move(part));
  brep::Tracer tracer(model);
  const Eigen::AlignedBox3d box = model.bounds();
  for (int i = 0; i < 40; ++i) {
    const double share = i / 39.0;
    const Vector3d p = box.min() + share * box.sizes() + Vector3d(1e-3, -2e-3, 1e-3 * std::sin(i));
    const contact::Foot foot = tracer.step(p, {});
    if (!contact::found(foot)) continue;
    need(foot.point.allFinite() && foot.normal.allFinite() && std::isfinite(foot.depth));
    need(std::abs(foot.depth) <= foot.distance * (1 + 1e-9) + 1e-12);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    brep::readPart(std::as_bytes(std::span(data, size)), "fuzz");
  } catch (const brep::PartError&) {
  }
  const Part part = spoilt({data, size});
  try {
    brep::checkPart(part);
  } catch (const brep::PartError&) {
    return 0;
  }
  const std::string file = brep::writePart(part);
  need(brep::writePart(brep::readPart(std::as_bytes(std::span(file)), "fuzz")) == file);
  try {
    trace(part);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
