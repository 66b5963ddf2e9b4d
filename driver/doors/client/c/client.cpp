// SPDX-License-Identifier: MIT
/// The functions of client.h for the connection and for requests.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "internal.hpp"
#include "status/page_file.hpp"

namespace hapticd::client {

bool RowFile::isFile(const std::string& file) const {
  struct stat info{};
  return stat(file.c_str(), &info) == 0 && info.st_dev == device_ && info.st_ino == inode_;
}

using Json = nlohmann::json;

Mapping::Mapping(int fd, size_t bytes, int protection) : bytes_(bytes) {
  struct stat info{};
  if (fstat(fd, &info) != 0) return;
  const auto size = static_cast<size_t>(info.st_size);
  if (bytes_ == 0) bytes_ = size;
  if (bytes_ == 0 || bytes_ > size) {
    errno = EINVAL;
    return;
  }
  void* memory = mmap(nullptr, bytes_, protection, MAP_SHARED, fd, 0);
  if (memory != MAP_FAILED) data_ = static_cast<std::byte*>(memory);
}

Mapping Mapping::sealed(int fd, size_t bytes, int protection) {
  const int seals = fcntl(fd, F_GET_SEALS);  // fails for whatever is no memory file
  if (seals >= 0 && (seals & F_SEAL_SHRINK) != 0) return {fd, bytes, protection};
  errno = EINVAL;
  return {};
}

Mapping::~Mapping() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

void setError(hapticd_error* error, const char* code, const std::string& text) {
  if (error == nullptr) return;
  *error = {};
  std::strncpy(error->code, code, sizeof error->code - 1);
  std::strncpy(error->text, text.c_str(), sizeof error->text - 1);
}

namespace {

/// Returns the socket of the daemon `name`, in the user's runtime folder or, for a daemon under systemd, in the
/// system's folder.
std::string baseOf(const std::string& name) {
  const std::string own = status::runtimeFolder(false) + "/" + name, system = "/run/hapticd/" + name;
  const auto fileExists = [](const std::string& base) { return access((base + ".sock").c_str(), F_OK) == 0; };
  return !fileExists(own) && fileExists(system) ? system : own;
}

/// Changes a message that mentions the option --name, which a program that uses this library may not have.
std::string forPrograms(std::string text) {
  constexpr std::string_view kOption = "name one of these with --name";
  if (const size_t at = text.find(kOption); at != std::string::npos)
    text.replace(at, kOption.size(), "give hapticd_connect the name of one of these");
  return text;
}

hapticd_client* connect(const std::string& name, hapticd_error* error) {
  const std::string base = baseOf(name);
  auto line = control::Client::connect(base + ".sock");
  if (!line) return setError(error, "gone", forPrograms(line.error())), nullptr;
  auto rows = RowFile::open(base + ".blackbox.h5");
  if (!rows) return setError(error, "damaged", rows.error()), nullptr;
  return new hapticd_client(base, std::move(*line), std::move(*rows));
}

bool refused(const std::string& line, hapticd_error* error) {
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_object() && json.value("ok", false)) return false;
  if (!json.is_object()) return setError(error, "damaged", "the answer is not JSON: " + line), true;
  setError(error, json.value("code", std::string("failed")).c_str(), json.value("error", std::string("refused")));
  return true;
}

}  // namespace

/// Ends a lead with a request, so that the daemon does not report that the program died. If no answer comes, the end of
/// the connection ends the lead.
void endInOrder(hapticd_client& client, const hapticd_lead& lead) try {
  constexpr double kPatience = 0.5;  // [s]
  const std::lock_guard lock(client.asking);
  if (!client.line.ended()) (void)client.line.askForMore(lead.unlead, kPatience);
} catch (const std::exception&) {
  return;
}

}  // namespace hapticd::client

using hapticd::client::Answer;
using hapticd::client::setError;

bool hapticd_client::ask(const std::string& request, Answer& answer, hapticd_error* error) {
  const std::lock_guard lock(asking);
  auto reply = line.askForMore(request);
  if (!reply) return reportSilence(reply.error(), error), false;
  answer = {std::move(reply->line), std::move(reply->descriptor)};
  return !hapticd::client::refused(answer.line, error);
}

void hapticd_client::leave(const std::string& request) {
  const std::lock_guard lock(asking);
  line.leave(request);
}

std::byte* hapticd_client::page(const char* request, hapticd::client::Mapping& kept, size_t least, int protection) {
  const std::lock_guard lock(mapping);
  if (kept.data() != nullptr) return kept.data();
  Answer answer;
  if (!ask(request, answer, nullptr) || !answer.descriptor) return nullptr;
  auto memory = hapticd::client::Mapping::sealed(answer.descriptor.get(), 0, protection);
  if (memory.data() == nullptr || memory.bytes() < least) return nullptr;
  kept = std::move(memory);
  return kept.data();
}

/// Reports why there was no answer: the daemon has ended, it has closed this connection, or it takes too long.
void hapticd_client::reportSilence(const std::string& problem, hapticd_error* error) {
  if (!line.ended()) return setError(error, "timeout", problem);
  // A daemon that ends closes its connections first, so it is asked a few times. [us] between two checks
  constexpr useconds_t kMeanwhile = 20'000;
  for (int i = 0; i < 25; ++i) {
    usleep(kMeanwhile);
    if (ended() || access((base + ".sock").c_str(), F_OK) != 0) return setError(error, "gone", problem);
  }
  setError(error, "too_many",
           "the daemon closed this connection, because it was silent and other programs needed its place\n"
           "  fix: connect again");
}

/// Checks whether the daemon still runs, because the end of the connection does not show it: the daemon may close a
/// connection whose place other programs need.
bool hapticd_client::ended() {
  return line.ended() && hapticd_alive(this) == 0;
}

const char* hapticd_version(void) {
  return HAPTICD_VERSION;
}

hapticd_client* hapticd_connect(const char* name, hapticd_error* error) try {
  setError(error, "", "");
  return hapticd::client::connect(name != nullptr ? name : "hapticd", error);
} catch (const std::exception& problem) {
  setError(error, "failed", problem.what());
  return nullptr;
}

void hapticd_close(hapticd_client* client) {
  if (client == nullptr) return;
  for (const hapticd_lead* lead : client->leads) {
    hapticd::client::endInOrder(*client, *lead);
    delete lead;
  }
  delete client;
}

int hapticd_ended(hapticd_client* client) {
  if (!client->ended()) return 0;
  // An older daemon does not note its end, but it removes its socket if it ends in order.
  if (client->rows.ended() || access((client->base + ".sock").c_str(), F_OK) != 0) return HAPTICD_STOPPED;
  return HAPTICD_CRASHED;
}

int hapticd_alive(hapticd_client* client) {
  if (client->line.ended() && client->rows.ended()) return 0;
  // If the black box was replaced, another daemon has this name.
  if (client->line.ended() && !client->rows.isFile(client->base + ".blackbox.h5")) return 0;
  const std::string file = client->base + ".lock";
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  // The lock file of another user cannot be opened. Then the socket shows it: the socket disappears when the daemon
  // ends.
  if (fd < 0) return errno == EACCES && access((client->base + ".sock").c_str(), F_OK) == 0 ? 1 : 0;
  const bool free = flock(fd, LOCK_SH | LOCK_NB) == 0;
  close(fd);
  return free ? 0 : 1;
}

long hapticd_ask(hapticd_client* client, const char* request, char* answer, size_t bytes, hapticd_error* error) try {
  setError(error, "", "");
  if (std::strchr(request, '\n') != nullptr)
    return setError(error, "bad_request", "a request must be one line, but this one has several"), -1;
  Answer got;
  const bool done = client->ask(request, got, error);
  if (answer != nullptr && bytes > 0) {
    const size_t length = std::min(got.line.size(), bytes - 1);
    std::memcpy(answer, got.line.data(), length);
    answer[length] = '\0';
  }
  return done ? static_cast<long>(got.line.size()) : -1;
} catch (const std::exception& problem) {
  setError(error, "failed", problem.what());
  return -1;
}

const char* hapticd_about(hapticd_client* client) {
  return client->rows.about().c_str();
}

int hapticd_device(hapticd_client* client, const char* name) {
  const auto& devices = client->rows.devices();
  const auto found = std::find(devices.begin(), devices.end(), name);
  return found != devices.end() ? static_cast<int>(found - devices.begin()) : -1;
}

const char* hapticd_device_name(hapticd_client* client, int device) {
  const auto& devices = client->rows.devices();
  return device >= 0 && static_cast<size_t>(device) < devices.size() ? devices[static_cast<size_t>(device)].c_str()
                                                                     : nullptr;
}
