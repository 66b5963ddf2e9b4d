// SPDX-License-Identifier: MIT
/// A ball: a small complete plugin, with every kind of parameter and a state for each probe.
/// `hapticd plugin new NAME` copies it under another name; delete what your shape does not need.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "hapticd/shape.hpp"

namespace {

/// The friction state of one probe (finger): the ball holds the tip at the point of first touch, until the tip slides.
struct Grip {
  bool holds = false;
  double at[3] = {0, 0, 0};  // [m] held point, in the model frame
};

struct TemplateBall : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.shape.template", "template", "0.1.0", "MIT",
                                            "A ball about the model's origin; start your own plugin from it."};
  static constexpr const char* kLaws[] = {"linear", "profile"};

  double radius = 0, stiffness = 0, friction = 0;
  int law = 0;                  // index into kLaws
  std::vector<double> profile;  // depth, force, depth, force, ...
  std::string profile_file;

  static constexpr auto fields() {
    using F = hapticd::Fields<TemplateBall>;
    return std::array{
        F::real("radius", &TemplateBall::radius, "m", 0.001, 1, 0.05, "Radius of the ball."),
        F::real("stiffness", &TemplateBall::stiffness, "N/m", 0, 5000, 500, "Force for each metre of depth.",
                HSP_P_LIVE | HSP_P_SAFETY),
        F::real("friction", &TemplateBall::friction, "", 0, 2, 0.2,
                "Greatest force along the surface, divided by the force into it."),
        F::choice("law", &TemplateBall::law, kLaws, 0,
                  "linear: the force is stiffness * depth; profile: it comes from the table of depth and force."),
        // "m, N": units of the 2 columns; 4 to 200: how many numbers in all, so 2 to 100 rows; 0 to 20: range of each
        F::array("profile", &TemplateBall::profile, "m, N", 2, 4, 200, 0, 20, "[[0, 0], [0.002, 1], [0.01, 3]]",
                 "Table with rows of depth and force, by growing depth."),
        F::path("profile_file", &TemplateBall::profile_file,
                "The same table as a file with lines of the form depth,force; it replaces profile."),
    };
  }

  /// May allocate, and throw std::exception with a message for the user. Claims what the host may rely on.
  void activate(const hsp_activation& activation, hsp_report& report) {
    if (!profile_file.empty()) profile = readTable(profile_file);
    grips_.assign(activation.max_probes, Grip{});
    report.max_stiffness = law == 0 ? stiffness : steepest();
    // Without friction the ball only pushes; the host then silences it if it ever pulls. With friction, `hapticd plugin
    // check` finds a wrong sign of the force, and a run reports it only at its end. A shape that reads probe.velocity
    // must add HSP_R_VELOCITY here; otherwise the velocity is zero.
    if (friction == 0) report.flags |= HSP_R_PUSHES;
    report.size_m = 2 * radius;
    report.typical_ns = 50;
    report.worst_ns = 2000;
  }

  /// Returns triangles for `run --view` and other drawings. Forces do not need them.
  const void* extension(const char* name) {
    static constexpr hsp_ext_geometry kGeometry = {sizeof(hsp_ext_geometry), 0, &tessellate, &bounds};
    return std::strcmp(name, HSP_EXT_GEOMETRY) == 0 ? &kGeometry : nullptr;
  }

  void reset() noexcept HSP_RT { std::fill(grips_.begin(), grips_.end(), Grip{}); }

  /// Called in every tick for each probe: no allocation, lock, system call or exception is allowed. All values are in
  /// the model frame and in SI units.
  hsp_status touch(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
    Grip& grip = grips_[hapticd::indexOf(probe, step)];
    if ((probe.flags & (HSP_IN_INVALID | HSP_IN_JUMP)) != 0) grip.holds = false;
    if ((probe.flags & HSP_IN_INVALID) != 0) return HSP_OK;  // no sample: no force
    const double* p = probe.position;
    const double distance = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (distance == 0) return HSP_E_NUMERIC;  // the centre has no nearest point of the surface
    contact.depth_m = radius - distance;
    const double push = contact.depth_m > 0 ? forceAt(contact.depth_m) : 0;
    for (int i = 0; i < 3; ++i) {
      contact.normal[i] = p[i] / distance;
      contact.point[i] = radius * contact.normal[i];
      contact.force[i] = push * contact.normal[i];
    }
    contact.stiffness = contact.depth_m > 0 ? stiffness : 0;
    contact.flags = HSP_OUT_TRACED;
    if (contact.depth_m > 0) contact.flags |= HSP_OUT_CONTACT;
    rub(grip, p, push, contact);
    return HSP_OK;
  }

 private:
  /// Adds friction: a spring from the held point to the tip, with a force of at most friction * push. Beyond this force
  /// the held point slides along.
  void rub(Grip& grip, const double* p, double push, hsp_contact& contact) const noexcept HSP_RT {
    if (push <= 0 || !grip.holds) std::copy_n(p, 3, grip.at);
    grip.holds = push > 0;
    double along[3], length = 0, normal = 0;
    for (int i = 0; i < 3; ++i) normal += (p[i] - grip.at[i]) * contact.normal[i];
    for (int i = 0; i < 3; ++i) {
      along[i] = p[i] - grip.at[i] - normal * contact.normal[i];
      length += along[i] * along[i];
    }
    const double pull = stiffness * std::sqrt(length), most = friction * push;
    const double part = pull > most ? most / pull : 1;
    for (int i = 0; i < 3; ++i) {
      contact.force[i] -= stiffness * part * along[i];
      if (part < 1) grip.at[i] = p[i] - part * along[i];
    }
  }

  /// Returns the force [N]. It is linear between the rows; beyond the last row the line through the last two continues.
  double forceAt(double depth) const noexcept HSP_RT {
    if (law == 0) return stiffness * depth;
    size_t i = 2;
    while (i + 2 < profile.size() && depth > profile[i]) i += 2;
    const double part = (depth - profile[i - 2]) / (profile[i] - profile[i - 2]);
    return std::fmax(0.0, profile[i - 1] + part * (profile[i + 1] - profile[i - 1]));
  }

  /// Returns the greatest slope of the table. Refuses a table whose depths do not grow.
  double steepest() const {
    double most = 0;
    for (size_t i = 2; i < profile.size(); i += 2) {
      if (profile[i] <= profile[i - 2])
        throw std::runtime_error("profile: each depth must be greater than the one before");
      most = std::fmax(most, std::fabs((profile[i + 1] - profile[i - 1]) / (profile[i] - profile[i - 2])));
    }
    return most;
  }

  /// Reads the table. The host has made the path absolute; it looked for the file in the folder of the scene.
  static std::vector<double> readTable(const std::string& file) {
    std::ifstream in(file);
    std::vector<double> numbers;
    double depth = 0, force = 0;
    char comma = 0;
    while (in >> depth >> comma >> force && comma == ',') numbers.insert(numbers.end(), {depth, force});
    if (!in.eof() || numbers.size() < 4)
      throw std::runtime_error(file + ": expected two or more lines of the form depth,force");
    return numbers;
  }

  static TemplateBall& self(hsp_shape* shape) { return *reinterpret_cast<TemplateBall*>(shape); }

  static hsp_status bounds(hsp_shape* shape, double min[3], double max[3]) {
    for (int i = 0; i < 3; ++i) max[i] = self(shape).radius, min[i] = -max[i];
    return HSP_OK;
  }

  /// Makes rings of vertices from pole to pole. The arrays stay valid until the next call.
  static hsp_status tessellate(hsp_shape* shape, double /*chord_error_m*/, hsp_mesh* mesh) {
    constexpr uint32_t kRings = 24, kSides = 36;
    TemplateBall& ball = self(shape);
    ball.xyz_.clear(), ball.normals_.clear(), ball.indices_.clear();
    for (uint32_t i = 0; i <= kRings; ++i)
      for (uint32_t k = 0; k <= kSides; ++k) {
        const double down = M_PI * i / kRings, round = 2 * M_PI * k / kSides;
        for (const double n : {std::sin(down) * std::cos(round), std::cos(down), -std::sin(down) * std::sin(round)}) {
          ball.normals_.push_back(static_cast<float>(n));
          ball.xyz_.push_back(static_cast<float>(ball.radius * n));
        }
        const uint32_t a = i * (kSides + 1) + k, b = a + kSides + 1;  // the vertex below
        if (i < kRings && k < kSides) ball.indices_.insert(ball.indices_.end(), {a, b, a + 1, a + 1, b, b + 1});
      }
    mesh->xyz = ball.xyz_.data(), mesh->normals = ball.normals_.data(), mesh->indices = ball.indices_.data();
    mesh->vertex_count = static_cast<uint32_t>(ball.xyz_.size() / 3);
    mesh->triangle_count = static_cast<uint32_t>(ball.indices_.size() / 3);
    return HSP_OK;
  }

  std::vector<Grip> grips_;
  std::vector<float> xyz_, normals_;  // for drawing
  std::vector<uint32_t> indices_;
};

}  // namespace

HAPTICD_SHAPES(TemplateBall)
