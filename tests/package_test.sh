#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs a build and makes Debian packages of it; both must serve a user who has nothing else.
#
#   tests/package_test.sh build/release
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The program below a prefix says its version and replays the recordings that came with it.
check_program() {
  local prefix=$1
  "$prefix/bin/armjig" --version | grep -x 'armjig [0-9.]*'
  "$prefix/bin/armjig" trace verify "$prefix/share/armjig/captures" | tail -n 1
  grep -q 'complete .* armjig$' "$prefix/share/bash-completion/completions/armjig"
  grep -q 'parol6' "$prefix/lib/udev/rules.d/60-armjig.rules"
}

# A project that knows only the prefix finds the libraries in it, and runs.
check_libraries() {
  cmake -G Ninja -S tests/consumer -B "$work/consumer" --fresh -DCMAKE_PREFIX_PATH="$1"
  cmake --build "$work/consumer" -j "$(nproc)"
  "$work/consumer/talk_to_board"
  "$work/consumer/check_board"
}

make_packages() {
  cpack --config "$build/CPackConfig.cmake" -B "$work/packages"
  lintian --fail-on error "$work"/packages/*.deb
}

# Really installs and removes the program; only where nobody minds.
check_dpkg() {
  dpkg -i "$work"/packages/armjig_*.deb
  check_program /usr
  dpkg -r armjig
  [[ ! -e /usr/bin/armjig ]]
}

cmake --install "$build" --prefix "$work/installed" >/dev/null
check_program "$work/installed"
check_libraries "$work/installed"

make_packages
for package in "$work"/packages/*.deb; do dpkg -x "$package" "$work/unpacked"; done
check_program "$work/unpacked/usr"
check_libraries "$work/unpacked/usr"
if [[ ${CI:-} == true ]] && ((EUID == 0)); then check_dpkg; fi
echo 'package test: passed'
