#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig fuzz` on hosted devices, in real time: live_fuzz_soak.py ARMJIG SOURCE WHAT [DEVICE[:DEFECT]...]

WHAT is one of
  rare   each of the defects that suites do not see (rare_defects_soak.py) is found within five minutes, and shrunk
         within five more to at most 3 records more than the shortest that is known
  sound  campaigns of 20 minutes side by side, with the files of known defects: no finding, and the emulators do not
         grow by a mebibyte
  known  10 minutes side by side without these files: what is found, to be compared with what is known; something is

Each device is on its kind of port: a pseudo-terminal, TCP, a virtual I2C bus. It is started again by its own input, or a
board's program is. Whether a finding is of the defect, `replay` on a sound device tells, under the rules of campaigns."""

import concurrent.futures
import contextlib
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import time

from rare_defects import SHORTEST

ARMJIG, SOURCE, WHAT = sys.argv[1:4]
CHOSEN = sys.argv[4:]
RARE_SECONDS = 300
SHRINKING_SECONDS = 300
MOST_SURPLUS = 3
SOUND_SECONDS = 1200
KNOWN_SECONDS = 600
WARM_UP = 120  # seconds, in which memory is used for the first time
MOST_GROWTH = 1024  # KiB
AT_ONCE = 4

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


class Hosted:
    """An emulated device and what a campaign has to know of it."""

    def __init__(self, device, folder, *options):
        self.device, self.folder = device, pathlib.Path(folder)
        place, restart = DEVICES[device]
        self.inputs, self.answers = self.folder / "inputs", self.folder / "answers"
        os.mkfifo(self.inputs)
        # Open for both directions, so that nobody waits for the other end, and it never ends.
        inputs = os.open(self.inputs, os.O_RDWR)
        command = [ARMJIG, "emulate", device, *(word.format(folder=folder) for word in place), *options]
        # No pipe: a server logs each position that it is asked for, and would stand still once nobody took that.
        with open(self.answers, "wb") as log:
            self.process = subprocess.Popen(command, stdin=inputs, stdout=subprocess.PIPE, stderr=log, text=True)
        os.close(inputs)
        self.pid = self.folder / "pid"
        self.pid.write_text(f"{self.process.pid}\n")
        self.environment = dict(os.environ)
        self.target = self.find()
        self.restart = self.input(restart) if restart else self.script(command)

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

    def input(self, name):
        """A command for the shell that returns when the device has it, which says so."""
        count = f"$(grep -c '{name} is 1$' {self.answers})"
        return f"had={count}; echo {name} 1 >{self.inputs}; while [ {count} -eq $had ]; do sleep 0.005; done; true"

    def script(self, command):
        path = self.folder / "restart"
        path.write_text(RESTART.format(folder=self.folder, command=shlex.join(command)))
        return f"sh {path}"

    def memory(self):
        """In KiB."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def campaign(self, report, *arguments):
        return subprocess.run(
            [ARMJIG, "fuzz", self.device, "--target", self.target, "--allow", "all", "--json", str(report), "--out",
             str(self.folder / "out"), *arguments], capture_output=True, text=True, check=False, env=self.environment)

    def end(self):
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(self.pid.read_text()), signal.SIGTERM)
        self.process.communicate()


@contextlib.contextmanager
def hosted(device, *options):
    with tempfile.TemporaryDirectory() as folder:
        one = Hosted(device, folder, *options)
        try:
            yield one
        finally:
            one.end()


def known_of(device):
    return ["--known", f"{SOURCE}/fuzz/known/{device}-defects.toml"]


def rows_in(report, done):
    if not report.exists():
        raise RuntimeError(done.stderr)
    return json.loads(report.read_text())["rows"]


def failed(rows):
    return [row for row in rows if row["verdict"] == "fail"]


def load():
    return f"load {os.getloadavg()[0]:.0f}"


def shows(one, finding):
    """Whether the finding shows there, too, each of three times."""
    for _ in range(3):
        subprocess.run(["sh", "-c", one.restart], check=True)
        done = subprocess.run([ARMJIG, "replay", finding, "--target", one.target, "--allow", "all"],
                              capture_output=True, text=True, check=False, env=one.environment)
        if done.returncode not in (0, 1):
            raise RuntimeError(done.stderr)
        if done.returncode == 0:
            return False
    return True


def is_real(device, finding):
    """A sound device does not show it."""
    with hosted(device) as sound:
        return not shows(sound, finding)


def find_rare(device, name):
    with hosted(device, "--set", f"fault=rare:{name}") as one:
        report = one.folder / "report.json"
        done = one.campaign(report, "--restart", one.restart, *known_of(device), "--max-time",
                            str(RARE_SECONDS + SHRINKING_SECONDS), "--fail-fast")
        rows = rows_in(report, done)
        found = failed(rows)
        if not found:
            print(f"{device} {name}: not found; {rows[0]['summary']}; {load()}", flush=True)
            return f"{device} {name}: not found"
        seconds, size = re.search(r"([0-9.]+) s after.*?([0-9]+) after shrinking", found[0]["evidence"]).groups()
        most = SHORTEST[device][name] + MOST_SURPLUS
        try:
            of_it = is_real(device, next(iter((one.folder / "out" / "findings").glob("*.jsonl"))))
        except RuntimeError as error:  # as of a supervisor that had no time on this machine
            print(f"{device} {name}: {seconds} s, {size} records of at most {most}, not judged; {error}; {load()}", flush=True)
            return f"{device} {name}: nobody knows whether a sound device shows what was found"
        print(f"{device} {name}: {seconds} s, {size} records of at most {most}{'' if of_it else ', FALSE'}; "
              f"{found[0]['summary'][-300:]}; {load()}", flush=True)
        if not of_it:
            return f"{device} {name}: a sound device shows what was found"
        if float(seconds) > RARE_SECONDS:
            return f"{device} {name}: found after {seconds} s"
        return None if int(size) <= most else f"{device} {name}: {size} records, {most} at most"


def is_chosen(device, name=""):
    return not CHOSEN or device in CHOSEN or f"{device}:{name}" in CHOSEN


def rare():
    # One of each device in turn, so that the ports share the machine.
    in_turn = zip(*([(device, name) for name in names] for device, names in SHORTEST.items()), strict=True)
    chosen = [one for some in in_turn for one in some if is_chosen(*one)]
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(lambda one: find_rare(*one), chosen))


def watch(one, sizes, is_over):
    while not is_over.wait(1):
        sizes.append(one.memory())


def sound_one(device):
    with hosted(device) as one:
        sizes, is_over = [], threading.Event()
        watching = threading.Thread(target=watch, args=(one, sizes, is_over))
        watching.start()
        report = one.folder / "report.json"
        # A program that is started again does not grow.
        restart = ["--restart", one.restart] if DEVICES[device][1] else []
        done = one.campaign(report, *restart, *known_of(device), "--max-time", str(SOUND_SECONDS))
        is_over.set()
        watching.join()
        found = failed(rows_in(report, done))
        growth = max(sizes[WARM_UP:]) - sizes[WARM_UP]
        print(f"{device}: {rows_in(report, done)[0]['summary']}; {len(found)} findings; {sizes[WARM_UP]} KiB, "
              f"{growth} KiB more at most; {load()}", flush=True)
        for row in found:
            print(f"  {row['name']}: {row['summary']} {row['expected']} / {row['actual']}", flush=True)
        return [f"{device}: {len(found)} findings"] * bool(found) + [f"{device} grew"] * (growth >= MOST_GROWTH)


def known_one(device):
    with hosted(device) as one:
        report = one.folder / "report.json"
        done = one.campaign(report, "--restart", one.restart, "--max-time", str(KNOWN_SECONDS))
        found = failed(rows_in(report, done))
        print(f"{device}: {len(found)} findings without what is known; {load()}", flush=True)
        for row in found:
            print(f"  {row['name']}: {row['summary']}", flush=True)
        return [f"{device}: nothing found"] * (not found)


def side_by_side(what):
    devices = [device for device in DEVICES if is_chosen(device)]
    with concurrent.futures.ThreadPoolExecutor(len(devices)) as pool:
        return [trouble for troubles in pool.map(what, devices) for trouble in troubles]


def come_first():
    """On a machine that is busy with other things, if that is permitted."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))


def unknown():
    """What was chosen and is in no list: of that nothing would be played."""
    known = {*DEVICES, *(f"{device}:{name}" for device, names in SHORTEST.items() for name in names)}
    return [one for one in CHOSEN if one not in known]


def main():
    if unknown():
        sys.exit(f"{', '.join(unknown())}: no such device or defect; see DEVICES here and tests/integration/rare_defects.py")
    come_first()
    begun = time.time()
    what = {"rare": rare, "sound": lambda: side_by_side(sound_one), "known": lambda: side_by_side(known_one)}[WHAT]
    troubles = [trouble for trouble in what() if trouble]
    print(f"{time.time() - begun:.0f} s; " + ("; ".join(troubles) or "all well"))
    return 1 if troubles else 0


if __name__ == "__main__":
    sys.exit(main())
