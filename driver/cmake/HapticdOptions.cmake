# SPDX-License-Identifier: MIT
# What every target shares: language level, warnings as errors, sanitizers, where artefacts land.

option(HAPTICD_TESTS "build the tests" ON)
option(HAPTICD_BENCH "build the benchmarks; they need the packages of driver/install-packages bench" OFF)
option(HAPTICD_WERROR "treat warnings as errors; the presets of developers do, a packager's newer compiler must not fail" OFF)
set(HAPTICD_SANITIZE "" CACHE STRING "sanitizers, for example 'address,undefined', 'thread' or 'realtime' (clang 20 and newer)")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(HAPTICD_CCACHE ccache)
if(HAPTICD_CCACHE) # paths below the checkout are taken as relative, so that another checkout finds what this one built
  set(ccache env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${HAPTICD_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${ccache})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ccache})
endif()

# One tree in the build folder that looks like an installation, so that the daemon finds its plugins in both alike.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(HAPTICD_MODULE_DIR lib/hapticd) # plugins/ and devices/ below it

if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(HAPTICD_ARM64 ON)
endif()
add_library(hapticd_options INTERFACE)
target_compile_options(hapticd_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${HAPTICD_WERROR}>:-Werror>
  # std::stable_sort of libstdc++ 12 calls a deprecated function of its own, and clang 22 warns of it at each use; g++ still
  # warns of deprecated calls in our code
  $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-deprecated-declarations>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # g++ 12 sees overlaps in std::string operator+ that are not there (GCC 105651)
  # a unity build includes sources; g++ takes them for headers and warns of types in their anonymous namespaces
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<COMPILE_LANG_AND_ID:CXX,GNU>>:-Wno-subobject-linkage>
  # g++ collects garbage from 512 MB on, not from 128: a sixth of its time was that
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>
  # errno and traps are never read from mathematics here; both keep sqrt and fma out of line.
  -fno-math-errno -fno-trapping-math
  # The same bits on every machine: no product is fused with a sum, unless a source asks for it. On arm64 Eigen would fuse by
  # intrinsics where it sees this macro.
  -ffp-contract=off $<$<BOOL:${HAPTICD_ARM64}>:-U__ARM_FEATURE_FMA>)
# With precompiled headers g++ 12 gives false warnings about std::string. The other presets keep these warnings.
set(HAPTICD_PRECOMPILED_WARNINGS -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
if(HAPTICD_SANITIZE)
  add_compile_options(-fsanitize=${HAPTICD_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${HAPTICD_SANITIZE})
  add_compile_definitions(HAPTICD_SANITIZED=1)
  if(HAPTICD_SANITIZE STREQUAL "thread")
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>) # fences are not modelled; what they order is atomic as well
  endif()
endif()
