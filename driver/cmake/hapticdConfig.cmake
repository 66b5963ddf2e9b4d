# SPDX-License-Identifier: MIT
# find_package(hapticd): hapticd::abi, hapticd_add_plugin(NAME SOURCE...), hapticd_add_device(NAME SOURCE...)
include(${CMAKE_CURRENT_LIST_DIR}/hapticdTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/HapticdPlugin.cmake)

# hapticd::client, where the library is installed beside the headers
file(GLOB hapticd_client_library ${CMAKE_CURRENT_LIST_DIR}/../../libhapticd.so.0)
if(hapticd_client_library)
  include(${CMAKE_CURRENT_LIST_DIR}/hapticdClientTargets.cmake)
endif()
