#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Emulated devices of a process each on their kind of link, and commands that stand for somebody beside them."""

import contextlib
import os
import pathlib
import re
import shlex
import signal
import subprocess
import tempfile

# How each is hosted, and the input that makes it as new. None does that to the axes and fingers of a board, so its
# program is started again.
DEVICES = {"parol6": (["--link", "{folder}/arm"], None), "kinovazed": (["--tcp", "0"], "restart"),
           "morap": ([], "power")}
RESTART = """
kill $(cat {folder}/pid)
while [ -L {folder}/arm ]; do sleep 0.01; done
{command} </dev/null >/dev/null 2>&1 &
echo $! >{folder}/pid
while ! [ -L {folder}/arm ]; do sleep 0.01; done
"""
# The emulator says of each input that it is set.
HAND = """
had=$(grep -c "$1 is $2\\$" {answers})
echo "$1 $2" >{inputs}
tries=0
while [ $(grep -c "$1 is $2\\$" {answers}) -eq $had ]; do
  tries=$((tries + 1))
  [ $tries -gt 400 ] && exit 1
  sleep 0.005
done
"""


class Hosted:
    """An emulated device and what who talks to it has to know of it."""

    def __init__(self, armjig, device, folder, *options):
        self.armjig, self.device, self.folder = armjig, device, pathlib.Path(folder)
        place, restart = DEVICES[device]
        self.inputs, self.answers = self.folder / "inputs", self.folder / "answers"
        os.mkfifo(self.inputs)
        # Open for both directions, so that nobody waits for the other end, and it never ends.
        inputs = os.open(self.inputs, os.O_RDWR)
        command = [armjig, "emulate", device, *(word.format(folder=folder) for word in place), *options]
        # No pipe: a server logs each position that it is asked for, and would stand still once nobody took that.
        with open(self.answers, "wb") as log:
            self.process = subprocess.Popen(command, stdin=inputs, stdout=subprocess.PIPE, stderr=log, text=True)
        os.close(inputs)
        self.pid = self.folder / "pid"
        self.pid.write_text(f"{self.process.pid}\n")
        self.environment = dict(os.environ)
        self.target = self.find()
        self.hand = self.script("hand", HAND.format(inputs=self.inputs, answers=self.answers))
        self.restart = f"{self.hand} {restart} 1" if restart else self.script(
            "restart", RESTART.format(folder=folder, command=shlex.join(command)))

    def find(self):
        line = self.process.stdout.readline()
        if self.device == "parol6":  # the name that stays comes last
            line = self.process.stdout.readline()
        if self.device == "morap":
            for word in self.process.stdout.readline().split():
                if "=" in word:
                    name, _, value = word.partition("=")
                    self.environment[name] = value
            return "i2c:/dev/i2c-1"
        return line.split()[1]

    def script(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return f"sh {path}"

    def memory(self):
        """In KiB."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def run(self, *arguments):
        """A command of armjig for this device, with all permissions."""
        return subprocess.run([self.armjig, *arguments, "--target", self.target, "--allow", "all"],
                              capture_output=True, text=True, check=False, env=self.environment)

    def end(self):
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(self.pid.read_text()), signal.SIGTERM)
        self.process.communicate()


@contextlib.contextmanager
def hosted(armjig, device, *options):
    with tempfile.TemporaryDirectory() as folder:
        one = Hosted(armjig, device, folder, *options)
        try:
            yield one
        finally:
            one.end()


def load():
    return f"load {os.getloadavg()[0]:.0f}"


def come_first():
    """On a machine that is busy with other things, if that is permitted."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
