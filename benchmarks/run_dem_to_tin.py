# SPDX-License-Identifier: GPL-3.0-or-later
"""From a DEM file to a TIN file, timed: run_dem_to_tin.py <dem> <tolerance> <out.ply>. One line, with the process's peak memory."""

import resource
import sys
import time

import sightbound as sb


def main():
    path, tolerance, out = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    start = time.perf_counter()
    tin = sb.dem_to_tin(sb.read_dem(path), tolerance=tolerance)
    made = time.perf_counter()
    tin.write(out)
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(
        f"{tolerance:g} m: {tin.report['faces_before']} -> {tin.report['faces_after']} faces, deviation "
        f"{tin.report['largest_deviation']:.6g} m; made in {made - start:.0f} s, written in {time.perf_counter() - made:.1f} s "
        f"({used.ru_utime:.0f} s of processors), peak {used.ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
