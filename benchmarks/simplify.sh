#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   benchmarks/simplify.sh [cells a side]     default: 1000
#
# Triangles against the true largest deviation on a fractal DEM: Sightbound, greedy insertion (wants python3-scipy), meshoptimizer (wants
# libmeshoptimizer-dev); a picture of it in docs/images/ (wants python3-matplotlib). SIGHTBOUND_BENCH_DIR (default: a
# folder in the system's temporary one) keeps the DEM between calls.
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/setup.sh"

build python_package
export PYTHONPATH=$PWD/build/python
folder=${SIGHTBOUND_BENCH_DIR:-${TMPDIR:-/tmp}/sightbound-bench-$(id -u)}
mkdir -p "$folder"
size=${1:-1000}
[ -f "$folder/fractal_$size.tif" ] || /usr/bin/python3 benchmarks/make_fractal_dem.py "$size" "$folder/fractal_$size.tif"
echo "machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(awk '/MemTotal/ {printf "%.0f GiB", $2 / 1048576}' /proc/meminfo)"
/usr/bin/python3 benchmarks/compare_simplifiers.py "$folder/fractal_$size.tif" --picture docs/images/simplifiers.png
