#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Whole suites on sound devices accuse none.

Each device is hosted on its kind of link (a pseudo-terminal, TCP, a virtual I2C bus), with commands for hands, restarts
and power cycles. A quiet run of each first, alone; then RUNS runs of each, several at a time beside two busy loops, of
devices that are as fast or slow as sound ones may be. What fails, is flaky, or is in the way of the rig is false; of
what the quiet run judged, each has to judge 97 %."""

import argparse
import collections
import concurrent.futures
import contextlib
import datetime
import hashlib
import itertools
import json
import pathlib
import subprocess
import sys
import threading
import time

from hosted_devices import DEVICES, hosted, load

BUSY_LOOPS = 2
LEAST_SHARE = 0.97
VERDICTS = {"judged": ("pass", "deviation"), "false": ("fail", "flaky", "error"), "open": ("inconclusive",)}

# The first is that of the quiet run; the runs beside busy loops take them in turn.
SOUND = {"parol6": ["pass-us=10", "pass-us=100", "pass-us=250"],
         "kinovazed": ["call-us=600", "plant=bench", "call-us=19000"],
         "morap": ["pen=yes", "nodes=1"]}
# What switches it off and on, or starts it again, as an input.
BACK = {"parol6": ["--power-cycle", "power"], "kinovazed": ["--restart", "restart"], "morap": ["--power-cycle", "power"]}


class Runs:
    """Runs of one program, those of before too if there is a log, which any other session may go on with."""

    def __init__(self, armjig, log):
        self.armjig, self.log, self.lock = armjig, log, threading.Lock()
        self.program = hashlib.sha256(pathlib.Path(armjig).read_bytes()).hexdigest()
        kept = log.read_text().splitlines() if log and log.exists() else []
        self.all = [run for run in map(json.loads, kept) if run["program"] == self.program]

    def of(self, device, kind):
        return [run for run in self.all if (run["device"], run["kind"]) == (device, kind)]

    def make(self, device, option, kind):
        rows, seconds = verdicts_of(self.armjig, device, option)
        run = {"program": self.program, "date": f"{datetime.datetime.now():%F %R}", "device": device, "kind": kind,
               "option": option, "seconds": round(seconds), "load": load()}
        run |= {name: told(rows, verdicts) for name, verdicts in VERDICTS.items()}
        with self.lock:
            self.all.append(run)
            if self.log:
                with self.log.open("a") as log:
                    print(json.dumps(run), file=log)
            tell(run)


def verdicts_of(armjig, device, option):
    """What the cases come to, and how long that took."""
    begun = time.time()
    with hosted(armjig, device, "--set", option) as one:
        way, back = BACK[device]
        report = one.folder / "report.json"
        done = one.run("conformance", device, "--tier", "full", "--require", "0", "--hand", one.hand, way,
                       f"{one.hand} {back} 1", "--json", str(report))
        if not report.exists():
            sys.exit(f"{device} {option}: no report; {done.stderr.strip()}")
        return json.loads(report.read_text())["rows"], time.time() - begun


def told(rows, verdicts):
    """Of each case with one of the verdicts what it says."""
    return {row["name"]: f"{row.get('expected', '')} / {row.get('actual', '')}" for row in rows
            if row["verdict"] in verdicts}


def tell(run):
    counts = ", ".join(f"{len(run[name])} {name}" for name in VERDICTS)
    print(f"{run['date']} {run['device']} {run['option']}, {run['kind']}: {counts}; {run['seconds']} s; {run['load']}")
    for name in ("false", "open"):
        for case, words in run[name].items():
            print(f"  {name}: {case}: {words}")
    sys.stdout.flush()


@contextlib.contextmanager
def busy():
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(BUSY_LOOPS)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def missing(runs, device, count):
    options = SOUND[device]
    wanted = collections.Counter(options[run % len(options)] for run in range(count))
    made = collections.Counter(run["option"] for run in runs.of(device, "busy"))
    return [(device, option) for option in (wanted - made).elements()]


def make_missing(runs, devices, count, at_once):
    for device in devices:
        if not runs.of(device, "quiet"):
            runs.make(device, SOUND[device][0], "quiet")
    # One of each device in turn, so that the ports share the machine.
    in_turn = itertools.zip_longest(*(missing(runs, device, count) for device in devices))
    wanted = [one for some in in_turn for one in some if one]
    if wanted:
        with busy(), concurrent.futures.ThreadPoolExecutor(at_once) as pool:
            list(pool.map(lambda one: runs.make(*one, "busy"), wanted))


def troubles_of(runs, device):
    (quiet, *_), loaded = runs.of(device, "quiet"), runs.of(device, "busy")
    shares = [len(quiet["judged"].keys() & run["judged"].keys()) / len(quiet["judged"]) for run in loaded]
    least = f", at least {min(shares):.1%} of what the quiet one judged" if shares else ""
    print(f"{device}: {len(loaded)} runs beside busy loops{least}")
    return [f"{device} {run['option']}, {run['kind']}: {', '.join(run['false'])}"
            for run in [quiet, *loaded] if run["false"]] + [
                f"{device} {run['option']}: {share:.1%}" for run, share in zip(loaded, shares, strict=True)
                if share < LEAST_SHARE]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("armjig", metavar="ARMJIG")
    parser.add_argument("runs", metavar="RUNS", type=int, nargs="?", default=60, help="of each device; %(default)s")
    parser.add_argument("devices", metavar="DEVICE", nargs="*", help=", ".join(DEVICES))
    parser.add_argument("--at-once", metavar="N", type=int, default=4, help="beside busy loops; %(default)s")
    parser.add_argument("--log", metavar="FILE", type=pathlib.Path,
                        help="of all runs; those of the same program that are there already count")
    given = parser.parse_args()
    if unknown := [device for device in given.devices if device not in DEVICES]:
        parser.error(f"{', '.join(unknown)}: no such device; {', '.join(DEVICES)}")
    begun = time.time()
    runs = Runs(given.armjig, given.log)
    devices = given.devices or list(DEVICES)
    make_missing(runs, devices, given.runs, given.at_once)
    troubles = [trouble for device in devices for trouble in troubles_of(runs, device)]
    print(f"{time.time() - begun:.0f} s; " + ("; ".join(troubles) or "all well"))
    return 1 if troubles else 0


if __name__ == "__main__":
    sys.exit(main())
