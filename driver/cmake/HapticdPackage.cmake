# SPDX-License-Identifier: MIT
# `cpack` in the build folder makes two Debian packages: hapticd (the daemon, its plugins and modules) and hapticd-dev
# (headers and CMake package, to build plugins). If Open CASCADE is installed, it makes a third: hapticd-import (CAD files).
# The licences of the linked libraries are in the packages of these libraries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hapticd)
set(CPACK_PACKAGE_CONTACT "hapticd developers <hapticd@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL Unspecified dev)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME hapticd)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME hapticd-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/driver/package/postinst;${PROJECT_SOURCE_DIR}/driver/package/conffiles")
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS "python3, python3-numpy") # the package hapticd for Python
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_GENERATE_SHLIBS ON)               # libhapticd.so.0
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "hapticd (= ${PROJECT_VERSION}), g++, cmake, make")
if(TARGET hapticd-import)
  list(APPEND CPACK_COMPONENTS_ALL cad)
  set(CPACK_DEBIAN_CAD_PACKAGE_NAME hapticd-import)
  set(CPACK_DEBIAN_CAD_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_CAD_PACKAGE_DEPENDS "hapticd (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS "hapticd-import, python3, python3-numpy")
endif()
include(CPack)
