// SPDX-License-Identifier: MIT
#include "link.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "errors.hpp"

namespace hapticd::hd {

namespace {

struct Close {
  void operator()(hapticd_client* client) const { hapticd_close(client); }
};

std::string namesOf(hapticd_client* client) {
  std::string names;
  for (int i = 0; hapticd_device_name(client, i) != nullptr; ++i)
    names += (i > 0 ? ", \"" : "\"") + std::string(hapticd_device_name(client, i)) + '"';
  return names;
}

/// Returns the byte at which a column begins in its row, or -1 if there is no such column.
long placeOf(const hapticd_column* columns, long count, const char* name) {
  for (long i = 0; i < count; ++i)
    if (std::strcmp(columns[i].name, name) == 0) return columns[i].offset;
  return -1;
}

/// Returns the message for a user of an HDAPI program, which never calls hapticd_connect, if no daemon runs.
/// @param number errno of the connection
std::string forPrograms(std::string text, int number) {
  constexpr std::string_view kFix = "\n  fix: ";
  const size_t cure = number == ENOENT || number == ECONNREFUSED ? text.find(kFix) : std::string::npos;
  if (cure == std::string::npos) return text;
  return text.substr(0, cure + kFix.size()) +
         "start this program with hapticd client PROGRAM, which starts a daemon too, or start one with hapticd run; "
         "$HAPTICD_NAME names the daemon";
}

}  // namespace

std::shared_ptr<Link> Link::open(const std::string& name, DeviceFacts& facts, std::string& why, int& number) {
  const char* wanted = std::getenv("HAPTICD_NAME");
  hapticd_error error;
  errno = 0;
  std::unique_ptr<hapticd_client, Close> client(
      hapticd_connect(wanted != nullptr && *wanted != '\0' ? wanted : nullptr, &error));
  number = client ? 0 : errno != 0 ? errno : ECONNREFUSED;
  if (!client) return why = forPrograms(error.text, number), nullptr;
  const int device = name.empty() ? 0 : hapticd_device(client.get(), name.c_str());
  if (device < 0 || hapticd_device_name(client.get(), device) == nullptr) {
    why = "the daemon has no device \"" + name + "\"; it has " + namesOf(client.get()) +
          "\n  fix: one of these names, or HD_DEFAULT_DEVICE for the first";
    return nullptr;
  }
  if (!readFacts(hapticd_about(client.get()), device, facts)) {
    why =
        "the daemon's description of itself cannot be understood: it is of another version\n  fix: restart the daemon";
    return nullptr;
  }
  hapticd_state first;
  constexpr int kFirstMs = 1000;
  if (hapticd_next_state(client.get(), device, UINT64_MAX, kFirstMs, &first) != 1)
    return why = "the daemon has reported no tick for 1 s", nullptr;
  auto link = std::make_shared<Link>(client.get(), device);
  (void)client.release();
  return link;
}

bool Link::lead(std::string& why) {
  if (leads()) return true;
  hapticd_error error;
  lead_ = hapticd_lead_force(client_, hapticd_device_name(client_, device_), &error);
  if (!leads()) return why = error.text, false;
  if (std::strcmp(error.code, "no_force") == 0) hintOnce(keptForever(error.text));
  return true;
}

void Link::temperatures(double* of_joint, size_t most) const {
  constexpr size_t kRows = 64;
  const int stream = hapticd_stream(client_, "motors");
  const hapticd_column* columns = nullptr;
  size_t bytes = 0;
  const long count = hapticd_columns(client_, stream, &columns, &bytes);
  const long arm = placeOf(columns, count, "arm"), joint = placeOf(columns, count, "joint"),
             winding = placeOf(columns, count, "winding");
  if (arm < 0 || joint < 0 || winding < 0) return;
  const uint64_t written = hapticd_written(client_, stream);
  uint64_t row = written > kRows ? written - kRows : 0;
  std::vector<char> rows(kRows * bytes);
  const long got = hapticd_read(client_, stream, &row, rows.data(), kRows);
  for (long i = 0; i < got; ++i) {
    const char* at = rows.data() + static_cast<size_t>(i) * bytes;
    uint32_t of_arm = 0, of = 0;
    std::memcpy(&of_arm, at + arm, sizeof of_arm);
    std::memcpy(&of, at + joint, sizeof of);
    if (of_arm == static_cast<uint32_t>(device_) && of < most) std::memcpy(&of_joint[of], at + winding, sizeof(double));
  }
}

}  // namespace hapticd::hd
