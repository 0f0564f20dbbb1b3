#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cases that need somebody at the device run over a link with --hand, --restart and --power-cycle.

usage: conformance_hands_test.py ARMJIG
"""
import concurrent.futures
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile

# Starts the emulator anew, whatever became of the one before, and waits until it listens.
RESTART = """#!/bin/sh
cd "$(dirname "$0")" || exit 1
[ -s pid ] && kill -9 "$(cat pid)"
rm -f place
echo restarted >> told
"{armjig}" emulate kinovazed --tcp {port} --bind {address} < /dev/null > place 2> /dev/null &
echo $! > pid
while [ ! -s place ]; do kill -0 $! || exit 1; sleep 0.05; done
"""
# What was asked for is done when the command ends: the emulator says of each input that it is set.
HAND = """#!/bin/sh
cd "$(dirname "$0")" || exit 1
set_input() {
  before=$(grep -c "$1 is $2" said)
  echo "$1 $2" > input
  while [ "$(grep -c "$1 is $2" said)" -le "$before" ]; do sleep 0.01; done
}
"""
SET = HAND + """echo "$1 $2" >> told
set_input "$1" "$2"
"""
POWER = HAND + """echo switched >> told
set_input power 1
"""


class Folder:
    def __init__(self, armjig, path):
        self.armjig = armjig
        self.path = path
        self.environment = dict(os.environ)  # of programs that are to find the device

    def file(self, name):
        return os.path.join(self.path, name)

    def script(self, name, text):
        with open(self.file(name), "w") as file:
            file.write(text)
        os.chmod(self.file(name), 0o755)
        return self.file(name)

    def told(self):
        return open(self.file("told")).read().split("\n") if os.path.exists(self.file("told")) else []

    def verdicts(self, device, target, case, *options):
        """What the cases come to, by their names."""
        report = self.file("report.json")
        ended = subprocess.run([self.armjig, "conformance", device, "--target", target, "--allow",
                                "all", "--filter", case, "--require", "0", "--json", report,
                                *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, timeout=280, env=self.environment)
        result = json.load(open(report))
        assert "processors" in result["facts"]["host load"], result["facts"]
        has_twin = not target.startswith("i2c:")
        assert has_twin == ("an emulated device's answers in" in result["facts"]), result["facts"]
        rows = result["rows"]
        return {row["name"]: row["verdict"] for row in rows}, ended.stdout


def free_place():
    """An address on loopback that nothing else uses, so that nobody takes its port between restarts."""
    address = f"127.{os.getpid() >> 16 & 127 | 64}.{os.getpid() >> 8 & 255}.{os.getpid() & 255}"
    with socket.socket() as one:
        one.bind((address, 0))
        return one.getsockname()


def check_restart(armjig, path):
    folder = Folder(armjig, path)
    address, port = free_place()
    restart = folder.script("restart", RESTART.format(armjig=os.path.abspath(armjig),
                                                      address=address, port=port))
    subprocess.run([restart], check=True)
    first = open(folder.file("pid")).read()
    try:
        case = "kinovazed.death.accept-reset"
        target = f"tcp:{address}:{port}"
        alone, _ = folder.verdicts("kinovazed", target, case)
        assert alone[case] == "skipped" and set(alone.values()) == {"skipped"}, alone
        verdicts, out = folder.verdicts("kinovazed", target, case, "--restart", restart)
        assert verdicts.keys() == alone.keys() and set(verdicts.values()) == {"pass"}, out
        # Each connection has a clock of its own.
        verdicts, out = folder.verdicts("kinovazed", target, "kinovazed.connection.half-close")
        assert verdicts and set(verdicts.values()) == {"pass"}, out
        start = "kinovazed.state.start"
        verdicts, out = folder.verdicts("kinovazed", target, start, "--restart", restart)
        assert verdicts[start] == "pass", out
        assert open(folder.file("pid")).read() != first
    finally:
        os.kill(int(open(folder.file("pid")).read()), signal.SIGKILL)
    return f"restarted {folder.told().count('restarted') - 1} times"


@contextlib.contextmanager
def emulated_with_hands(armjig, path, device, *options):
    """An emulated device that takes inputs, its place, and a command that sets them."""
    folder = Folder(armjig, path)
    os.mkfifo(folder.file("input"))
    hand = folder.script("hand", SET)
    entry = os.open(folder.file("input"), os.O_RDWR)  # kept open, so that it never ends
    said = open(folder.file("said"), "w")
    emulator = subprocess.Popen([armjig, "emulate", device, "--json", *options], stdin=entry,
                                stdout=subprocess.PIPE, stderr=said, text=True)
    try:
        place = json.loads(emulator.stdout.readline())
        folder.environment |= dict(word.split("=", 1) for word in place.get("environment", []))
        yield folder, place["listening"][0], hand
    finally:
        emulator.send_signal(signal.SIGTERM)
        emulator.wait(timeout=30)
        os.close(entry)
        said.close()


def check_hand(armjig, path):
    with emulated_with_hands(armjig, path, "parol6") as (folder, target, hand):
        power = folder.script("power", POWER)
        for case in ("parol6.io.in1-bit", "parol6.command.zero-at-start"):
            alone, out = folder.verdicts("parol6", target, case)
            assert set(alone.values()) == {"skipped"}, out
            verdicts, out = folder.verdicts("parol6", target, case, "--hand", hand,
                                            "--power-cycle", power)
            assert verdicts and set(verdicts.values()) == {"pass"}, out
        verdicts, out = folder.verdicts("parol6", target, "estop-ignored", "--hand", hand)
        assert verdicts and set(verdicts.values()) == {"skipped"}, out  # our own guard ends them
        told = folder.told()
        assert "in1 1" in told and "in1 0" in told, told
        assert "switched" in told and "power 1" not in told, told
    return f"{len(told) - 1} things done by hand"


def check_bus(armjig, path):
    """A hand holds the shaft; what has to come between two ticks of an idle node stays skipped."""
    with emulated_with_hands(armjig, path, "morap") as (folder, target, hand):
        alone, out = folder.verdicts("morap", target, "morap.angle.scale")
        assert set(alone.values()) == {"skipped"}, out
        verdicts, out = folder.verdicts("morap", target, "morap.angle.scale", "--hand", hand)
        assert verdicts and set(verdicts.values()) == {"pass"}, out
        verdicts, out = folder.verdicts("morap", target, "at-tick", "--hand", hand)
        for name, verdict in verdicts.items():
            assert verdict == ("pass" if name.endswith(".slowly") else "skipped"), out
        # Whoever held the shaft lets it go where it has to turn.
        freed, out = folder.verdicts("morap", target, "current", "--hand", hand)
        assert freed["morap.current.zero"] == freed["morap.motion.current"] == "pass", out
    return f"{len(verdicts)} cases at ticks"


def check_slow_hand(armjig, path):
    """A hand that takes its time makes no server faulty.

    Neither does what the server sees before it hears a command, nor that the arm is stopped since nobody gave a sign
    of life for half a second.
    """
    with emulated_with_hands(armjig, path, "kinovazed", "--tcp", "0") as (folder, target, hand):
        for case, seconds, verdict, reason in (
                ("kinovazed.death.retract-read", 0.05, "inconclusive", "takes longer than the server to look"),
                ("kinovazed.joystick.bounds.outside", 0.2, "pass", ""),
                ("kinovazed.joystick.bounds.outside", 0.7, "skipped", "without a sign of life")):
            slow = folder.script("slow", f'#!/bin/sh\n"{hand}" "$@" && sleep {seconds}\n')
            verdicts, out = folder.verdicts("kinovazed", target, case, "--hand", slow, "--restart", f"{hand} restart 1")
            assert verdicts == {case: verdict} and reason in out, out
    return "slow hands are known"


def main(armjig):
    with contextlib.ExitStack() as folders, concurrent.futures.ThreadPoolExecutor() as pool:
        runs = [pool.submit(check, armjig, folders.enter_context(tempfile.TemporaryDirectory()))
                for check in (check_restart, check_hand, check_slow_hand, check_bus)]
        for run in runs:
            print(run.result())


main(*sys.argv[1:])
