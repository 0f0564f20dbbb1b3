#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Whole suites on sound devices accuse none: verdicts_soak.py ARMJIG [RUNS [DEVICE...]]

Each device is hosted on its kind of link (a pseudo-terminal, TCP, a virtual I2C bus), with commands for hands, restarts
and power cycles. A quiet run first, alone; then RUNS runs (60), four at a time beside two busy loops, of devices that
are as fast or slow as sound ones may be. What fails, is flaky, or is in the way of the rig is false; of what the quiet
run judged, each has to judge 97 %."""

import concurrent.futures
import contextlib
import json
import subprocess
import sys
import time

from hosted_devices import DEVICES, hosted, load

ARMJIG = sys.argv[1]
RUNS = int(sys.argv[2]) if len(sys.argv) > 2 else 60
CHOSEN = sys.argv[3:] or list(DEVICES)
AT_ONCE = 4
BUSY_LOOPS = 2
LEAST_SHARE = 0.97
JUDGED = ("pass", "deviation")
FALSE = ("fail", "flaky", "error")

# The first is that of the quiet run; the runs beside busy loops take them in turn.
SOUND = {"parol6": ["pass-us=10", "pass-us=100", "pass-us=250"],
         "kinovazed": ["call-us=600", "plant=bench", "call-us=19000"],
         "morap": ["pen=yes", "nodes=1"]}
# What switches it off and on, or starts it again, as an input.
BACK = {"parol6": ["--power-cycle", "power"], "kinovazed": ["--restart", "restart"], "morap": ["--power-cycle", "power"]}


def verdicts_of(device, option):
    """What the cases come to, and how long that took."""
    begun = time.time()
    with hosted(ARMJIG, device, "--set", option) as one:
        way, back = BACK[device]
        report = one.folder / "report.json"
        done = one.run("conformance", device, "--tier", "full", "--require", "0", "--hand", one.hand, way,
                       f"{one.hand} {back} 1", "--json", str(report))
        if not report.exists():
            sys.exit(f"{device} {option}: no report; {done.stderr.strip()}")
        return json.loads(report.read_text())["rows"], time.time() - begun


def named(rows, *verdicts):
    return {row["name"]: row for row in rows if row["verdict"] in verdicts}


def counts(rows):
    verdicts = sorted({row["verdict"] for row in rows})
    return ", ".join(f"{len(named(rows, verdict))} {verdict}" for verdict in verdicts)


def tell(device, option, rows, seconds):
    print(f"{device} {option}: {counts(rows)}; {seconds:.0f} s; {load()}", flush=True)
    for name, row in named(rows, *FALSE).items():
        print(f"  {row['verdict']} {name}: {row['expected']} / {row['actual']}", flush=True)
    if left_open := list(named(rows, "inconclusive")):
        print(f"  inconclusive: {', '.join(left_open)}", flush=True)


@contextlib.contextmanager
def busy():
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(BUSY_LOOPS)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def busy_run(device, option, quiet):
    rows, seconds = verdicts_of(device, option)
    tell(device, option, rows, seconds)
    false = named(rows, *FALSE)
    share = len(quiet & named(rows, *JUDGED).keys()) / len(quiet)
    print(f"  {share:.1%} of what the quiet run judged", flush=True)
    return [f"{device} {option}: {', '.join(false)}"] * bool(false) + [
        f"{device} {option}: {share:.1%}"] * (share < LEAST_SHARE)


def check(device):
    option = SOUND[device][0]
    rows, seconds = verdicts_of(device, option)
    tell(device, f"{option}, quiet", rows, seconds)
    troubles = [f"{device} {option}, quiet: {name}" for name in named(rows, *FALSE)]
    quiet = named(rows, *JUDGED).keys()
    with busy(), concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        options = [SOUND[device][run % len(SOUND[device])] for run in range(RUNS)]
        for found in pool.map(lambda one: busy_run(device, one, quiet), options):
            troubles += found
    return troubles


def main():
    if unknown := [device for device in CHOSEN if device not in DEVICES]:
        sys.exit(f"{', '.join(unknown)}: no such device; {', '.join(DEVICES)}")
    begun = time.time()
    troubles = [trouble for device in CHOSEN for trouble in check(device)]
    print(f"{time.time() - begun:.0f} s; " + ("; ".join(troubles) or "all well"))
    return 1 if troubles else 0


if __name__ == "__main__":
    sys.exit(main())
