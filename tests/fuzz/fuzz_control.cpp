// SPDX-License-Identifier: MIT
/// Fuzzes the requests to the control socket.
#include "control/request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto request = hapticd::control::parseRequest({reinterpret_cast<const char*>(data), size});
  const std::string told = request ? request->model + request->file : hapticd::control::refusal(request.error());
  return told.size() > 1 << 20 ? 1 : 0;
}
