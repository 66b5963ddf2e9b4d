# SPDX-License-Identifier: MIT
# hapticd_add_plugin(NAME SOURCE... [LIBRARIES LIB...])   a shape plugin:  lib/hapticd/plugins/NAME.so
# hapticd_add_device(NAME SOURCE... [LIBRARIES LIB...])   a device module: lib/hapticd/devices/NAME.so
# Used inside the tree and, through find_package(hapticd), outside it. Outside it, `cmake --install` puts the file where the
# hapticd that was found looks for it, unless CMAKE_INSTALL_PREFIX is given; without CMAKE_BUILD_TYPE it is compiled with -O2.
# hapticd_link_modules(PROGRAM NAME...)   plugins and modules of this tree inside a program, for platforms without dlopen()

function(_hapticd_name_module name)
  set_target_properties(${name} PROPERTIES PREFIX "" C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${name} PRIVATE cxx_std_20)
endfunction()

# Sets `file` to the given source that contains the entry, HAPTICD_SHAPES or HAPTICD_DEVICES; to "" if none contains it.
function(_hapticd_entry_file file folder)
  set(${file} "" PARENT_SCOPE)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${folder}/${source} found REGEX "^HAPTICD_(SHAPES|DEVICES)[(]" LIMIT_COUNT 1)
    if(found)
      set(${file} ${source} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# Installs a module of a project outside the tree into the folder of the hapticd that was found, for all users.
function(_hapticd_install_outside name kind)
  get_target_property(include hapticd::abi INTERFACE_INCLUDE_DIRECTORIES)
  get_filename_component(prefix ${include} DIRECTORY)
  get_filename_component(library_dir ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../.. ABSOLUTE)
  file(RELATIVE_PATH library_dir ${prefix} ${library_dir})
  if(CMAKE_INSTALL_PREFIX_INITIALIZED_TO_DEFAULT)
    set_property(CACHE CMAKE_INSTALL_PREFIX PROPERTY VALUE ${prefix})
  endif()
  install(TARGETS ${name} LIBRARY DESTINATION ${library_dir}/hapticd/${kind})
endfunction()

function(_hapticd_add_module name kind)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES")
  if(NOT TARGET hapticd_options) # outside the tree
    add_library(${name} MODULE ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} PRIVATE hapticd::abi ${arg_LIBRARIES})
    _hapticd_name_module(${name})
    if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
      target_compile_options(${name} PRIVATE -O2) # it runs a thousand times a second
    endif()
    _hapticd_install_outside(${name} ${kind})
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
  _hapticd_entry_file(entry_file ${CMAKE_CURRENT_SOURCE_DIR} ${arg_UNPARSED_ARGUMENTS})
  set_source_files_properties("${entry_file}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # hapticd_link_modules() replaces it
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

# Links plugins and device modules of this tree into a program, so that it need not load files. A definition renames the entry
# of each to hsp_entry_NAME or hdv_entry_NAME, so that one program can contain several; the ABI stays the same.
# Only the file with the entry is compiled once more. The program calls hapticd::host::takeBuiltIns() and links the rooms
# it needs; host/platform_none.cpp and base/thread_usage_none.cpp replace what would call the operating system.
function(hapticd_link_modules program)
  set(declarations "")
  set(items "")
  foreach(name IN LISTS ARGN)
    get_target_property(folder ${name}_objects SOURCE_DIR)
    get_target_property(sources ${name}_objects SOURCES)
    _hapticd_entry_file(entry_file ${folder} ${sources})
    if(NOT entry_file)
      message(FATAL_ERROR "hapticd_link_modules: no source of ${name} has HAPTICD_SHAPES or HAPTICD_DEVICES")
    endif()
    add_library(${program}_${name} OBJECT ${folder}/${entry_file})
    target_compile_definitions(${program}_${name} PRIVATE hsp_plugin_entry=hsp_entry_${name} hdv_module_entry=hdv_entry_${name})
    target_link_libraries(${program}_${name} PRIVATE hapticd_options ${name}_objects)
    get_target_property(libraries ${name}_objects INTERFACE_LINK_LIBRARIES)
    target_link_libraries(${program} PRIVATE ${libraries})
    target_sources(${program} PRIVATE $<TARGET_OBJECTS:${program}_${name}>
                   $<FILTER:$<TARGET_OBJECTS:${name}_objects>,EXCLUDE,/${entry_file}[.]o>)
    if(folder MATCHES "^${PROJECT_SOURCE_DIR}/plugins/")
      string(APPEND declarations "extern const hsp_entry hsp_entry_${name};\n")
      string(APPEND items "    {\"${name}\", &hsp_entry_${name}, nullptr},\n")
    else()
      string(APPEND declarations "extern const hdv_entry hdv_entry_${name};\n")
      string(APPEND items "    {\"${name}\", nullptr, &hdv_entry_${name}},\n")
    endif()
  endforeach()
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${program}_built_ins.cpp)
  file(CONFIGURE OUTPUT ${list} @ONLY CONTENT "// Made by hapticd_link_modules().
#include \"host/built_in.hpp\"

extern \"C\" {
@declarations@}

void hapticd::host::takeBuiltIns() {
  static const BuiltIn kAll[] = {
@items@  };
  setBuiltIns(kAll);
}
")
  target_sources(${program} PRIVATE ${list} ${PROJECT_SOURCE_DIR}/driver/daemon/host/platform_none.cpp
                 ${PROJECT_SOURCE_DIR}/driver/base/thread_usage_none.cpp)
  target_link_libraries(${program} PRIVATE hapticd_host)
endfunction()
