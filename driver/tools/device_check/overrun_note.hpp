// SPDX-License-Identifier: MIT
/// If a module writes or reads beyond a block of memory, and this ends its child process: reports to the parent which
/// block.
#pragma once
#include <string>

#include "hapticd/device.h"

namespace hapticd::device_check {

/// [main] Makes the memory that parent and child share, if there is none yet, and clears it. Call it before each child
/// is started.
void shareOverrun();

/// [main] In the child: from now on a fault in guarded memory, or beyond the sample, is noted before it ends the child.
void noteOverruns();

/// [main] In the child: returns a sample that ends where an unreadable page begins, or nullptr if there is no memory.
hdv_sample* guardedSample();

/// [main] In the parent: returns what the last child overran, to be added to a message, or "".
std::string overrunWords();

}  // namespace hapticd::device_check
