# SPDX-License-Identifier: GPL-3.0-or-later
#
# cmake --install build           into the user's QGIS profile and user site-packages
# the same after -DSYSTEM=ON      into /usr, for all users
# target `package`                build/packages/: the plugin zip (pure Python) and a .deb of the core
if(NOT TARGET _core)
  return()
endif()

set(python_tag "python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}")
if(SYSTEM)
  set(default_prefix "/usr")
  set(package_destination "lib/python3/dist-packages")
  set(plugin_destination "share/qgis/python/plugins")
else()
  set(default_prefix "$ENV{HOME}/.local")
  set(package_destination "lib/${python_tag}/site-packages")
  set(plugin_destination "share/QGIS/QGIS3/profiles/default/python/plugins")
  install(CODE [[
    if(NOT "$ENV{SUDO_UID}" STREQUAL "" AND "$ENV{DESTDIR}" STREQUAL "")
      message(FATAL_ERROR "This installs into your own QGIS profile: run it without sudo, or configure with "
                          "-DSYSTEM=ON to install for all users.")
    endif()
  ]])
endif()
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr/local")  # CMake's own default, which neither Python nor QGIS looks into here
  set(CMAKE_INSTALL_PREFIX "${default_prefix}")
endif()

set(no_litter PATTERN "__pycache__" EXCLUDE PATTERN "*.pyc" EXCLUDE)
install(DIRECTORY "${PROJECT_BINARY_DIR}/python/sightbound" DESTINATION "${package_destination}"
        COMPONENT core ${no_litter})
if(TARGET qgis_plugin)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/qgis_plugins/sightbound_qgis" DESTINATION "${plugin_destination}"
          COMPONENT plugin ${no_litter} PATTERN "sightbound" EXCLUDE)
endif()

# The .deb holds the core alone, laid out as Debian wants it, whatever SYSTEM says.
install(DIRECTORY "${PROJECT_BINARY_DIR}/python/sightbound" DESTINATION lib/python3/dist-packages
        COMPONENT deb EXCLUDE_FROM_ALL ${no_litter})
install(FILES "${PROJECT_SOURCE_DIR}/cmake/debian/copyright" DESTINATION share/doc/sightbound-core
        COMPONENT deb EXCLUDE_FROM_ALL)
set(changelog "${PROJECT_BINARY_DIR}/changelog.gz")
execute_process(COMMAND gzip -9nc "${PROJECT_SOURCE_DIR}/cmake/debian/changelog" OUTPUT_FILE "${changelog}")
install(FILES "${changelog}" DESTINATION share/doc/sightbound-core COMPONENT deb EXCLUDE_FROM_ALL)

math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL deb)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGE_CONTACT "The Sightbound authors <maintainers@sightbound.org>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_DEB_PACKAGE_NAME sightbound-core)
set(CPACK_DEBIAN_DEB_PACKAGE_SECTION science)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "viewsheds with a confidence for every cell (core and Python package)")
set(CPACK_DEBIAN_DEB_DESCRIPTION
"Sightbound wraps a measured terrain in the volume of all the surfaces that
could have produced the measurements, and tells for every cell of an elevation
model whether it is surely visible, surely hidden or in doubt, and how sure
that is.
.
This package holds the compiled core and the Python package sightbound, which
the QGIS plugin Sightbound needs.")
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy, python3-gdal")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS qgis)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEB_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/cmake/debian/postinst" "${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

if(TARGET qgis_plugin)
  set(make_zip "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/scripts/make_plugin_zip.py"
      "${PROJECT_BINARY_DIR}/qgis_plugins/sightbound_qgis" "${PROJECT_BINARY_DIR}/packages")
  file(WRITE "${PROJECT_BINARY_DIR}/make_plugin_zip.cmake" "execute_process(COMMAND \"")
  list(JOIN make_zip "\" \"" quoted)
  file(APPEND "${PROJECT_BINARY_DIR}/make_plugin_zip.cmake" "${quoted}\" COMMAND_ERROR_IS_FATAL ANY)\n")
  add_custom_target(plugin_zip COMMAND ${make_zip} VERBATIM)
  add_dependencies(plugin_zip qgis_plugin)
  set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_BINARY_DIR}/make_plugin_zip.cmake")
endif()
include(CPack)
