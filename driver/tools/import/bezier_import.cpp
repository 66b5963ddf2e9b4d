// SPDX-License-Identifier: MIT
#include "import/bezier_import.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/short_number.hpp"
#include "document/node.hpp"
#include "document/reader.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
constexpr int kMaxDegree = 15;
constexpr int kMaxPatches = 100'000;
constexpr int kCleanDigits = 9;  ///< digits of a written coordinate; more would show rounding errors of scaling

/// Reads the numbers of a file with their lines, and skips comments.
class Numbers {
 public:
  Numbers(const std::string& text, std::string file, std::vector<std::string>& comments) : file_(std::move(file)) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      if (!line.empty() && line[0] == '#')
        comments.push_back(line);
      else
        addLine(line, number);
    }
  }

  double next(const char* what) {
    if (at_ == words_.size()) throw Error{file_ + ": the file ends too early; expected " + what};
    const Word& word = words_[at_++];
    const auto value = document::toNumber(word.text);
    if (!value || !std::isfinite(*value)) throw wrong(word, what);
    return *value;
  }
  int whole(const char* what, int min, int max) {
    const double value = next(what);
    if (value != std::floor(value) || value < min || value > max)
      throw wrong(words_[at_ - 1], std::string(what) + ", " + std::to_string(min) + " to " + std::to_string(max));
    return static_cast<int>(value);
  }
  void end() const {
    if (at_ < words_.size()) throw wrong(words_[at_], "the end of the file after the last patch");
  }

 private:
  struct Word {
    std::string text;
    int line, column;
  };
  void addLine(const std::string& line, int number) {
    for (size_t i = 0; i < line.size();) {
      const size_t start = line.find_first_not_of(" \t,", i);
      if (start == std::string::npos) return;
      i = std::min(line.find_first_of(" \t,", start), line.size());
      words_.push_back({line.substr(start, i - start), number, static_cast<int>(start) + 1});
    }
  }
  Error wrong(const Word& word, const std::string& expected) const {
    return Error{file_ + ":" + std::to_string(word.line) + ":" + std::to_string(word.column) + ": " + "'" +
                 word.text.substr(0, 40) + "' stands here; expected " + expected};
  }
  std::string file_;
  std::vector<Word> words_;
  size_t at_ = 0;
};

/// Turns a point so that the axis that points up becomes y.
Vector3d turned(const Vector3d& p, char up) {
  if (up == 'z') return {p.x(), p.z(), -p.y()};
  if (up == 'x') return {-p.y(), p.x(), p.z()};
  return p;
}

double clean(double value) {
  const double rounded = std::strtod(withDigits(value, kCleanDigits).c_str(), nullptr);
  return rounded == 0 ? 0.0 : rounded;  // no minus zero
}

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Computes the Bernstein polynomials of a degree and their derivatives at t.
void bernstein(int degree, double t, std::vector<double>& value, std::vector<double>& slope) {
  const auto at = [](int n, int i, double x) {
    return i < 0 || i > n ? 0.0 : binomial(n, i) * std::pow(x, i) * std::pow(1 - x, n - i);
  };
  value.resize(static_cast<size_t>(degree) + 1);
  slope.resize(value.size());
  for (int i = 0; i <= degree; ++i) {
    value[static_cast<size_t>(i)] = at(degree, i, t);
    slope[static_cast<size_t>(i)] = degree * (at(degree - 1, i - 1, t) - at(degree - 1, i, t));
  }
}

std::vector<double> knots(int degree) {
  std::vector<double> all(2 * (static_cast<size_t>(degree) + 1), 0.0);
  for (size_t i = all.size() / 2; i < all.size(); ++i) all[i] = 1;
  return all;
}

std::string knotText(int degree) {
  std::string text(1, '[');
  for (const double knot : knots(degree)) {
    if (text.size() > 1) text += ", ";
    text += document::numberText(knot);
  }
  return text += ']';
}

std::string triple(const Vector3d& p) {
  std::string text(1, '[');
  text += document::numberText(p.x());
  text += ", ";
  text += document::numberText(p.y());
  text += ", ";
  text += document::numberText(p.z());
  return text += ']';
}

std::string patchName(size_t index) {
  return "patch" + std::to_string(index);
}

}  // namespace

Result<BezierModel> parseBpt(const std::string& text, const std::string& file) {
  BezierModel model;
  try {
    Numbers numbers(text, file, model.comments);
    const int count = numbers.whole("the number of patches", 1, kMaxPatches);
    for (int i = 0; i < count; ++i) {
      BezierPatch patch;
      patch.degree_u = numbers.whole("a degree", 1, kMaxDegree);
      patch.degree_v = numbers.whole("a degree", 1, kMaxDegree);
      const int points = (patch.degree_u + 1) * (patch.degree_v + 1);
      for (int j = 0; j < points; ++j) {
        const double x = numbers.next("a coordinate"), y = numbers.next("a coordinate"),
                     z = numbers.next("a coordinate");
        patch.points.emplace_back(x, y, z);
      }
      model.patches.push_back(std::move(patch));
    }
    numbers.end();
  } catch (const Error& error) {
    return error;
  }
  model.reversed = signedVolume(model) < 0;
  return model;
}

void placeModel(BezierModel& model, const Placement& placement) {
  for (BezierPatch& patch : model.patches)
    for (Vector3d& point : patch.points) point = turned(point, placement.up);
  const Eigen::AlignedBox3d box = boundsOf(model);
  const double extent = box.sizes().maxCoeff();
  const double scale = placement.fit > 0 && extent > 0 ? placement.fit / extent : placement.scale;
  const Vector3d origin = placement.center ? Vector3d(0.5 * (box.min() + box.max())) : Vector3d::Zero();
  for (BezierPatch& patch : model.patches)
    for (Vector3d& point : patch.points) point = (scale * (point - origin)).unaryExpr(&clean);
}

void placePoints(std::vector<Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& used,
                 const Placement& placement) {
  if (used.empty()) return;
  for (Vector3d& point : points) point = turned(point, placement.up);
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::array<std::uint32_t, 3>& corners : used)
    for (const std::uint32_t corner : corners) {
      low = low.cwiseMin(points[corner]);
      high = high.cwiseMax(points[corner]);
    }
  const double extent = (high - low).maxCoeff();
  const double scale = placement.fit > 0 && extent > 0 ? placement.fit / extent : placement.scale;
  const Vector3d origin = placement.center ? Vector3d(0.5 * (low + high)) : Vector3d::Zero();
  for (Vector3d& point : points) point = (scale * (point - origin)).unaryExpr(&clean);
}

double signedVolume(const BezierModel& model) {
  constexpr std::array<double, 4> kAt{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
  constexpr std::array<double, 4> kWeight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                          0.17392742256872693};  // Gauss-Legendre on [0, 1]: only the sign matters
  double volume = 0;
  std::vector<double> bu, du, bv, dv;
  for (const BezierPatch& patch : model.patches)
    for (size_t a = 0; a < kAt.size(); ++a)
      for (size_t b = 0; b < kAt.size(); ++b) {
        bernstein(patch.degree_u, kAt[a], bu, du);
        bernstein(patch.degree_v, kAt[b], bv, dv);
        Vector3d S = Vector3d::Zero(), Su = S, Sv = S;
        for (size_t i = 0; i < bu.size(); ++i)
          for (size_t j = 0; j < bv.size(); ++j) {
            const Vector3d& point = patch.points[i * bv.size() + j];
            S += bu[i] * bv[j] * point;
            Su += du[i] * bv[j] * point;
            Sv += bu[i] * dv[j] * point;
          }
        volume += kWeight[a] * kWeight[b] * S.dot(Su.cross(Sv)) / 3;
      }
  return volume;
}

std::string toModelYaml(const BezierModel& model) {
  std::string out;
  for (const std::string& comment : model.comments) out += comment + "\n";
  out += "format: hapticd-model/1\nsurfaces:\n";
  for (size_t i = 0; i < model.patches.size(); ++i) {
    const BezierPatch& patch = model.patches[i];
    out += "  - name: " + patchName(i) + "\n    degree: [" + std::to_string(patch.degree_u) + ", " +
           std::to_string(patch.degree_v) + "]\n    knots: [" + knotText(patch.degree_u) + ", " +
           knotText(patch.degree_v) + "]\n";
    if (model.reversed) out += "    outward: reversed\n";
    out += "    points:";
    const auto row = static_cast<size_t>(patch.degree_v) + 1;
    for (size_t j = 0; j < patch.points.size(); ++j) {
      const Vector3d& p = patch.points[j];
      out += j == 0 ? " [" : j % row == 0 ? ",\n             " : ", ";
      out += triple(p);
    }
    out += "]\n";
  }
  return out;
}

std::string toModelJson(const BezierModel& model) {
  nlohmann::ordered_json json{{"format", "hapticd-model/1"}};
  std::string credit;
  for (const std::string& comment : model.comments)
    credit += comment.substr(std::min<size_t>(2, comment.size())) + "\n";
  if (!credit.empty()) json["credit"] = credit;
  for (size_t i = 0; i < model.patches.size(); ++i) {
    const BezierPatch& patch = model.patches[i];
    nlohmann::ordered_json surface{{"name", patchName(i)},
                                   {"degree", {patch.degree_u, patch.degree_v}},
                                   {"knots", {knots(patch.degree_u), knots(patch.degree_v)}}};
    if (model.reversed) surface["outward"] = "reversed";
    for (const Vector3d& p : patch.points) surface["points"].push_back({p.x(), p.y(), p.z()});
    json["surfaces"].push_back(surface);
  }
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace hapticd::importing
