#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What the host does to a schedule, on this machine as it is: needs a pseudo-terminal and cyclictest (rt-tests).

    latency_host_soak.py ARMJIG [PAIRS]

Schedule: `armjig latency` at 1 kHz and cyclictest at 1 kHz in alternated slices of a second. The
median of our slices' errors at 99 % is at most twice cyclictest's plus 50 us, and every deadline is
sent or reported as skipped.

Truth: armjig itself is stopped for 100 ms while an answer is on its way. The report has to call it
the host's.
"""
import json
import os
import pathlib
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

ARMJIG = sys.argv[1]
PAIRS = int(sys.argv[2]) if len(sys.argv) > 2 else 60
RATE = 1000
PRIORITY = "50"


def latency(target, *more):
    return [ARMJIG, "latency", "demo", "--target", target, "--json", "-", "--priority", PRIORITY, *more]


def ours(target):
    """The error of the schedule at 99 % in a second, in microseconds."""
    run = subprocess.run(latency(target, "--rate", str(RATE), "--seconds", "1"),
                         capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    told = json.loads(run.stdout)
    deadlines = told["sent"] + told["skipped"]
    # The last deadline is the end of the second; somebody may have been late for it.
    assert RATE - 1 <= deadlines <= RATE, f"{deadlines} of {RATE} deadlines are reported"
    return told["lateness"]["p99_ns"] / 1000


def cyclictest(program):
    """The same of its only thread."""
    run = subprocess.run([program, "-q", "-m", "-p", PRIORITY, "-i", str(1_000_000 // RATE), "-l",
                          str(RATE), "-h", "100000"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    bins = [(int(at), int(count)) for at, count in re.findall(r"^(\d+)\s+(\d+)$", run.stdout, re.M)]
    wanted, seen = 0.99 * sum(count for _, count in bins), 0
    for at, count in bins:
        seen += count
        if seen >= wanted:
            return at
    raise AssertionError(f"no histogram: {run.stdout[:200]}")


def check_schedule(target):
    program = os.environ.get("CYCLICTEST") or shutil.which("cyclictest")
    if program is None:
        sys.exit("latency_host_soak: cyclictest is not installed (Debian: apt install rt-tests)")
    sides = {ours: [], cyclictest: []}
    for pair in range(PAIRS):
        for side in (ours, cyclictest) if pair % 2 == 0 else (cyclictest, ours):
            sides[side].append(side(target if side is ours else program))
    mine, theirs = (statistics.median(sides[side]) for side in (ours, cyclictest))
    print(f"schedule at 99 %, median of {PAIRS} slices: {mine:.0f} us, cyclictest {theirs:.0f} us, "
          f"bar {2 * theirs + 50:.0f} us; worst slices {max(sides[ours]):.0f} and "
          f"{max(sides[cyclictest])} us", flush=True)
    return mine <= 2 * theirs + 50


def check_stop(target):
    with subprocess.Popen(latency(target, "--closed-loop", "--seconds", "3"), text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as run:
        time.sleep(1.5)
        run.send_signal(signal.SIGSTOP)
        time.sleep(0.1)
        run.send_signal(signal.SIGCONT)
        told = json.loads(run.communicate(timeout=60)[0])
    worst = told["outliers"][0]
    print(f"stopped for 100 ms: a round trip of {worst['round_trip_ns'] / 1e6:.1f} ms, {worst['who']}; "
          f"the sentinel overslept by {told['sentinel']['max_ns'] / 1e6:.1f} ms at most", flush=True)
    return told["sentinel"]["max_ns"] >= 95e6 and (
        worst["round_trip_ns"] < 95e6 or worst["who"].startswith("host"))


def main():
    with tempfile.TemporaryDirectory(prefix="armjig-latency-") as folder:
        link = pathlib.Path(folder) / "arm"
        with subprocess.Popen([ARMJIG, "emulate", "demo", "--link", str(link)],
                              stdout=subprocess.DEVNULL) as emulator:
            while not link.exists():
                assert emulator.poll() is None, "the emulator has ended"
                time.sleep(0.05)
            try:
                results = [check_schedule(f"pty:{link}"), check_stop(f"pty:{link}")]
            finally:
                emulator.terminate()
    sys.exit(0 if all(results) else 1)


main()
