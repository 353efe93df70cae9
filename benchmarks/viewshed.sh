#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   benchmarks/viewshed.sh [--runs 5] [--grass-up-to 4000] [--grass-runs 2] [size ...]     default sizes: 1000 4000 10000
#
# Times whole processes in turn, GeoTIFF to GeoTIFF, on a fractal DEM: Sightbound (Float32 confidence and verdict written)
# with a given and with an estimated error, gdal_viewshed (boolean), GRASS r.viewshed -b. Wants gdal-bin, and grass-core for
# the last. SIGHTBOUND_BENCH_DIR (default: a folder in the system's temporary one) keeps DEMs between calls: 10000 x 10000
# needs 1.5 GB there and 2.5 GB of memory once, to make the DEM.
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/setup.sh"

command -v gdal_viewshed >/dev/null || fail "gdal_viewshed is missing; install it with: sudo apt-get install gdal-bin"
build python_package
export PYTHONPATH=$PWD/build/python

folder=${SIGHTBOUND_BENCH_DIR:-${TMPDIR:-/tmp}/sightbound-bench-$(id -u)}
mkdir -p "$folder"
echo "machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(awk '/MemTotal/ {printf "%.0f GiB", $2 / 1048576}' /proc/meminfo)"
echo "versions: $(gdalinfo --version | cut -d, -f1), $(command -v grass >/dev/null && echo "GRASS $(grass --config version)" || echo "no GRASS")"
/usr/bin/python3 benchmarks/compare_viewsheds.py --folder "$folder" "$@"
