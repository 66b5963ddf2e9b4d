# SPDX-License-Identifier: MIT
# Headers of libraries that g++ parses once for many rooms, in the presets whose rooms are units. The other presets have
# none of this: there a file that forgets an include does not compile.
#   hapticd_headers              Eigen and the standard library, for code that ticks wait for
#   hapticd_headers_no_deadline  nlohmann/json as well, for rooms with hapticd_no_deadline() or hapticd_interactive()
# Flags of a room must be those of the headers, or g++ refuses them; a source with flags of its own says
# SKIP_PRECOMPILE_HEADERS. A room also gets the libraries of the headers, since ccache reads the headers themselves.
function(hapticd_use_precompiled target headers)
  target_link_libraries(${target} PRIVATE ${ARGN})
  target_precompile_headers(${target} REUSE_FROM ${headers})
  target_compile_options(${target} PRIVATE ${HAPTICD_PRECOMPILED_WARNINGS})
endfunction()

function(hapticd_precompile headers)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;LIBRARIES")
  file(WRITE ${CMAKE_BINARY_DIR}/${headers}.cpp "// nothing: its target precompiles headers\n")
  add_library(${headers} OBJECT ${CMAKE_BINARY_DIR}/${headers}.cpp)
  target_link_libraries(${headers} PRIVATE hapticd_options ${arg_LIBRARIES})
  target_precompile_headers(${headers} PRIVATE ${arg_HEADERS})
endfunction()

find_package(nlohmann_json REQUIRED)
add_library(hapticd_precompiled_json INTERFACE)
target_include_directories(hapticd_precompiled_json INTERFACE ${CMAKE_CURRENT_LIST_DIR}/precompiled)
target_link_libraries(hapticd_precompiled_json INTERFACE nlohmann_json::nlohmann_json)

if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(standard <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <functional> <memory> <optional> <string> <vector>)
  hapticd_precompile(hapticd_headers HEADERS <Eigen/Geometry> ${standard} LIBRARIES Eigen3::Eigen)
  hapticd_precompile(hapticd_headers_no_deadline HEADERS <Eigen/Geometry> <json_without_literals.hpp> ${standard}
    LIBRARIES Eigen3::Eigen hapticd_precompiled_json)
  hapticd_no_deadline(hapticd_headers_no_deadline)
  foreach(room
    hapticd_arm hapticd_base hapticd_brep_contact hapticd_brep_elements hapticd_brep_geometry hapticd_brep_model
    hapticd_brep_search hapticd_brep_tree hapticd_capture hapticd_client_objects hapticd_codec hapticd_conformance
    hapticd_contact hapticd_control hapticd_core hapticd_diagnostics_check hapticd_diagnostics_device
    hapticd_diagnostics_hand hapticd_diagnostics_machine hapticd_diagnostics_reading hapticd_diagnostics_scene
    hapticd_document hapticd_dynamics hapticd_export hapticd_haply_parts hapticd_hd hapticd_host hapticd_importing
    hapticd_kinematics hapticd_loop hapticd_medial hapticd_mesh_import hapticd_messages hapticd_model_file
    hapticd_part hapticd_passivity hapticd_record hapticd_replay hapticd_requests hapticd_run hapticd_safety
    hapticd_scene hapticd_sim hapticd_simulated hapticd_spline hapticd_status hapticd_telemetry hapticd_trace
    hapticd_traced_shape hapticd_tune hapticd_velocity hapticd_view_parts hapticd_watch hapticd_wire_arm
    hapticd_world mat_deformable_objects nurbs_rigid_objects pendulum_objects push_button_objects simulated_objects
    usb_bulk_objects usb_hid_objects vendor_dhd_objects vendor_hd_objects vme_objects)
    if(NOT TARGET ${room})
      continue()
    endif()
    get_target_property(no_deadline ${room} HAPTICD_NO_DEADLINE)
    if(no_deadline)
      hapticd_use_precompiled(${room} hapticd_headers_no_deadline Eigen3::Eigen hapticd_precompiled_json)
    else()
      hapticd_use_precompiled(${room} hapticd_headers Eigen3::Eigen)
    endif()
  endforeach()
endif()
