#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   benchmarks/simplify.sh        the figures of docs/performance.md, the simplifier
#   benchmarks/simplify.sh large  those of 10,000 x 10,000 and 20,000 x 20,000 cells: hours, 2 GB of disk
#
# Simplifies a fractal DEM of 1000 x 1000 cells and the Jacksboro sample, each to three tolerances, exact everywhere; then weighs
# triangles against the true largest deviation, beside greedy insertion (if Python has pydelatin 0.2) and meshoptimizer (if
# libmeshoptimizer-dev is installed), with a picture (python3-matplotlib).
# SIGHTBOUND_BENCH_DIR (default: a folder in the system's temporary one) keeps DEMs between calls.
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/setup.sh"

build_folder=${SIGHTBOUND_BUILD:-build}
cmake -B "$build_folder" -DSIGHTBOUND_BENCHMARKS=ON >/dev/null
cmake --build "$build_folder" --target bench_simplify python_package
bench=$build_folder/benchmarks/bench_simplify

folder=${SIGHTBOUND_BENCH_DIR:-${TMPDIR:-/tmp}/sightbound-bench-$(id -u)}
mkdir -p "$folder"
fractal=$folder/fractal_1000.tif
[ -f "$fractal" ] || /usr/bin/python3 benchmarks/make_fractal_dem.py 1000 "$fractal"
echo "machine: $(nproc) cores, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(awk '/MemTotal/ {printf "%.0f GiB", $2 / 1048576}' /proc/meminfo)"

if [ "${1:-}" = large ]; then
  for side in 10000 20000; do
    large=$folder/fractal_$side.tif
    if [ ! -f "$large" ]; then
      [ "$side" = 10000 ] && /usr/bin/python3 benchmarks/make_fractal_dem.py 10000 "$large"
      [ "$side" = 20000 ] && /usr/bin/python3 benchmarks/mirror_dem.py "$folder/fractal_10000.tif" "$large"
    fi
    echo "-- $(basename "$large")"
    for tolerance in 5 10; do
      PYTHONPATH=$build_folder/python /usr/bin/python3 benchmarks/run_dem_to_tin.py "$large" $tolerance "$folder/large.ply"
    done
  done
  rm "$folder/large.ply"
  exit
fi

for dem in "$fractal" sample_data/jacksboro.tif; do
  echo "-- $(basename "$dem")"
  for tolerance in 1 5 10; do "$bench" "$dem" $tolerance; done
done
echo "-- one thread"
"$bench" "$fractal" 5 1

echo "-- what the guarantee is worth"
PYTHONPATH=$build_folder/python /usr/bin/python3 benchmarks/compare_simplifiers.py "$fractal" --picture docs/images/simplifiers.png
