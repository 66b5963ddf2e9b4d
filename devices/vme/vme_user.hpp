// SPDX-License-Identifier: MIT
/// The ioctl interface of Linux' vme_user driver (drivers/staging/vme_user). The kernel does not export its header, so
/// each program must define the structures. Kernels since 3.18 pack the structures, older kernels do not. The size is
/// part of the request number, so a kernel answers a wrong structure with ENOTTY.
#pragma once
#include <sys/ioctl.h>

#include <cstdint>

namespace hapticd::vme {

#pragma pack(push, 1)
struct PackedMaster {
  uint32_t enable;
  uint64_t address, size;
  uint32_t space, cycle, width;
};
struct PackedSlave {
  uint32_t enable;
  uint64_t address, size;
  uint32_t space, cycle;
};
#pragma pack(pop)
struct OldMaster {
  int32_t enable;
  uint64_t address, size;
  uint32_t space, cycle, width;
};
static_assert(sizeof(PackedMaster) == 32 && sizeof(PackedSlave) == 28 && sizeof(OldMaster) == 40, "kernel ABI");

inline constexpr unsigned long kSetSlave = _IOW(0xAE, 2, PackedSlave);
inline constexpr unsigned long kGetMaster = _IOR(0xAE, 3, PackedMaster), kSetMaster = _IOW(0xAE, 4, PackedMaster);
inline constexpr unsigned long kGetOldMaster = _IOR(0xAE, 3, OldMaster), kSetOldMaster = _IOW(0xAE, 4, OldMaster);

inline constexpr uint32_t kA16 = 1, kA24 = 2, kA32 = 4;  // address spaces
inline constexpr uint32_t kD16 = 2, kD32 = 4;            // data widths
inline constexpr uint32_t kSingle = 1;                   // cycles of one datum
inline constexpr uint32_t kSuper = 0x1000, kUser = 0x2000, kProgram = 0x4000, kData = 0x8000;
inline constexpr uint64_t kGranule = 0x10000;  // base and size are multiples of this, because of the bridge

}  // namespace hapticd::vme
