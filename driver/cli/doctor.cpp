// SPDX-License-Identifier: MIT
/// `hapticd doctor`: checks for everything that keeps real time or a device from working, and prints the command that
/// fixes each problem.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/support/colour.hpp"
#include "cli/support/command.hpp"
#include "diagnostics/machine/arm_checks.hpp"
#include "diagnostics/machine/client_warnings.hpp"
#include "diagnostics/machine/doctor_checks.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

using namespace diagnostics;

namespace {

const char* word(Verdict verdict) {
  return verdict == Verdict::kOk ? "ok" : verdict == Verdict::kWarn ? "warn" : "fail";
}

void print(const Finding& finding) {
  const Colour colour = finding.verdict == Verdict::kOk     ? Colour::kGood
                        : finding.verdict == Verdict::kWarn ? Colour::kWarning
                                                            : Colour::kBad;
  const std::string verdict = word(finding.verdict);
  std::printf("%s%-*s %-16s %s\n", coloured(verdict, colour).c_str(), static_cast<int>(5 - verdict.size()), "",
              finding.name.c_str(), finding.state.c_str());
  if (finding.verdict == Verdict::kOk) return;
  std::printf("      %-16s %s\n", "", finding.consequence.c_str());
  std::printf("      %-16s fix: %s\n", "", finding.fix.c_str());
}

/// Returns the exit code: 0 if all is well, 1 with warnings, 2 if a check fails.
int doctor(const std::vector<std::string>& arms, bool json, double seconds) {
  std::vector<Finding> findings = checkSystem(catalog());
  findings.push_back(checkClients(status::runtimeFolder(false)));
  for (const std::string& file : arms)
    for (const Finding& finding : checkArm(file, catalog())) findings.push_back(finding);
  if (!json)
    for (const Finding& finding : findings) print(finding);
  if (seconds > 0) {
    if (!json) std::fprintf(stderr, "measuring latency for %.0f s ...\n", seconds);
    findings.push_back(checkLatency(seconds));
    if (!json) print(findings.back());
  }
  Verdict worst = Verdict::kOk;
  for (const Finding& finding : findings) worst = std::max(worst, finding.verdict);
  if (json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const Finding& f : findings)
      all.push_back({{"name", f.name},
                     {"verdict", word(f.verdict)},
                     {"state", f.state},
                     {"consequence", f.consequence},
                     {"fix", f.fix}});
    printJson({{"ok", worst != Verdict::kFail}, {"verdict", word(worst)}, {"checks", all}});
  }
  return static_cast<int>(worst);
}

}  // namespace

void addDoctor(const Command& app, int& exit_code) {
  auto json = std::make_shared<bool>(false);
  auto seconds = std::make_shared<double>(10);
  auto arms = std::make_shared<std::vector<std::string>>();
  const Command command = app.addSubcommand("doctor",
                                            "Check this machine: find problems with real-time scheduling and devices, "
                                            "and print the command that fixes each.");
  command.addOption("devices", *arms, "device files (YAML) of arms to check as well");
  command.addFlag("--json", *json, "print JSON, for issue reports");
  command.addOption("--seconds", *seconds, "duration of the latency test [s]; 0: no test")
      .within(0.0, 3600.0)
      .showDefault();
  command.footer(
      "The exit code is 0 if all checks pass, 1 with warnings, 2 if a check fails.\n\nExamples:\n  hapticd doctor "
      "--json > doctor.json\n  hapticd doctor config/devices/premium15.yaml --seconds 0");
  command.callback([=, &exit_code] { exit_code = doctor(*arms, *json, *seconds); });
}

}  // namespace hapticd::cli
