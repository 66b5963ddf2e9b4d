// SPDX-License-Identifier: MIT
/// One row of the table: a scene run in virtual time with the simulated Sarcos-like arm and the operator.
#pragma once
#include <string>
#include <vector>

#include "operator.hpp"
#include "record/contact_statistics.hpp"

namespace hapticd::table1 {

/// One tick.
struct Sample {
  double t = 0, depth = 0;  ///< [s]; [m] > 0 inside
  double force = 0;         ///< [N] on the hand, as commanded
  double felt = 0;          ///< [N] the same as the arm's load cells tell it, along the contact's normal
  double travel = 0;        ///< [m] of the tip along the button's axis, from where it rests
  bool contact = false;
};

struct Recording {
  std::vector<Sample> samples;
  record::ContactStatistics depth;
  std::string fault;  ///< "": none
};

/// [main] Runs `subject` standing still (test 1) or moving (test 2). @param work folder for the files of the scene
/// @throws std::runtime_error with the daemon's own words.
Recording run(const Subject& subject, bool moving, const Protocol& protocol, const std::string& work);

/// [main] The button pressed slowly in and out again, for force against travel.
Recording press(const Subject& button, const Protocol& protocol, const std::string& work);

}  // namespace hapticd::table1
