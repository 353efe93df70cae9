# SPDX-License-Identifier: GPL-3.0-or-later
#
# cmake -DFROM=<folder> -DTO=<folder> [-DKEEP=<regex>] -P MirrorTree.cmake
#
# Makes TO hold the files of FROM: copies what changed, removes what FROM no longer has. Files of TO whose path
# matches KEEP stay (built there by other rules). Byte code is neither copied nor kept.
cmake_minimum_required(VERSION 3.22)
file(GLOB_RECURSE wanted RELATIVE "${FROM}" "${FROM}/*")
list(FILTER wanted EXCLUDE REGEX "__pycache__|\\.pyc$|~$")
file(GLOB_RECURSE present RELATIVE "${TO}" "${TO}/*")
foreach(name IN LISTS present)
  if(NOT name IN_LIST wanted AND NOT (KEEP AND name MATCHES "${KEEP}"))
    file(REMOVE "${TO}/${name}")
  endif()
endforeach()
foreach(name IN LISTS wanted)
  get_filename_component(folder "${TO}/${name}" DIRECTORY)
  file(MAKE_DIRECTORY "${folder}")
  file(COPY_FILE "${FROM}/${name}" "${TO}/${name}" ONLY_IF_DIFFERENT)
endforeach()
