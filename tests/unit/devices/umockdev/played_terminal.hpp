// SPDX-License-Identifier: MIT
/// The node of a played device. umockdev's plain files are always ready, so the node is a pseudo-terminal: it is ready
/// when its player makes it so, and its closed master is an unplugged device.
#pragma once
#include <pty.h>
#include <termios.h>
#include <umockdev.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace hapticd::emulator {

struct PlayedTerminal {
  int master = -1, slave = -1;

  /// Opens a pseudo-terminal in the place of the testbed's file `node`.
  void open(UMockdevTestbed* testbed, const std::string& node) {
    char name[64];
    termios how{};
    if (openpty(&master, &slave, name, nullptr, nullptr) != 0) throw std::runtime_error("no pseudo-terminal");
    tcgetattr(slave, &how);
    cfmakeraw(&how);
    tcsetattr(slave, TCSANOW, &how);
    char* root = umockdev_testbed_get_root_dir(testbed);
    const std::string path = root + node;
    g_free(root);
    ::unlink(path.c_str());
    if (::symlink(name, path.c_str()) != 0) throw std::runtime_error("no link to the pseudo-terminal");
  }
  void close() {
    ::close(master);
    ::close(slave);
    master = slave = -1;
  }
};

}  // namespace hapticd::emulator
