#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The same set-up as demo.sh, then all tests: C++ (ctest), Python (pytest) and QGIS (pytest in a process of its own).
# Every suite runs even if an earlier one fails; the summary comes last.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build all

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export QGIS_CUSTOM_CONFIG_PATH=$scratch/profile QGIS_PLUGINPATH=$PWD/build/qgis_plugins PYTHONPATH=$PWD/build/python
export QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$scratch/runtime PYTHONDONTWRITEBYTECODE=1
mkdir -m 700 "$XDG_RUNTIME_DIR"

declare -A outcome
run_suite() { # run_suite <name> <command>...
  local name=$1
  shift
  step "$name tests"
  if "$@"; then outcome[$name]="passed"; else outcome[$name]="FAILED"; fi
}

jobs=${SIGHTBOUND_JOBS:-$(nproc)}
trap - ERR # a failing suite is reported in the summary
run_suite "C++" ctest --test-dir build --output-on-failure --parallel "$jobs"
run_suite "Python" /usr/bin/python3 -m pytest -q -p no:cacheprovider -n "$jobs" tests --ignore=tests/qgis
run_suite "QGIS" /usr/bin/python3 -m pytest -q -p no:cacheprovider tests/qgis

step "summary"
status=0
for name in "C++" "Python" "QGIS"; do
  echo "$name tests: ${outcome[$name]}"
  [[ ${outcome[$name]} == passed ]] || status=1
done
if ((status)); then
  fail "test.sh found failing tests; the output of the failing suite above tells which."
fi
echo "All tests passed."
