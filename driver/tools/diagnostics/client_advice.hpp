// SPDX-License-Identifier: MIT
/// Programs that push on arms of running daemons, and whether their answers come in time.
#pragma once
#include <string>
#include <vector>

#include "diagnostics/doctor_checks.hpp"
#include "record/client_report.hpp"
#include "status/page.hpp"

namespace hapticd::diagnostics {

/// A program that pushes now.
struct ClientNow {
  record::ClientReport report;
  double force = 0;  ///< [N] now
};

/// [any] The programs of a status page.
std::vector<ClientNow> clientsOf(const status::Page& page);

/// [main] Checks the programs of all daemons whose status pages are in a folder.
Finding checkClients(const std::string& runtime_folder);

}  // namespace hapticd::diagnostics
