#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# From nothing to a map: install what is missing, build, compute the confidence viewshed of the sample DEM with QGIS's
# own qgis_process, and leave rasters, styles and a rendered map in demo_output/.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build qgis_plugin

out=$PWD/demo_output
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$out" 2>/dev/null || true
[[ -w $out ]] || fail "demo_output/ cannot be written by $(id -un); remove it, or give it to yourself with chown."

# A QGIS profile of its own: nothing of the user's settings is read or changed.
export QGIS_CUSTOM_CONFIG_PATH=$scratch/profile QGIS_PLUGINPATH=$PWD/build/qgis_plugins PYTHONPATH=$PWD/build/python
export QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$scratch/runtime PYTHONDONTWRITEBYTECODE=1
mkdir -m 700 "$XDG_RUNTIME_DIR"
# The wrapper `qgis_process` of Debian 12 passes an option that the program does not know.
qgis_process=$(command -v qgis_process.bin || command -v qgis_process) \
  || fail "qgis_process is missing although the package qgis is installed; reinstall it with: sudo apt-get install --reinstall qgis"

step "running sightbound:confidenceviewshed in QGIS"
quiet "$qgis_process" plugins enable sightbound_qgis
rm -f "$out"/confidence.* "$out"/verdict.* "$out"/observers.* "$out"/map.png "$out"/result.json
cp sample_data/observers.gpkg "$scratch" # QGIS writes into a GeoPackage even when it only reads
if ! "$qgis_process" --json run sightbound:confidenceviewshed -- \
  INPUT="$PWD/sample_data/jacksboro.tif" \
  OBSERVERS="$scratch/observers.gpkg" \
  OBSERVER_HEIGHT_FIELD=eye_height \
  TARGET_HEIGHT=2 \
  MAX_DISTANCE=15000 \
  OUTPUT="$out/confidence.tif" \
  OUTPUT_VERDICT="$out/verdict.tif" \
  OUTPUT_OBSERVERS="$out/observers.gpkg" \
  >"$out/result.json" 2>"$scratch/run.log"; then
  cat "$scratch/run.log" "$out/result.json" >&2
  fail "demo.sh stopped while $current_step; the lines above tell why."
fi
# A style of the same name beside a raster is what QGIS applies when the raster is opened.
cp build/qgis_plugins/sightbound_qgis/styles/confidence.qml "$out/confidence.qml"
cp build/qgis_plugins/sightbound_qgis/styles/verdict.qml "$out/verdict.qml"

step "drawing the map"
/usr/bin/python3 scripts/draw_demo_map.py "$out" sample_data/jacksboro.tif 2>"$scratch/draw.log" || {
  cat "$scratch/draw.log" >&2
  fail "demo.sh stopped while $current_step; the lines above tell why."
}
