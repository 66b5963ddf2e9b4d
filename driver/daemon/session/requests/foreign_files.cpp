// SPDX-License-Identifier: MIT
#include "session/requests/foreign_files.hpp"

#include <unistd.h>

#include "hapticd/abi.h"

namespace hapticd::servo {

bool isForeign(const control::Peer& peer) {
  return peer.uid != geteuid() && peer.uid != 0;
}

scene::Model withPaths(scene::Model model, const PassedFiles& files) {
  for (scene::Value& value : model.parameters)
    if (value.kind == HSP_PATH && !value.text.empty()) value.text = files.pathOf(value.text);
  return model;
}

}  // namespace hapticd::servo
