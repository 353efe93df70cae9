#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   benchmarks/probable.sh [--runs 3] [--copies 5] [size ...]     default sizes: 1000 4000
#
# Times whole processes in turn, GeoTIFF to GeoTIFF, on a fractal DEM: probable viewsheds of 1000 realisations (as they come,
# without fine ground, without stopping early) and what the literature does: perturb the DEM and run gdal_viewshed on the copy.
# Of the latter a few are run, and their median is taken a thousand times. Wants gdal-bin. SIGHTBOUND_BENCH_DIR as in viewshed.sh.
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/setup.sh"

command -v gdal_viewshed >/dev/null || fail "gdal_viewshed is missing; install it with: sudo apt-get install gdal-bin"
build python_package
export PYTHONPATH=$PWD/build/python

folder=${SIGHTBOUND_BENCH_DIR:-${TMPDIR:-/tmp}/sightbound-bench-$(id -u)}
mkdir -p "$folder"
echo "machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(awk '/MemTotal/ {printf "%.0f GiB", $2 / 1048576}' /proc/meminfo)"
echo "versions: $(gdalinfo --version | cut -d, -f1)"
/usr/bin/python3 benchmarks/compare_probable.py --folder "$folder" "$@"
