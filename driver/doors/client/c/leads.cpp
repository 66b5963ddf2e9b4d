// SPDX-License-Identifier: MIT
/// The functions of client.h for leads. A lead is memory that this program writes and the servo reads once per tick.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "internal.hpp"
#include "link/lead.hpp"

namespace {

using hapticd::client::Answer;
using hapticd::client::setError;

/// Returns why the arm gets no force, as the daemon reports it, or "" if the arm gets the force.
std::string noForce(const std::string& answer) {
  const auto json = nlohmann::json::parse(answer, nullptr, false);
  const auto found = json.is_object() ? json.find("no_force") : json.end();
  return json.is_object() && found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string requestOf(const char* word, const char* what, const char* name) {
  const nlohmann::json request = {{"do", word}, {what, name}};
  return request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

hapticd_lead* leadOf(hapticd_client* client, const char* what, const char* name, hapticd_error* error) try {
  hapticd_error unread;
  hapticd_error* const told = error == nullptr ? &unread : error;
  setError(told, "", "");
  const std::string begin = requestOf("lead", what, name), end = requestOf("unlead", what, name);
  Answer answer;
  if (!client->ask(begin, answer, told)) {
    if (std::strcmp(told->code, "timeout") == 0) client->leave(end);  // ends the lead, because it may have begun
    return nullptr;
  }
  auto memory = hapticd::client::Mapping::sealed(answer.descriptor.get(), HAPTICD_LEAD_BYTES, PROT_READ | PROT_WRITE);
  if (memory.data() == nullptr) return setError(told, "damaged", "the memory of the lead cannot be mapped"), nullptr;
  auto* lead = new hapticd_lead{client, end, std::string_view(what) == "force", std::move(memory)};
  client->leads.push_back(lead);
  if (const std::string why = noForce(answer.line); !why.empty()) setError(told, "no_force", why);
  return lead;
} catch (const std::exception& problem) {
  setError(error, "failed", problem.what());
  return nullptr;
}

}  // namespace

hapticd_lead* hapticd_lead_model(hapticd_client* client, const char* model, hapticd_error* error) {
  return leadOf(client, "model", model, error);
}

hapticd_lead* hapticd_lead_hand(hapticd_client* client, const char* device, hapticd_error* error) {
  return leadOf(client, "hand", device, error);
}

hapticd_lead* hapticd_lead_force(hapticd_client* client, const char* device, hapticd_error* error) {
  return leadOf(client, "force", device, error);
}

int hapticd_lead_put(hapticd_lead* lead, const hapticd_target* target) {
  if (lead->pushes || lead->client->line.ended()) return -1;
  reinterpret_cast<hapticd::link::PoseSlot*>(lead->memory.data())->put(*target);
  return 0;
}

int hapticd_lead_push(hapticd_lead* lead, const hapticd_push* push) {
  if (!lead->pushes || lead->client->line.ended()) return -1;
  // The numbers are checked here, because the daemon would refuse and count such a record without an answer to this
  // program.
  for (const double* numbers : {push->force, push->torque})
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(numbers[i]) <= hapticd::link::kLargestPush)) return -1;
  reinterpret_cast<hapticd::link::PushSlot*>(lead->memory.data())->put(*push);
  return 0;
}

void hapticd_lead_end(hapticd_lead* lead) try {
  if (lead == nullptr) return;
  Answer answer;
  (void)lead->client->ask(lead->unlead, answer,
                          nullptr);  // if refused, the lead has ended already
  lead->client->leads.remove(lead);
  delete lead;
} catch (const std::exception&) {
}
