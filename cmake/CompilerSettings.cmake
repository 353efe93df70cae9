# SPDX-License-Identifier: GPL-3.0-or-later
#
# One set of flags for every target. Contraction is off and fast-math is never on: every verdict must be the same
# on every machine and for every number of threads.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# -fno-math-errno and -fno-trapping-math change no value, only the flags that nobody reads; with them loops with
# square roots and conditions run in vectors.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math -Wall -Wextra -Wshadow)
if(SIGHTBOUND_WERROR)
  add_compile_options(-Werror)
endif()

if(SIGHTBOUND_SCALAR)
  add_compile_definitions(SIGHTBOUND_SCALAR)
  add_compile_options(-fno-tree-vectorize -fno-tree-slp-vectorize)
endif()

if(SIGHTBOUND_SANITIZE)
  add_compile_options(-fsanitize=${SIGHTBOUND_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SIGHTBOUND_SANITIZE})
endif()
