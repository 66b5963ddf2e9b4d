# SPDX-License-Identifier: MIT
# hapticd_add_plugin(NAME SOURCE... [LIBRARIES LIB...])   a shape plugin:  lib/hapticd/plugins/NAME.so
# hapticd_add_device(NAME SOURCE... [LIBRARIES LIB...])   a device module: lib/hapticd/devices/NAME.so
# Used inside the tree and, through find_package(hapticd), outside it.

function(_hapticd_name_module name)
  set_target_properties(${name} PROPERTIES PREFIX "" C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${name} PRIVATE cxx_std_20)
endfunction()

function(_hapticd_add_module name kind)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES")
  if(NOT TARGET hapticd_options) # outside the tree
    add_library(${name} MODULE ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} PRIVATE hapticd::abi ${arg_LIBRARIES})
    _hapticd_name_module(${name})
    return()
  endif()
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/tests/") # never found by a user's daemon, nor installed
    add_library(${name} MODULE ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} PRIVATE hapticd::abi ${arg_LIBRARIES} hapticd_options)
    _hapticd_name_module(${name})
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests/${kind})
    return()
  endif()
  # The objects are a target of their own, so that a test links what ships instead of compiling it again.
  add_library(${name}_objects OBJECT ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name}_objects PUBLIC hapticd::abi ${arg_LIBRARIES} PRIVATE hapticd_options)
  hapticd_include_root(${name}_objects ${name})
  add_library(${name} MODULE $<TARGET_OBJECTS:${name}_objects>)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${name} PRIVATE hapticd::abi ${arg_LIBRARIES} hapticd_elementary_names)
  _hapticd_name_module(${name})
  set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${HAPTICD_MODULE_DIR}/${kind})
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/hapticd/${kind})
  if(NOT TARGET modules)
    add_custom_target(modules) # every plugin and device module that ships
  endif()
  add_dependencies(modules ${name})
endfunction()

function(hapticd_add_plugin name)
  _hapticd_add_module(${name} plugins ${ARGN})
endfunction()

function(hapticd_add_device name)
  _hapticd_add_module(${name} devices ${ARGN})
endfunction()
