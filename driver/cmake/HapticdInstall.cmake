# SPDX-License-Identifier: MIT
# What is installed beside the program and its modules. Component `dev`: what building a plugin outside this tree needs.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hapticd)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/driver/include/hapticd DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(TARGETS hapticd_abi EXPORT hapticdTargets)
install(EXPORT hapticdTargets NAMESPACE hapticd:: DESTINATION ${package_dir} COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hapticdConfigVersion.cmake COMPATIBILITY SameMajorVersion
                                 ARCH_INDEPENDENT)
install(FILES ${PROJECT_SOURCE_DIR}/driver/cmake/hapticdConfig.cmake ${PROJECT_SOURCE_DIR}/driver/cmake/HapticdPlugin.cmake
              ${PROJECT_BINARY_DIR}/hapticdConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT dev)

# pkg-config for plugins and modules that are not built with CMake. Its paths are relative, so that the folder may move.
file(RELATIVE_PATH pc_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" pc_to_prefix ${pc_to_prefix})
configure_file(${PROJECT_SOURCE_DIR}/driver/cmake/hapticd.pc.in ${PROJECT_BINARY_DIR}/hapticd.pc @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/driver/doors/client/c/hapticd-client.pc.in ${PROJECT_BINARY_DIR}/hapticd-client.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/hapticd.pc ${PROJECT_BINARY_DIR}/hapticd-client.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# Programs beside a daemon: the library with the daemon, what building against it needs with the headers; Python needs no
# more than its files.
install(TARGETS hapticd_client EXPORT hapticdClientTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT dev)
install(EXPORT hapticdClientTargets NAMESPACE hapticd:: DESTINATION ${package_dir} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/driver/doors/client/python/hapticd DESTINATION lib/python3/dist-packages
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/driver/doors/client/python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
        USE_SOURCE_PERMISSIONS)
install(FILES ${PROJECT_SOURCE_DIR}/driver/doors/client/c/examples/button.c
              ${PROJECT_SOURCE_DIR}/driver/doors/client/c/examples/spring.c
              ${PROJECT_SOURCE_DIR}/driver/doors/client/c/examples/lead_model.c DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)

# Each Debian package must contain its licences.
install(FILES ${PROJECT_SOURCE_DIR}/driver/package/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hapticd)
install(FILES ${PROJECT_SOURCE_DIR}/driver/package/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hapticd-dev COMPONENT dev)
if(TARGET hapticd-import)
  install(FILES ${PROJECT_SOURCE_DIR}/driver/package/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hapticd-import COMPONENT cad)
endif()

# The unit names the program, wherever it is installed.
configure_file(${PROJECT_SOURCE_DIR}/config/systemd/hapticd.service.in ${PROJECT_BINARY_DIR}/hapticd.service @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/hapticd.service DESTINATION lib/systemd/system)
install(FILES ${PROJECT_SOURCE_DIR}/config/systemd/hapticd.sysusers DESTINATION lib/sysusers.d RENAME hapticd.conf)
# PAM reads only /etc/security/limits.d. An installation into a private folder must not change the system, so it puts the file
# into that folder instead. The prefix is known only at the installation, because `cmake --install --prefix` can change it.
install(CODE [[
  if(CMAKE_INSTALL_PREFIX MATCHES "^/(usr|usr/local|opt/.*)$")
    set(limits_dir /etc/security/limits.d)
  else()
    set(limits_dir ${CMAKE_INSTALL_PREFIX}/etc/security/limits.d)
  endif()]])
install(CODE "file(INSTALL DESTINATION \"\${limits_dir}\" TYPE FILE RENAME 70-hapticd.conf
                   FILES \"${PROJECT_SOURCE_DIR}/config/systemd/70-hapticd.limits\")")
file(GLOB udev_rules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/udev/*.rules)
install(FILES ${udev_rules} DESTINATION lib/udev/rules.d)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/udev/generate-rules DESTINATION ${CMAKE_INSTALL_DATADIR}/hapticd)
