# SPDX-License-Identifier: MIT
# docs: the reference of the public headers (Doxygen), into the build folder's docs/html. A warning fails it.
# The pages of driver/docs are installed as they are, README.md and CHANGELOG.md with links that fit the installed folder.
find_package(Doxygen QUIET)
find_package(Python3 QUIET COMPONENTS Interpreter)
if(DOXYGEN_FOUND AND Python3_FOUND)
  set(docs_output ${PROJECT_BINARY_DIR}/docs)
  configure_file(${PROJECT_SOURCE_DIR}/driver/docs/doxygen/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
  add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E make_directory ${docs_output}
                         COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/Doxyfile
                    COMMENT "reference of the public headers: ${docs_output}/html/index.html" VERBATIM)
else()
  add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E echo "error: Doxygen or Python is missing; fix: driver/install-packages docs"
                         COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
endif()

foreach(page IN ITEMS README.md CHANGELOG.md)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${page})
  file(READ ${PROJECT_SOURCE_DIR}/${page} text)
  string(REPLACE "(driver/docs/" "(docs/" text "${text}")
  string(REPLACE "(driver/include/" "(../../../include/" text "${text}")
  string(REPLACE "(plugins/template)" "(../../hapticd/template)" text "${text}")
  string(REPLACE "(devices/template)" "(../../hapticd/device-template)" text "${text}")
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\((tests|driver)/[^)]*\\)" "\\1 (in the sources)" text "${text}")
  file(WRITE ${PROJECT_BINARY_DIR}/${page} "${text}")
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_BINARY_DIR}/README.md ${PROJECT_BINARY_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/driver/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs
        FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" PATTERN "*.gif" PATTERN doxygen EXCLUDE PATTERN man EXCLUDE)
