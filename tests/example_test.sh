#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Somebody else's device, examples/modbus-gripper, with nothing of armjig but an installed build: it
# is configured, built and tested, then used as its author would.
#
#   tests/example_test.sh build/release
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/.."
example=examples/modbus-gripper
glue=(device.cpp device.hpp main.cpp CMakeLists.txt)
most_glue=150
work=$(mktemp -d)
emulator=
trap '[[ -z $emulator ]] || kill "$emulator"; rm -rf "$work"' EXIT

# Runs the stranger's program; it has to end with that exit code. Its output is in $work/out.
gripper() {
  local wanted=$1 code=0
  shift
  "$work/build/modbus-gripper" "$@" >"$work/out" 2>"$work/err" || code=$?
  ((code == wanted)) && return
  echo "modbus-gripper $*: exit code $code, not $wanted"
  tail -n 40 "$work/out" "$work/err"
  exit 1
}

# The output, or the messages, of the last run have that in them.
says() {
  grep -qE -- "$1" "$work/out" "$work/err" && return
  echo "nothing says '$1':"
  tail -n 40 "$work/out" "$work/err"
  exit 1
}

# The folder alone, so that nothing else of this tree can be found.
build_it() {
  local launcher=()
  if type ccache >/dev/null 2>&1; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  cmake --install "$build" --prefix "$work/installed" >/dev/null
  cp -r "$example" "$work/example"
  cmake -G Ninja -S "$work/example" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/installed" "${launcher[@]}"
  cmake --build "$work/build" -j "$(nproc)"
  ctest --test-dir "$work/build" --output-on-failure -j "$(nproc)"
}

count_glue() {
  local lines
  lines=$(cd "$example" && cat "${glue[@]}" | wc -l)
  echo "glue: $lines lines"
  ((lines <= most_glue))
}

use_it() {
  gripper 0 decode gripper -v 01 03 00 07 00 01 35 CB
  says 'register +7$'
  gripper 0 conformance gripper --target emulated:
  says '^[0-9]+ passed, 0 failed$'
  gripper 0 conformance mutants gripper
  gripper 1 conformance gripper --target 'emulated:?fault=crc-order'
  says '^FAIL +gripper.crc.order'
  gripper 0 trace verify "$example/recordings"
  says '^traces: 1 identical: 1 different: 0$'
  gripper 2 fuzz gripper --target emulated: --learn
  says 'its entry has no alphabet'
  gripper 0 watch gripper --target emulated: --count 3
  says '3 sent, 3 answered'
  gripper 0 console gripper --target emulated: <<<'send 01 03 00 07 00 01 35 CB
wait 0.1'
  says 'model'
}

misuse_it() {
  gripper 2 decode egg 00
  says 'gripper, gripper-1200'
  gripper 2 conformance gripper --target 'emulated:?egg=1'
  says 'egg'
  gripper 2 conformance gripper --target emulated: --egg
  gripper 2 fry
}

# Hosts a gripper at 1,200 baud: a character takes 9 ms, and silence is what really passes.
host() {
  "$work/build/modbus-gripper" emulate gripper-1200 --link "$work/line" "$@" >"$work/emulator" 2>&1 &
  emulator=$!
  timeout 10 bash -c "until [[ -e $work/line ]]; do sleep 0.05; done"
}

leave() {
  kill "$emulator"
  wait "$emulator"
  emulator=
}

meet_on_a_slow_line() {
  local fault
  host
  gripper 0 conformance gripper-1200 --target "pty:$work/line" --allow state,grip
  says '^[0-9]+ passed, 0 failed'
  gripper 4 conformance gripper-1200 --target "pty:$work/line" --filter move
  says 'needs --allow grip'
  gripper 0 watch gripper-1200 --target "pty:$work/line" --count 2
  leave
  for fault in gap-ignored gap-fatal no-silence short-silence long-silence; do
    host --set "fault=$fault"
    gripper 1 conformance gripper-1200 --target "pty:$work/line" --filter silence
    says '^FAIL +gripper.silence'
    leave
  done
}

# What the guide shows of the program is what the program shows.
check_guide() {
  PATH=$work/build:$PATH python3 tests/example_guide.py docs/adding-a-device.md "$example"
}

count_glue
build_it
use_it
misuse_it
check_guide
meet_on_a_slow_line
echo 'example test: passed'
