// SPDX-License-Identifier: MIT
#include "bench.hpp"

int main() {
  hapticd::bench::costs();
  hapticd::bench::network();
}
