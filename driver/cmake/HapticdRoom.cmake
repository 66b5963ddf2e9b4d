# SPDX-License-Identifier: MIT
# hapticd_room(TARGET PREFIX SOURCE... [ROOMS TARGET...] [LIBRARIES LIB...])
#
# A room is a folder with a library of its own and an include root of its own. The root holds nothing but PREFIX, a link
# to the folder, so "PREFIX/file.hpp" is found by those who link the room and by nobody else: a wall is a missing
# argument of ROOMS. tests/walls proves it with files that must not compile.
#   ROOMS      whose headers the room's own headers include; they come along to those who link it
#   LIBRARIES  whose headers only the room's sources include
# A room without a .cpp is an interface library.
function(hapticd_room target prefix)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "ROOMS;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    add_library(${target} STATIC ${arg_UNPARSED_ARGUMENTS})
    # Another platform puts files of its own in the place of these: each must be an object that a linker can leave out.
    list(FILTER arg_UNPARSED_ARGUMENTS INCLUDE REGEX "_posix\\.cpp$")
    set_source_files_properties(${arg_UNPARSED_ARGUMENTS} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_link_libraries(${target} PUBLIC ${arg_ROOMS} PRIVATE hapticd_options ${arg_LIBRARIES})
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_ROOMS})
  endif()
  hapticd_include_root(${target} ${prefix})
endfunction()

# hapticd_include_root(TARGET PREFIX): gives an existing library the include root of the current folder.
function(hapticd_include_root target prefix)
  set(root ${PROJECT_BINARY_DIR}/rooms/${target})
  file(REMOVE_RECURSE ${root}) # links of an older build, which may lead through a wall; what they lead to stays
  get_filename_component(parent ${root}/${prefix} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${prefix} SYMBOLIC)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${root}>)
  else()
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${root}>)
  endif()
endfunction()

# hapticd_no_deadline(TARGET...): no tick waits for this code, so it is optimised less and compiles in two thirds of the time.
function(hapticd_no_deadline)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    set_target_properties(${target} PROPERTIES HAPTICD_NO_DEADLINE ON)
  endforeach()
endfunction()

# hapticd_interactive(TARGET...): a person waits for this code. It handles text and leaves computing to other rooms, so -Og is
# enough, which compiles in four fifths of the time that -O1 needs.
function(hapticd_interactive)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
    set_target_properties(${target} PROPERTIES HAPTICD_NO_DEADLINE ON)
  endforeach()
endfunction()
