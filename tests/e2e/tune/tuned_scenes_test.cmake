# SPDX-License-Identifier: MIT
# cmake -P: a scene that `hapticd tune --write` made gets no tests of its own.
include(${CMAKE_CURRENT_LIST_DIR}/../shipped_scenes.cmake)
set(scenes /a/sphere.yaml /a/sphere.tuned.yaml /a/my.tuned.scene.yaml)
hapticd_drop_tuned_scenes(scenes)
if(NOT scenes STREQUAL "/a/sphere.yaml;/a/my.tuned.scene.yaml")
  message(FATAL_ERROR "left: ${scenes}")
endif()
