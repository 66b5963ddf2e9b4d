// SPDX-License-Identifier: MIT
/// Counts how often a thread gave its processor away, because it slept or waited for something.
#pragma once

namespace hapticd::os {

/// [any] Returns how often the calling thread has waited so far. That the kernel took its processor from it does not
/// count, so the number does not depend on how busy the machine is. It makes a system call.
long waitsOfThread() noexcept;

}  // namespace hapticd::os
