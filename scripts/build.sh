#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Install what is missing, build the release preset in build/, stage the Python package (build/python) and the QGIS
# plugin (build/qgis_plugins/sightbound_qgis).
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build all

cat <<EOF2
Built. To use it from here:
  PYTHONPATH=$PWD/build/python /usr/bin/python3 -c 'import sightbound'
  PYTHONPATH=$PWD/build/python QGIS_PLUGINPATH=$PWD/build/qgis_plugins qgis
To install it for yourself: cmake --install build
EOF2
