// SPDX-License-Identifier: MIT
/// Runs one row of the table: a scene in virtual time, with the simulated Sarcos-like arm and the operator.
#pragma once
#include <string>
#include <vector>

#include "operator.hpp"
#include "record/contact_statistics.hpp"

namespace hapticd::table1 {

/// The measurements of one tick.
struct Sample {
  double t = 0, depth = 0;  ///< [s] time; [m] depth, > 0 inside
  double force = 0;         ///< [N] commanded force on the hand
  double felt = 0;          ///< [N] force that the arm's load cells measure, along the contact's normal
  double travel = 0;        ///< [m] travel of the tip along the button's axis, from the surface of the button at rest
  bool contact = false;
};

struct Recording {
  std::vector<Sample> samples;
  record::ContactStatistics depth;
  std::string fault;  ///< "" if there was none
};

/// [main] Runs `subject` at rest (test 1) or moving (test 2). @param work folder for the files of the scene
/// @throws std::runtime_error with the message of the daemon.
Recording run(const Subject& subject, bool moving, const Protocol& protocol, const std::string& work);

/// [main] Presses the button slowly in and out again, to record force against travel.
Recording press(const Subject& button, const Protocol& protocol, const std::string& work);

}  // namespace hapticd::table1
