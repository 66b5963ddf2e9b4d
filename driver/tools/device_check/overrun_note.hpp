// SPDX-License-Identifier: MIT
/// What a module wrote or read beyond, told by a child that a fault ends.
#pragma once
#include <string>

#include "hapticd/device.h"

namespace hapticd::device_check {

/// [main] Makes the memory that parent and child share, once and before the child, and forgets the previous child.
void shareOverrun();

/// [main] In the child: from now on a fault in guarded memory, or beyond the sample, is noted before it ends the child.
void noteOverruns();

/// [main] In the child: a sample that ends where an unreadable page begins; nullptr if there is no memory.
hdv_sample* guardedSample();

/// [main] In the parent: "" or what the last child overran, to be added to a message.
std::string overrunWords();

}  // namespace hapticd::device_check
