# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What the scripts share: steps with a time and a log, and the build of a preset. Source it; it goes
# to the root of the tree.

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mkdir -p build/log
jobs=$(nproc)
slots=$((jobs + 1))  # of tests at a time: many of them wait
failure_code=1  # of a failed step
# For every call of CMake: warnings are errors in CI.
warnings=-DARMJIG_WERROR=$([[ ${CI:-} == true ]] && echo ON || echo OFF)

# die CODE MESSAGE: 2 for wrong usage, 3 for a machine that cannot do it.
die() {
  echo "${0##*/}: $2" >&2
  exit "$1"
}

# usage TEXT ARGUMENT...: answers --help for scripts without other options.
usage() {
  case ${2:-} in
    '') return ;;
    -h | --help) echo "$1" && exit ;;
    *) die 2 "unknown option '$2'; see --help" ;;
  esac
}

log_of() {
  echo "build/log/${1//[^[:alnum:]+]/-}.log"
}

# step TITLE COMMAND...: runs a command and prints how long it took. What it says goes to a log, and
# to the terminal if it fails.
step() {
  local title=$1 log start=$SECONDS status
  log=$(log_of "$1")
  shift
  printf '%-44s' "$title" >&2
  set +e
  (set -e && "$@") >"$log" 2>&1 </dev/null
  status=$?
  set -e
  if ((status == 0)); then
    printf '%4d s\n' $((SECONDS - start)) >&2
  else
    printf 'failed\n' >&2
    tail -n 80 "$log" >&2
    die "$failure_code" "'$title' failed; all of its output: $log"
  fi
}

# without_aslr COMMAND...: sanitizers of GCC 12 want less address randomisation than some kernels
# give. Where switching it off is forbidden, as in many containers, the command runs as it is.
without_aslr() {
  if setarch -R true 2>/dev/null; then
    setarch -R "$@"
  else
    "$@"
  fi
}

# build PRESET [TARGET...]. The build runs what it has built (shell completion), so that sanitizers
# are concerned.
build() {
  local preset=$1
  shift
  step "configure $preset" cmake --preset "$preset" "$warnings"
  step "build $preset" without_aslr cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
}
