// SPDX-License-Identifier: MIT
/// The table of parameters of a class, also of a newer plugin whose records are longer.
#include "host/class_params.hpp"

#include <gtest/gtest.h>

#include "hapticd/shape.h"

namespace hapticd::host {
namespace {

/// A record of a later version of the ABI.
struct Longer {
  hsp_param known;
  double more[3];
};

TEST(ClassParams, AreFoundByTheirIdInRecordsOfAnySize) {
  Longer records[3] = {};
  const char* const ids[] = {"stiffness", "geometry", "inner.mass"};
  for (size_t i = 0; i < std::size(records); ++i) {
    records[i].known.struct_size = sizeof(Longer);
    records[i].known.id = ids[i];
    records[i].known.def = static_cast<double>(i);
  }
  hsp_class shape = {};
  shape.params = &records[0].known;
  shape.param_count = std::size(records);
  for (uint32_t i = 0; i < shape.param_count; ++i) {
    EXPECT_EQ(paramAt(shape, i).def, i);
    EXPECT_EQ(paramIndexOf(shape, ids[i]), i);
  }
  EXPECT_FALSE(paramIndexOf(shape, "mass"));
  EXPECT_FALSE(paramIndexOf(hsp_class{}, "stiffness"));
}

}  // namespace
}  // namespace hapticd::host
