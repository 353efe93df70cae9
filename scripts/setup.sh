# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
#
# Sourced by build.sh, demo.sh and test.sh: goes to the project's root, installs what is missing (apt only, and only
# that with elevated rights), and offers `step`, `fail`, `build` and `quiet`.
#
# SIGHTBOUND_JOBS   parallel compilations (default: all cores)
set -euo pipefail

fail() {
  trap - ERR
  echo "sightbound: $*" >&2
  exit 1
}

current_step="starting"
step() {
  current_step=$1
  echo "== $1"
}
trap 'fail "$(basename "$0") stopped while $current_step; the lines above tell why."' ERR

# Run a command and show its output only if it fails.
quiet() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    fail "$(basename "$0") stopped while $current_step: '$(basename "$1")' failed as shown above."
  fi
  rm -f "$log"
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
[[ -f CMakeLists.txt ]] || fail "no CMakeLists.txt in $PWD: run the scripts from where the project keeps them."

# QGIS uses the system's interpreter and libraries; another python3 earlier on PATH must not get in between.
export PATH="/usr/local/sbin:/usr/sbin:/usr/bin:/sbin:/bin:$PATH"
unset PYTHONHOME PYTHONPATH QGIS_OPTS

missing_packages() {
  local name state
  while read -r name; do
    [[ -z $name || $name == \#* ]] && continue
    state=$(dpkg-query -W -f='${db:Status-Abbrev}' "$name" 2>/dev/null || true)
    [[ $state == ii* || $state == hi* ]] || echo "$name"
  done <scripts/packages.txt
}

install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "No apt here: make sure that the counterparts of scripts/packages.txt are installed."
    return
  fi
  local missing elevate=()
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]})) || return 0
  local line="apt-get update && apt-get install --no-install-recommends ${missing[*]}"
  if ((EUID != 0)); then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
      elevate=(sudo)
    elif command -v sudo >/dev/null; then
      fail "packages are missing; run this first: sudo sh -c '$line'"
    else
      fail "packages are missing; run this as root first: $line"
    fi
  fi
  step "installing ${missing[*]}"
  local apt=("${elevate[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  # A stale or partly failing package list is no reason to stop: the installation tells whether it was enough.
  "${apt[@]}" update >/dev/null || echo "apt-get update had trouble; trying with the package lists as they are."
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null \
    || fail "apt could not install the packages above; run this to see why: ${elevate[*]} $line"
}

# Through sudo, only the packages are installed as root; the rest runs as the user who called.
leave_root() {
  if ((EUID == 0)) && [[ -n ${SUDO_UID:-} && ${SUDO_UID} != 0 ]]; then
    exec sudo -H -u "#$SUDO_UID" -- "$PWD/scripts/$(basename "$0")" "$@"
  fi
}

# build <target>...: configure the release preset in build/ and build the targets.
build() {
  local cache=build/CMakeCache.txt options=()
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$cache"; then
    rm -rf build # configured for another folder: the tree was copied or moved
  fi
  mkdir -p build 2>/dev/null || true
  [[ -w build ]] || fail "build/ belongs to $(stat -c %U build 2>/dev/null || echo another user); remove it, or give it to yourself with chown."
  if command -v ccache >/dev/null; then
    options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  step "configuring (build/)"
  quiet cmake --preset release "${options[@]}"
  step "building ($*)"
  quiet cmake --build build --parallel "${SIGHTBOUND_JOBS:-$(nproc)}" --target "$@"
}

install_packages
leave_root "$@"
