# SPDX-License-Identifier: MIT
# find_package(hapticd): hapticd::abi, hapticd_add_plugin(NAME SOURCE...), hapticd_add_device(NAME SOURCE...)
include(${CMAKE_CURRENT_LIST_DIR}/hapticdTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/HapticdPlugin.cmake)
