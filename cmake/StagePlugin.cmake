# SPDX-License-Identifier: GPL-3.0-or-later
#
# The QGIS plugin, staged as <build>/qgis_plugins/sightbound_qgis (QGIS_PLUGINPATH=<build>/qgis_plugins): the files of
# qgis_plugin/ with metadata.txt, LICENSE and defaults.json, which is written by the core itself. A link `sightbound` to
# the staged package lets the staged plugin find its core without PYTHONPATH; it is neither installed nor zipped.
set(plugin_stage "${PROJECT_BINARY_DIR}/qgis_plugins/sightbound_qgis")
file(GLOB_RECURSE plugin_files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/qgis_plugin/*")
list(FILTER plugin_files EXCLUDE REGEX "__pycache__|\\.pyc$")

if(plugin_files AND TARGET _core)
  set(plugin_staged "${PROJECT_BINARY_DIR}/qgis_plugin.stamp")
  add_custom_command(OUTPUT "${plugin_staged}"
    COMMAND ${CMAKE_COMMAND} -DFROM=${PROJECT_SOURCE_DIR}/qgis_plugin -DTO=${plugin_stage}
            "-DKEEP=^(metadata.txt|LICENSE|defaults.json|sightbound)$" -P "${PROJECT_SOURCE_DIR}/cmake/MirrorTree.cmake"
    COMMAND ${CMAKE_COMMAND} -E copy_if_different
            "${PROJECT_SOURCE_DIR}/metadata.txt" "${PROJECT_SOURCE_DIR}/LICENSE" "${plugin_stage}"
    COMMAND ${CMAKE_COMMAND} -E env "PYTHONPATH=${PROJECT_BINARY_DIR}/python"
            "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/cmake/write_defaults.py" "${plugin_stage}/defaults.json"
    COMMAND ${CMAKE_COMMAND} -E create_symlink ../../python/sightbound "${plugin_stage}/sightbound"
    COMMAND ${CMAKE_COMMAND} -E touch "${plugin_staged}"
    DEPENDS ${plugin_files} _core python_package
            "${PROJECT_SOURCE_DIR}/metadata.txt" "${PROJECT_SOURCE_DIR}/LICENSE"
            "${PROJECT_SOURCE_DIR}/cmake/write_defaults.py" "${PROJECT_SOURCE_DIR}/cmake/MirrorTree.cmake"
    COMMENT "Staging the QGIS plugin in ${plugin_stage}" VERBATIM)
  add_custom_target(qgis_plugin ALL DEPENDS "${plugin_staged}")
endif()
