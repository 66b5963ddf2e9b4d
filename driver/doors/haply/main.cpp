// SPDX-License-Identifier: MIT
/// `hapticd-inverse-service`: offers the arms of a running daemon to programs that were written for Haply's Inverse
/// Service.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <list>
#include <thread>

#include "command_line/command_line.hpp"
#include "session.hpp"
#include "websocket/channel.hpp"

namespace {

using namespace hapticd;

constexpr int kFailed = 1, kMostSessions = 4, kLookMs = 200;

std::atomic<bool> told_to_end{false};

void onEnd(int) {
  told_to_end = true;
}

void print(int number, const std::string& what) {
  if (!what.empty()) std::fprintf(stderr, "program %d: %s\n", number, what.c_str());
}

/// Serves one program, until it leaves or the daemon ends.
void serveProgram(websocket::Channel& channel, const std::string& daemon, int number) {
  constexpr int kSendMs = 2000;
  auto session = haply::Session::open(daemon, number);
  if (!session) return print(number, session.error());
  std::string text = (*session)->inventory();
  while (!text.empty() && !told_to_end && channel.send(text, kSendMs)) {
    constexpr int kSilentMs = 30'000;  // [ms] a program that is silent for longer counts as gone
    const auto message = channel.receive(kSilentMs);
    if (!message) return;
    text = (*session)->answer(*message);
    print(number, (*session)->takeProblem());
  }
  if (text.empty()) print(number, "the daemon reports no more ticks");
}

struct ProgramThread {
  std::thread thread;
  std::atomic<bool> over{false};
};

void serve(websocket::Listener& listener, const std::string& daemon) {
  std::list<ProgramThread> visits;
  for (int number = 1; !told_to_end;) {
    visits.remove_if([](ProgramThread& visit) {
      if (visit.over) visit.thread.join();
      return visit.over.load();
    });
    std::shared_ptr<websocket::Channel> channel = listener.accept(kLookMs);
    if (!channel || visits.size() >= kMostSessions) continue;
    ProgramThread& visit = visits.emplace_back();
    visit.thread = std::thread([&visit, channel, daemon, number] {
      serveProgram(*channel, daemon, number);
      visit.over = true;
    });
    ++number;
  }
  std::fflush(nullptr);
  std::_Exit(0);  // ends without waiting for silent programs; the daemon ends their forces when the connection ends
}

}  // namespace

int main(int count, char** words) {
  std::string daemon = "hapticd";
  unsigned short port = 10001;
  const command_line::Program app(
      "Offers the arms of a running hapticd through the interface of Haply's Inverse Service (WebSocket, JSON).");
  app.addOption("--name", daemon, "name of the daemon, as given to `hapticd run --name`").showDefault();
  app.addOption("--port", port, "port on 127.0.0.1; 0 for any free port").showDefault();
  app.footer("Example:\n  hapticd-inverse-service --port 10001");
  if (const auto ended = app.parse(count, words)) return *ended;
  auto first = haply::Session::open(daemon, 0);
  if (!first) return std::fprintf(stderr, "error: %s\n", first.error().c_str()), kFailed;
  auto listener = websocket::Listener::listen(port);
  if (!listener) return std::fprintf(stderr, "error: %s\n", listener.error().c_str()), kFailed;
  std::signal(SIGINT, onEnd);
  std::signal(SIGTERM, onEnd);
  std::signal(SIGPIPE, SIG_IGN);
  std::printf("ws://127.0.0.1:%u\n", (*listener)->port());
  std::fflush(stdout);
  serve(**listener, daemon);
  return 0;
}
