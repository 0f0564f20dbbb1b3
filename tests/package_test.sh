#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs a build and makes Debian packages of it; both must serve a user who has nothing else.
# In CI the -dev packages also serve somebody in a bare Debian 12, with what they depend on and a
# compiler, and no more.
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
  grep -qx '#compdef armjig' "$prefix/share/zsh/vendor-completions/_armjig"
  grep -q '^complete -c armjig ' "$prefix/share/fish/vendor_completions.d/armjig.fish"
  check_documents "$prefix"
  grep -q 'parol6' "$prefix/lib/udev/rules.d/60-armjig.rules"
}

# All of docs/, with specification and schemas; and a manual page with every subcommand of the help.
check_documents() {
  local prefix=$1 subcommand subcommands
  diff -r docs "$prefix/share/doc/armjig/docs"
  [[ -s $prefix/share/doc/armjig/README.md ]]
  subcommands=$("$prefix/bin/armjig" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z0-9]*\) .*/\1/p')
  [[ -n $subcommands ]]
  for subcommand in $subcommands; do
    zgrep -qxF ".SS armjig $subcommand" "$prefix/share/man/man1/armjig.1.gz"
  done
}

# check_libraries PREFIX CONSUMER...: projects that know only the prefix find the libraries in it, and
# run.
check_libraries() {
  local consumer
  for consumer in "${@:2}"; do
    cmake -G Ninja -S "tests/consumer/$consumer" -B "$work/$consumer" --fresh \
      -DCMAKE_PREFIX_PATH="$1"
    cmake --build "$work/$consumer" -j "$(nproc)"
    "$work/$consumer/consumer"
  done
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

# A system with a compiler and nothing else of ours.
make_bare_root() {
  local mirror
  # shellcheck disable=SC2016  # apt expands it
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' 'Component: main' \
    'Created-By: Packages' | head -n 1)
  debootstrap --variant=minbase --include=g++,cmake,ninja-build bookworm "$work/root" "$mirror"
  cp -r "$work/packages" tests/consumer "$work/root/srv/"
}

# check_in_root PACKAGE CONSUMER FORBIDDEN: a project builds and runs with that package alone. What
# matches FORBIDDEN must not come with it.
check_in_root() {
  # shellcheck disable=SC2016  # the shell in there expands it
  chroot "$work/root" /bin/bash -euo pipefail -c '
    apt-get -q -y install --no-install-recommends /srv/packages/libarmjig-embedded-dev_*.deb \
      /srv/packages/$1_*.deb
    if dpkg-query -W -f "\${Package}\n" | grep -E "$3"; then exit 1; fi
    cmake -G Ninja -S "/srv/consumer/$2" -B "/srv/$2"
    cmake --build "/srv/$2"
    "/srv/$2/consumer"' -- "$1" "$2" "$3"
}

check_bare_systems() {
  make_bare_root
  check_in_root libarmjig-embedded-dev embedded '^lib(boost|glib2|usb|serialport|umockdev|toml)'
  check_in_root libarmjig-dev whole '^libboost'
}

cmake --install "$build" --prefix "$work/installed" >/dev/null
check_program "$work/installed"
check_libraries "$work/installed" embedded whole library

make_packages
for package in "$work"/packages/*.deb; do dpkg -x "$package" "$work/unpacked"; done
check_program "$work/unpacked/usr"
check_libraries "$work/unpacked/usr" embedded whole
if [[ ${CI:-} == true ]] && ((EUID == 0)); then
  check_dpkg
  check_bare_systems
fi
echo 'package test: passed'
