// SPDX-License-Identifier: MIT
#include "diagnostics/machine/client_warnings.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "status/page_file.hpp"

namespace hapticd::diagnostics {

namespace {

namespace fs = std::filesystem;

template <size_t Size>
std::string textOf(const char (&text)[Size]) {
  return {text, strnlen(text, Size)};
}

/// Returns true if a thread of the process has real-time priority.
bool hasFifo(int pid) {
  std::error_code error;
  for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(pid) + "/task", error)) {
    const int policy = sched_getscheduler(std::atoi(thread.path().filename().c_str()));
    if (policy == SCHED_FIFO || policy == SCHED_RR) return true;
  }
  return false;
}

bool isAlive(const status::Page& page) {
  return kill(static_cast<pid_t>(page.pid), 0) == 0 || errno == EPERM;
}

std::string stateOf(const record::ClientReport& client) {
  return fmt::format("program {} (pid {}) answers {} in time in {:.0f} % of {} ticks{}", client.program, client.pid,
                     client.device, 100 * client.sameTick(), client.answers,
                     client.silences > 0 ? fmt::format(", silent {} times", client.silences) : "");
}

std::string fixFor(const record::ClientReport& client, double answer_time) {
  if (!hasFifo(client.pid))
    return "give it real-time priority (SCHED_FIFO 70: sudo usermod -aG haptic $USER, log in again)" +
           std::string(answer_time > 0 ? "" : "; then clients: {mode: add, answer_time: 60e-6} in the scene");
  return record::lateFix(answer_time);
}

Finding checkAnswers(const std::vector<ClientStatus>& clients, double answer_time, Finding before) {
  for (const ClientStatus& client : clients) {
    const bool late = record::late(client.report);
    const bool first = before.state.empty();
    // programs in time are not listed beside late ones
    if (!first && before.verdict != Verdict::kOk && !late) continue;
    if (late && before.verdict == Verdict::kOk) before = {before.name, Verdict::kWarn, "", "", ""};
    before.state += (before.state.empty() ? "" : "; ") + stateOf(client.report);
    if (!late) continue;
    before.consequence = "one tick of delay cuts the stiffest stable wall to a third";
    if (before.fix.empty()) before.fix = fixFor(client.report, answer_time);
  }
  return before;
}

}  // namespace

std::vector<ClientStatus> clientsOf(const status::Page& page) {
  std::vector<ClientStatus> clients;
  for (uint32_t i = 0; i < std::min(page.arms, status::kMaxArms) * status::kPushersOfArm; ++i) {
    const auto who = page.pusher[i].who.read().value_or(status::Pusher{});
    if (who.pid == 0) continue;
    const auto now = page.pusher[i].now.read().value_or(status::PusherStatus{});
    const auto arm = page.arm[i / status::kPushersOfArm].name.read().value_or(status::Name{});
    ClientStatus& client = clients.emplace_back();
    client.report.device = textOf(arm.text);
    client.report.program = textOf(who.program);
    client.report.pid = static_cast<int>(who.pid);
    client.report.answers = now.answers;
    client.report.in_time = now.in_time;
    client.report.next_tick = now.next_tick;
    client.report.silences = now.silences;
    client.report.largest_n = now.largest;
    client.force = now.force;
  }
  return clients;
}

Finding checkClients(const std::string& runtime_folder) {
  Finding finding{"clients", Verdict::kOk, "", "", ""};
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(runtime_folder, error))
    if (file.path().extension() == ".status") files.push_back(file.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const auto opened = status::PageFile::open(file.string());
    if (!opened) continue;  // a page of another version, or of another program
    const status::Page& page = std::as_const(**opened).page();
    if (isAlive(page)) finding = checkAnswers(clientsOf(page), page.answer_time, std::move(finding));
  }
  if (finding.state.empty()) finding.state = "no program pushes on an arm of a running daemon";
  return finding;
}

}  // namespace hapticd::diagnostics
