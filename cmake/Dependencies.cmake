# SPDX-License-Identifier: GPL-3.0-or-later
#
# Every library the project uses, found once. Debian package names: see scripts/packages.txt.
find_package(Threads REQUIRED)
find_package(TBB CONFIG REQUIRED)
find_package(GeographicLib MODULE REQUIRED)
find_package(Eigen3 CONFIG REQUIRED)
find_package(CGAL CONFIG REQUIRED)
find_package(EXPAT REQUIRED)
find_package(GDAL CONFIG REQUIRED)
find_package(PROJ CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)

# Debian keeps OpenVDB's find module out of CMake's own folders.
file(GLOB openvdb_modules /usr/lib/*/cmake/OpenVDB /usr/lib/cmake/OpenVDB)
list(APPEND CMAKE_MODULE_PATH ${openvdb_modules})
find_package(OpenVDB MODULE REQUIRED COMPONENTS openvdb)

if(SIGHTBOUND_TESTS)
  find_package(GTest REQUIRED)
endif()

if(SIGHTBOUND_PYTHON)
  # QGIS uses the system's interpreter; another python3 that comes first on PATH (pyenv, conda) would build an
  # extension that QGIS cannot load.
  if(NOT DEFINED Python_EXECUTABLE AND NOT DEFINED Python_ROOT_DIR AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The interpreter that QGIS uses")
  endif()
  set(Python_FIND_STRATEGY LOCATION)
  set(PYBIND11_FINDPYTHON ON)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module NumPy)
  execute_process(COMMAND "${Python_EXECUTABLE}" -c "import osgeo, numpy"
                  RESULT_VARIABLE python_lacks_modules OUTPUT_QUIET ERROR_QUIET)
  if(python_lacks_modules)
    message(FATAL_ERROR "${Python_EXECUTABLE} cannot import osgeo and numpy, so it is not the interpreter that "
                        "QGIS uses. Install python3-gdal and python3-numpy, or name the right interpreter with "
                        "-DPython_EXECUTABLE=/usr/bin/python3.")
  endif()
  find_package(pybind11 CONFIG REQUIRED)
endif()
