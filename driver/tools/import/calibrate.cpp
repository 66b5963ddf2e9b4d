// SPDX-License-Identifier: MIT
#include "import/calibrate.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/regular_file.hpp"
#include "document/csv.hpp"
#include "document/node.hpp"
#include "import/active_model.hpp"
#include "import/indentation.hpp"
#include "import/progress_line.hpp"

namespace hapticd::importing {
namespace {

using document::Node;
using Eigen::Vector3d;

constexpr int kRounds = 300;          ///< number of rounds of the fit
constexpr double kFitted = 1e-4;      ///< relative error at which the fit ends
constexpr double kGood = 0.05;        ///< relative error above which a place is reported
constexpr double kReach = 0.7;        ///< multiple of the points' distance: the distance at which an answer counts less
constexpr double kFarthestReach = 2;  ///< multiple of the points' distance: the largest shear reach that is tried
constexpr double kNoReach = 0.05;     ///< multiple of the points' distance: a smaller shear reach has hardly any effect
constexpr double kStiffest = 1e6;     ///< [N/m] largest stiffness that a body may have

/// A press that was measured or computed: its place on the surface [m], its depth [m] and its force [N].
struct Answer {
  Vector3d place;
  double depth, force;
};

/// A body of a file: the places of its points, and the rest of the file.
struct Body {
  Node root;
  std::vector<Vector3d> points;
  std::size_t columns = 0;  ///< columns of a grid of points; 0 if the body has vertices
};

/// The parameters to fit.
struct Fitted {
  std::vector<double> stiffness;  ///< [N/m] stiffness of each point
  double reach = -1;              ///< [m] reach of the shear; below 0 keeps that of the file
  bool still = false;             ///< true writes the body without mass and damping, for measuring
};

Error first(const document::Problems& problems, const std::string& file) {
  return Error{problems.empty() ? file + ": cannot be read" : problems.front().text()};
}

Result<std::vector<Answer>> readAnswers(const std::string& file) {
  document::Problems problems;
  document::CsvRules rules;
  rules.headers = {"x,y,z,depth,force"};
  const auto table = document::readCsv(file, kMostTableBytes, rules, problems);
  if (!table || table->rows() == 0) return first(problems, file);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    const double* row = table->row(i);
    if (!(row[3] > 0) || !(row[4] > 0))
      return Error{fmt::format("{}:{}: the depth is {} m and the force {} N; expected both above 0", file,
                               table->lines[i], row[3], row[4])};
    answers.push_back({Vector3d(row), row[3], row[4]});
  }
  return answers;
}

/// Reads a point or vertex; returns false if it does not have three numbers.
bool addPoint(const Node& node, Body& body) {
  Vector3d p;
  if (!node.isSequence() || node.items.size() < 3) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto number = document::toNumber(node.items[k].scalar);
    if (!number) return false;
    p[static_cast<Eigen::Index>(k)] = *number;
  }
  body.points.push_back(p);
  return true;
}

Result<Body> readBody(const std::string& file) {
  document::Problems problems;
  auto root = document::parseFile(file, problems);
  if (!root) return first(problems, file);
  Body body;
  const Error wrong{file + ": expected a model file with medial: points, or vertices"};
  const Node* medial = root->isMap() ? root->find("medial") : nullptr;
  if (medial == nullptr || !medial->isMap()) return wrong;
  const Node *points = medial->find("points"), *vertices = medial->find("vertices");
  if (points != nullptr && points->isSequence()) {
    for (const Node& row : points->items) {
      body.columns = row.items.size();
      for (const Node& point : row.items)
        if (!addPoint(point, body)) return wrong;
    }
  } else if (vertices != nullptr && vertices->isSequence()) {
    for (const Node& vertex : vertices->items)
      if (!addPoint(vertex, body)) return wrong;
  }
  if (body.points.empty() || (body.columns > 0 && body.points.size() % body.columns != 0)) return wrong;
  body.root = std::move(*root);
  return body;
}

std::string stiffnessText(const Body& body, const std::vector<double>& stiffness) {
  std::string text = "  stiffness:";
  const std::size_t columns = body.columns > 0 ? body.columns : stiffness.size();
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    if (i % columns == 0) text += body.columns > 0 ? "\n    - [" : " [";
    text += fmt::format("{:.7g}{}", stiffness[i], i % columns == columns - 1 ? "]" : ", ");
  }
  return text + "\n";
}

std::string written(const Body& body, const Fitted& fitted, const Calibration& options) {
  std::string text =
      fmt::format("# {} with the stiffness of {}, by hapticd import --calibrate\nformat: hapticd-model/2\n",
                  options.body, options.answers);
  for (const document::Entry& entry : body.root.entries)
    if (entry.key.scalar != "format" && entry.key.scalar != "medial")
      text += fmt::format("{}: {}\n", entry.key.scalar, document::toJson(entry.value));
  text += "medial:\n";
  for (const document::Entry& entry : body.root.find("medial")->entries) {
    const std::string& key = entry.key.scalar;
    if (key == "stiffness" || key == "young" || key == "poisson" || key == "thickness") continue;
    if ((fitted.reach >= 0 && key == "shear_reach") || (fitted.still && (key == "mass" || key == "damping"))) continue;
    text += fmt::format("  {}:", key);
    if (entry.value.isSequence() && !entry.value.items.empty()) {
      text += "\n";
      for (const Node& item : entry.value.items) text += fmt::format("    - {}\n", document::toJson(item));
    } else {
      text += fmt::format(" {}\n", document::toJson(entry.value));
    }
  }
  if (fitted.reach >= 0) text += fmt::format("  shear_reach: {:.4g}\n", fitted.reach);
  return text + stiffnessText(body, fitted.stiffness);
}

/// [m] Returns the mean distance of a point to the nearest other point.
double spacingOf(const Body& body) {
  double spacing = 0;
  for (const Vector3d& a : body.points) {
    double least = HUGE_VAL;
    for (const Vector3d& b : body.points)
      if (&a != &b) least = std::min(least, (a - b).norm());
    if (std::isfinite(least)) spacing += least / static_cast<double>(body.points.size());
  }
  return spacing;
}

/// Returns how much each answer counts for each point: the nearest answer counts most.
Eigen::MatrixXd sharesOf(const Body& body, const std::vector<Answer>& answers) {
  const auto count = static_cast<Eigen::Index>(body.points.size()), places = static_cast<Eigen::Index>(answers.size());
  const double width = std::pow(kReach * spacingOf(body), 2);
  Eigen::MatrixXd shares(count, places);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < places; ++j)
      shares(i, j) =
          (body.points[static_cast<std::size_t>(i)] - answers[static_cast<std::size_t>(j)].place).squaredNorm();
    const double nearest = shares.row(i).minCoeff();
    for (Eigen::Index j = 0; j < places; ++j)
      shares(i, j) = width > 0 ? std::exp(-0.5 * (shares(i, j) - nearest) / width) : 1;
    shares.row(i) /= shares.row(i).sum();
  }
  return shares;
}

/// Returns the force [N] of the written body at the place of each answer.
Result<std::vector<double>> feltForces(const Calibration& options, const std::vector<Answer>& answers,
                                       host::Catalog& catalog) {
  const auto body = activated("mat_deformable", options.out, catalog);
  if (!body) return Error{body.error()};
  const hsp_near near{};
  if ((*body)->surfaces()->activate((*body)->handle(), &near) < 0) return Error{"the body cannot be traced"};
  std::vector<double> forces;
  for (const Answer& answer : answers) {
    (*body)->reset();  // removes the dent of the press before
    // foot on the surface of the soft body, which lies near the given place
    const auto foot = touched(**body, answer.place);
    if (!foot) return Error{foot.error()};
    const Vector3d normal(foot->normal);
    const auto pressed = touched(**body, Vector3d(foot->point) - answer.depth * normal);
    if (!pressed) return Error{pressed.error()};
    forces.push_back(Vector3d(pressed->force).dot(Vector3d(pressed->normal)));
  }
  return forces;
}

void printFit(const std::vector<Answer>& answers, const std::vector<double>& forces, const Calibration& options) {
  double worst = 0, squares = 0;
  for (std::size_t j = 0; j < answers.size(); ++j) {
    const double error = forces[j] / answers[j].force - 1;
    worst = std::max(worst, std::fabs(error));
    squares += error * error / static_cast<double>(answers.size());
    if (std::fabs(error) > kGood)
      std::fprintf(stderr,
                   "warning: at (%.4g, %.4g, %.4g) m the body gives %.4g N, but the file of answers says %.4g N\n",
                   answers[j].place.x(), answers[j].place.y(), answers[j].place.z(), forces[j], answers[j].force);
  }
  std::printf("%s: force at %zu places within %.2f %%, rms %.2f %%\n", options.out.c_str(), answers.size(), 100 * worst,
              100 * std::sqrt(squares));
}

/// Fits `fitted.stiffness`. Returns the force [N] of the body at the place of each answer.
Result<std::vector<double>> fitStiffness(const Body& body, const std::vector<Answer>& answers,
                                         const Calibration& options, host::Catalog& catalog, Fitted& fitted) {
  const Eigen::MatrixXd shares = sharesOf(body, answers);
  std::vector<double>& stiffness = fitted.stiffness;
  std::vector<double> forces;
  ProgressLine progress;
  stiffness.assign(body.points.size(), answers.front().force / answers.front().depth);
  for (int round = 0; round < kRounds; ++round) {
    if (const auto done = writeWhole(options.out, written(body, fitted, options)); !done) return Error{done.error()};
    auto felt = feltForces(options, answers, catalog);
    if (!felt) return Error{felt.error()};
    forces = std::move(*felt);
    Eigen::VectorXd missing(static_cast<Eigen::Index>(forces.size()));
    for (std::size_t j = 0; j < forces.size(); ++j) {
      if (!(forces[j] > 0))
        return Error{
            fmt::format("{}: at the place of row {} the body gives no force; expected a place on its surface, in m",
                        options.answers, j + 1)};
      missing[static_cast<Eigen::Index>(j)] = std::log(answers[j].force / forces[j]);
    }
    const double worst = missing.cwiseAbs().maxCoeff();
    progress.show(fmt::format("fitting the stiffness: round {}, force within {:.2g} %", round + 1, 100 * worst));
    if (worst < kFitted) break;
    const Eigen::VectorXd change = shares * missing;
    for (std::size_t i = 0; i < stiffness.size(); ++i)
      stiffness[i] = std::min(kStiffest, stiffness[i] * std::exp(change[static_cast<Eigen::Index>(i)]));
  }
  return forces;
}

/// Fits `fitted.reach`, and reports how well the body matches the given dents.
Result<void> fitShear(const Body& body, const std::vector<Indentation>& dents, const Calibration& options,
                      host::Catalog& catalog, Fitted& fitted) {
  Fitted tried{fitted.stiffness, 0, true};
  const auto write = [&](double reach) {
    tried.reach = reach;
    return writeWhole(options.out, written(body, tried, options));
  };
  const double spacing = spacingOf(body);
  ProgressLine progress;
  progress.show("fitting the reach of the shear");
  const auto fit = fitReach(options.out, kFarthestReach * spacing, dents, write, catalog);
  progress.clear();
  if (!fit) return Error{fit.error()};
  fitted.reach = fit->reach;
  double worst = 0, squares = 0, wider = 0;
  for (std::size_t i = 0; i < dents.size(); ++i) {
    const double error = fit->shares[i] - dents[i].share;
    worst = std::max(worst, std::fabs(error));
    squares += error * error / static_cast<double>(dents.size());
    wider += error / static_cast<double>(dents.size());
    if (std::fabs(error) > kGood)
      std::fprintf(stderr,
                   "warning: at (%.4g, %.4g, %.4g) m the dent of the body is %.3f of the depth, "
                   "but the file of dents says %.3f\n",
                   dents[i].beside.x(), dents[i].beside.y(), dents[i].beside.z(), fit->shares[i], dents[i].share);
  }
  if (worst > kGood && wider > 0 && fit->reach < kNoReach * spacing)
    std::fprintf(stderr,
                 "warning: the dents of the body are wider than those of the file; points closer together than %.3g m "
                 "make them narrower\n",
                 spacing);
  std::printf("%s: shear_reach %.4g m, dent at %zu places within %.3f of the depth, rms %.3f\n", options.out.c_str(),
              fitted.reach, dents.size(), worst, std::sqrt(squares));
  return writeWhole(options.out, written(body, fitted, options));
}

}  // namespace

Result<void> calibrate(const Calibration& options, host::Catalog& catalog) {
  if (!options.out.ends_with(".yaml")) return Error{options.out + ": expected a name that ends in .yaml"};
  const auto answers = readAnswers(options.answers);
  if (!answers) return Error{answers.error()};
  const auto body = readBody(options.body);
  if (!body) return Error{body.error()};
  std::vector<Indentation> dents;
  if (!options.dents.empty()) {
    if (body->columns == 0)
      return Error{options.body +
                   ": the body has vertices; expected a grid of points, because rings fix the dents of a mesh"};
    auto read = readIndentations(options.dents);
    if (!read) return Error{read.error()};
    dents = std::move(*read);
  }
  Fitted fitted;
  const auto forces = fitStiffness(*body, *answers, options, catalog, fitted);
  if (!forces) return Error{forces.error()};
  printFit(*answers, *forces, options);
  return dents.empty() ? Result<void>{} : fitShear(*body, dents, options, catalog, fitted);
}

}  // namespace hapticd::importing
