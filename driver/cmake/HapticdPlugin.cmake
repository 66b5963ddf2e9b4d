# hapticd_add_plugin(NAME SOURCE... [LIBRARIES LIB...])   a shape plugin:  lib/hapticd/plugins/NAME.so
# hapticd_add_device(NAME SOURCE... [LIBRARIES LIB...])   a device module: lib/hapticd/devices/NAME.so
# Used inside the tree and, through find_package(hapticd), outside it.

function(_hapticd_add_module name kind)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES")
  add_library(${name} MODULE ${arg_UNPARSED_ARGUMENTS})
  set_target_properties(${name} PROPERTIES PREFIX "" C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE hapticd::abi ${arg_LIBRARIES})
  if(NOT TARGET hapticd_options) # outside the tree
    return()
  endif()
  target_link_libraries(${name} PRIVATE hapticd_options)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/tests/") # never found by a user's daemon, nor installed
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests/${kind})
  else()
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${HAPTICD_MODULE_DIR}/${kind})
    install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/hapticd/${kind})
    if(NOT TARGET modules)
      add_custom_target(modules) # every plugin and device module that ships
    endif()
    add_dependencies(modules ${name})
  endif()
endfunction()

function(hapticd_add_plugin name)
  _hapticd_add_module(${name} plugins ${ARGN})
endfunction()

function(hapticd_add_device name)
  _hapticd_add_module(${name} devices ${ARGN})
endfunction()
