// SPDX-License-Identifier: MIT
/// Checks whether the programs that push on arms of running daemons answer in time.
#pragma once
#include <string>
#include <vector>

#include "diagnostics/machine/doctor_checks.hpp"
#include "record/client_report.hpp"
#include "status/page.hpp"

namespace hapticd::diagnostics {

/// A program that pushes now.
struct ClientStatus {
  record::ClientReport report;
  double force = 0;  ///< [N] magnitude of the force that the program asks for now
};

/// [any] Returns the programs on a status page.
std::vector<ClientStatus> clientsOf(const status::Page& page);

/// [main] Checks the programs of all daemons whose status pages are in a folder.
Finding checkClients(const std::string& runtime_folder);

}  // namespace hapticd::diagnostics
