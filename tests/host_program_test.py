# SPDX-License-Identifier: Apache-2.0
"""The host program that docs/spec/parol6.md shows obeys what that page demands of hosts: it homes and
jogs an emulated board, and leaves one alone whose emergency stop is pressed.

    /usr/bin/python3 tests/host_program_test.py build/release/cli/armjig docs/spec/parol6.md
"""
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

import example_guide

# On a machine that has no time for the program its rhythm is bad, too.
RHYTHM = {"parol6.host.rate-slow", "parol6.host.jitter", "parol6.host.gap-in-motion"}


def session(armjig, program, *words, hand=""):
    """What the program says, and the rules that it broke."""
    emulator = subprocess.Popen([armjig, "emulate", "parol6", "--check", "--json"], text=True,
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
    port = json.loads(emulator.stdout.readline())["listening"][0].removeprefix("pty:")
    if hand:
        emulator.stdin.write(hand + "\n")
        emulator.stdin.flush()
        assert " is " in emulator.stderr.readline()  # it has been done
    run = subprocess.run([sys.executable, program, port, *words], text=True, timeout=120,
                         capture_output=True, check=False)
    emulator.send_signal(signal.SIGINT)
    report = json.loads(emulator.communicate(timeout=30)[0])
    broken = {row["name"] for row in report["rows"] if row["verdict"] == "fail"}
    return run.stdout + run.stderr, broken - RHYTHM


def check(armjig, folder, text):
    program = folder / "host.py"
    program.write_text(text)
    assert text.count("\n") == 40, text.count("\n")

    said, broken = session(armjig, program, "home")
    begin, end = map(int, re.fullmatch(r"J1 went from (\d+) to (\d+)\n", said).groups())
    assert begin == 10240 and 900 < end - begin < 1300, said  # where J1 stands when it is homed
    assert not broken, broken

    said, broken = session(armjig, program, hand="estop 0")
    assert "emergency stop is pressed" in said and not broken, (said, broken)

    program.write_text(text.replace("[IDLE, ENABLE]", "[IDLE, DISABLE]"))
    said, broken = session(armjig, program)
    assert broken >= {"parol6.host.move-disabled"}, broken


def main(armjig, page):
    with tempfile.TemporaryDirectory() as folder:
        check(armjig, pathlib.Path(folder), example_guide.named_blocks(page)["host.py"])
    print("ok")


main(*sys.argv[1:])
