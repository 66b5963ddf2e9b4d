// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/class_table.hpp"
#include "live_status/live_status.hpp"

namespace hapticd::live_status {
namespace {

/// Returns the table of programs that push; "" if none does.
std::string clientsTable(const LiveStatus& live) {
  if (live.clients.empty()) return "";
  std::string text = fmt::format("\n{:<28} {:>8} {:<16} {:>9} {:>9} {:>11} {:>11} {:>7}  {}\n", "PROGRAM", "PID",
                                 "DEVICE", "FORCE N", "MAX N", "SAME TICK %", "NEXT TICK %", "SILENT", "ANSWERS");
  bool late = false;
  for (const auto& [client, force] : live.clients) {
    text += fmt::format("{:<28.28} {:>8} {:<16.16} {:9.3f} {:9.3f} {:11.1f} {:11.1f} {:7}  {}{}\n", client.program,
                        client.pid, client.device, force, client.largest_n, 100 * client.sameTick(),
                        100 * client.nextTick(), client.silences, client.answers, record::late(client) ? "  LATE" : "");
    late = late || record::late(client);
  }
  if (late) text += "late: " + record::lateFix(live.answer_time) + "\n";
  return text;
}

/// Returns the word of the column STATUS.
std::string statusOf(const ModelLine& model) {
  if (!model.silenced.empty()) return "SILENCED";
  if (model.now.waits != 0) return "waits for the tip to leave it";
  const std::string end = model.end();
  if (!end.empty() && model.now.status == HSP_OK) return "at its " + end + " end";
  return model.now.status == HSP_OK ? "ok" : host::statusText(model.now.status);
}

/// Returns the share of the ticks in which the foot point was certain: it was the nearest point, or the contact was
/// held. Ticks without a foot point do not count.
std::string knownShare(const status::ModelFeet& feet) {
  const uint64_t known = feet.nearest + feet.held, all = known + feet.degraded;
  if (all == 0) return "-";
  const double percent = std::floor(1000.0 * static_cast<double>(known) / static_cast<double>(all)) / 10;
  return fmt::format("{:.1f}%", percent);  // rounded down, so that 100 % means all
}

}  // namespace

std::string table(const LiveStatus& live, size_t rows) {
  std::string text = fmt::format(
      "{:10.1f} s   {:.0f} Hz asked, {:.0f} held   {} missed   late {:.1f} / {:.1f} / {:.0f} us   tick {:.1f} / {:.1f} "
      "/ "
      "{:.0f} us  (p50 / p99 / max)\n\n",
      live.now.t, live.rate, live.held, live.now.missed, live.late[0], live.late[1], live.late[2], live.compute[0],
      live.compute[1], live.compute[2]);
  text += fmt::format("{:<28} {:<16} {:>9} {:>26} {:>12}  {}\n", "DEVICE", "MODULE", "FORCE N", "TIP x y z mm",
                      "SAMPLES", "FAULT");
  for (const ArmLine& arm : live.arms)
    text += fmt::format("{:<28.28} {:<16.16} {:9.3f} {:8.1f} {:8.1f} {:8.1f} {:12}  {}\n", arm.name, arm.module,
                        arm.force(), 1e3 * arm.now.position[0], 1e3 * arm.now.position[1], 1e3 * arm.now.position[2],
                        arm.now.sequence, arm.fault());
  text += clientsTable(live);
  text += fmt::format("\n{:<28} {:<16} {:>9} {:>9} {:>8} {:>8} {:>8} {:>5} {:>7}  {}\n", "MODEL", "PLUGIN", "FORCE N",
                      "DEPTH mm", "p50 us", "p99 us", "max us", "ITER", "KNOWN", "STATUS");
  for (size_t i = 0; i < std::min(rows, live.models.size()); ++i) {
    const ModelLine& m = live.models[i];
    const std::string depth = m.traced ? fmt::format("{:.3f}", m.now.depth * 1e3) : "-";
    text += fmt::format("{:<28.28} {:<16.16} {:9.3f} {:>9} {:8.2f} {:8.2f} {:8.1f} {:5} {:>7}  {}\n", m.name, m.plugin,
                        m.now.force, depth, m.p50, m.p99, m.max, m.now.iterations, knownShare(m.feet), statusOf(m));
  }
  if (live.models.size() > rows) text += fmt::format("... and {} more\n", live.models.size() - rows);
  for (const ModelLine& m : live.models)
    if (!m.silenced.empty()) text += m.silenced + "\n";
  return text;
}

}  // namespace hapticd::live_status
