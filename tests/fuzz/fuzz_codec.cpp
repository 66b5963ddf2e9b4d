// SPDX-License-Identifier: MIT
/// Sends a million mutated reports through every shipped codec. The results of decoder, framer and session must stay
/// finite and within bounds. Usage: fuzz_codec [REPORTS]. It is not guided by coverage, because the formats are flat
/// and it must run in every build.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "emulators/wire_file.hpp"
#include "support/random_wire.hpp"
#include "wire_arm/session.hpp"

namespace {

using hapticd::Nanoseconds;

/// Returns bytes that are nearly a report: a valid report with some bytes changed, cut off or added.
std::vector<uint8_t> mutated(hapticd::codec::Report report, uint32_t sequence, std::mt19937_64& random) {
  using hapticd::codec::Role;
  for (hapticd::codec::Field& field : report.fields) {  // the arm writes positions, which encode() takes as torques
    if (field.role == Role::kPosition) field.role = Role::kTorque;
    if (field.role == Role::kCalibrated || field.role == Role::kButton) field.role = Role::kEnable;
  }
  std::vector<uint8_t> bytes(report.bytes());
  hapticd::codec::Order order;
  order.enable = true;
  order.sequence = sequence;
  for (double& torque : order.torque) torque = 0.6 + std::ldexp(static_cast<double>(random() % 2001) - 1000, -14);
  (void)hapticd::codec::encode(report, order, bytes);
  const auto changes = random() % 8 == 0 ? random() % 6 : 0;
  for (uint64_t i = 0; i < changes && !bytes.empty(); ++i)
    bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
  if (random() % 8 == 0) bytes.resize(random() % 1200);
  if (random() % 64 == 0)
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
  return bytes;
}

/// Sends `reports` mutated reports to a session. Returns 0 if all results are valid. @param must_take true if at least
/// one report must be accepted
int run(const std::string& name, const hapticd::codec::Wire& wire, size_t joints, long reports, bool must_take) {
  hapticd::wire_arm::SessionSettings settings;
  settings.joints = joints;
  hapticd::wire_arm::Session session(wire, settings);
  std::mt19937_64 random(1);
  Nanoseconds now = 1;
  session.attach(now, {}, true);
  long good = 0;
  for (long i = 0; i < reports; ++i) {
    now += random() % 2'000'000;
    std::vector<uint8_t> bytes = mutated(wire.input, static_cast<uint32_t>(i), random);
    if (wire.framing.used) bytes.insert(bytes.begin(), wire.framing.header, 1);
    good += session.receive(now, bytes) ? 1 : 0;
    session.watch(now);
    hapticd::wire_arm::ArmCommand wanted;
    wanted.time = now, wanted.sequence = 1, wanted.on = true;
    wanted.torque.fill(random() % 16 == 0 ? std::nan("") : 1.0);
    wanted.follow = random() % 2 == 0;
    wanted.position.fill(random() % 16 == 0 ? std::nan("") : 1.0);
    std::array<uint8_t, hapticd::codec::kMaxReportBytes + 1> out;
    const size_t size = session.command(now, wanted, out);
    const bool whole = wire.framing.escape.used ? size >= wire.output.bytes() : size == wire.output.bytes();
    if (!whole) return std::printf("%s: no command\n", name.c_str());
    for (const double position : session.sample().position)
      if (!std::isfinite(position)) return std::printf("%s: %g in report %ld\n", name.c_str(), position, i);
    if (random() % 100'000 == 0) session.attach(now, {}, true);
  }
  if (must_take)
    std::printf("%-22s %ld reports, %ld taken, %s\n", name.c_str(), reports, good, describe(session.trouble()));
  return must_take && good == 0 ? 1 : 0;
}

/// Changes some characters of a wire format. The reader must refuse it, or it must be safe to run.
int runBroken(std::string text, size_t joints, std::mt19937_64& random, long reports) {
  static const char kLetters[] = "0123456789-{}[]\",:iuf.eE ";
  for (auto changes = 1 + random() % 4; changes > 0; --changes)
    text[random() % text.size()] = kLetters[random() % (sizeof kLetters - 1)];
  try {
    return run("broken", hapticd::codec::readWire(text, joints), joints, reports, false);
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

/// Runs random wire formats, with all widths, offsets, byte orders, checksums and escapes.
int runRandom(long formats) {
  std::mt19937_64 random(11);
  int failed = 0;
  long refused = 0;
  for (long i = 0; i < formats && failed == 0; ++i) {
    hapticd::codec::RandomWire format(static_cast<uint64_t>(i));
    hapticd::codec::Wire wire = format.wire();
    if (i % 3 == 0) {
      wire.framing.used = wire.framing.escape.used = true;
      wire.framing.start = static_cast<int>(random() % 256), wire.framing.end = static_cast<int>(random() % 256);
      wire.framing.escape.mark = static_cast<uint8_t>(random());
    }
    failed = run("random " + std::to_string(i), wire, format.joints(), 200, false);
    for (int k = 0; k < 20 && failed == 0; ++k, ++refused)
      failed = runBroken(format.text(), format.joints(), random, 5);
  }
  std::printf("%-22s %ld formats, %ld broken descriptions\n", "random", formats, refused);
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  const long reports = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  int failed = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HAPTICD_SOURCE_DIR "/config/devices"))
    if (YAML::LoadFile(entry.path())["parameters"]["wire"]) {
      const size_t joints = hapticd::emulator::jointsOf(entry.path());
      const auto wire = hapticd::codec::readWire(hapticd::emulator::wireOf(entry.path()), joints);
      failed |= run(entry.path().filename(), wire, joints, reports, true);
    }
  failed |= runRandom(reports / 1000);
  return failed != 0 ? 1 : 0;
}
