#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   benchmarks/volume.sh          the figures of docs/performance.md, error volume
#
# Builds cover masks and bounds of k on a fractal DEM of 10 m cells: columns and faces, and how time and memory grow with cells, sigma
# and voxels. SIGHTBOUND_BENCH_DIR (default: a folder in the system's temporary one) keeps DEMs between calls.
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/setup.sh"

build_folder=${SIGHTBOUND_BUILD:-build}
cmake -B "$build_folder" -DSIGHTBOUND_BENCHMARKS=ON >/dev/null
cmake --build "$build_folder" --target bench_volume bench_volume_sight bench_volume_rays
bench=$build_folder/benchmarks/bench_volume

folder=${SIGHTBOUND_BENCH_DIR:-${TMPDIR:-/tmp}/sightbound-bench-$(id -u)}
mkdir -p "$folder"
dem() { # cells a side
  local file=$folder/fractal_$1.tif
  [ -f "$file" ] || /usr/bin/python3 benchmarks/make_fractal_dem.py "$1" "$file"
  echo "$file"
}
echo "machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(awk '/MemTotal/ {printf "%.0f GiB", $2 / 1048576}' /proc/meminfo)"

echo "-- 1000 x 1000, sigma 2.5 m, voxels of 2 m"
for how in columns faces; do
  "$bench" "$(dem 1000)" covers $how 2.5 2
  "$bench" "$(dem 1000)" bounds $how 2.5 2
done
echo "-- with error between the samples (Delta 1 m)"
"$bench" "$(dem 1000)" bounds columns 2.5 2 1
echo "-- cells"
for size in 250 500; do "$bench" "$(dem $size)" bounds columns 2.5 2; done
echo "-- sigma"
for sigma in 1 5 10; do "$bench" "$(dem 500)" bounds columns $sigma 2; done
echo "-- voxels (alpha = 4.9 m / voxel)"
for voxel in 1 4 8; do "$bench" "$(dem 500)" bounds columns 2.5 $voxel; done
echo "-- lines against OpenVDB's own means"
"$build_folder/benchmarks/bench_volume_rays" "$(dem 1000)" 2.5 2
echo "-- lines and a viewshed"
"$build_folder/benchmarks/bench_volume_sight" "$(dem 1000)" 2.5 2
