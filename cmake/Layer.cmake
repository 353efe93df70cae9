# SPDX-License-Identifier: GPL-3.0-or-later

# sightbound_layer(<name> [SOURCES <file>...] [USES <layer>...] [LIBRARIES <target>...])
#
# Target sightbound_<name>: one folder of cpp/. USES are the layers beneath that its headers and sources include;
# LIBRARIES are third-party targets, private to the layer. A layer of headers alone becomes an INTERFACE library.
function(sightbound_layer name)
  cmake_parse_arguments(LAYER "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target sightbound_${name})
  if(LAYER_SOURCES)
    add_library(${target} STATIC ${LAYER_SOURCES})
    set(scope PUBLIC)
    set(private PRIVATE)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    set(private INTERFACE)
  endif()
  target_include_directories(${target} ${scope} "${PROJECT_SOURCE_DIR}/cpp")
  list(TRANSFORM LAYER_USES PREPEND sightbound_)
  target_link_libraries(${target} ${scope} ${LAYER_USES} ${private} ${LAYER_LIBRARIES})
endfunction()
