#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A conformance run that is stopped for longer than its supervisor waits, while the arm moves.

usage: stopped_conformance_test.py ARMJIG
"""
import concurrent.futures
import contextlib
import json
import signal
import subprocess
import sys
import tempfile
import threading
import time

# Of the silence of a program the supervisor waits half a second for.
STOPPED = 1.2
STOPS = 4


@contextlib.contextmanager
def emulated(armjig, device, *options):
    emulator = subprocess.Popen([armjig, "emulate", device, "--json", *options],
                                stdout=subprocess.PIPE, text=True)
    try:
        yield json.loads(emulator.stdout.readline())["listening"][0]
    finally:
        emulator.send_signal(signal.SIGINT)
        emulator.wait(timeout=30)


def stop_now_and_then(process):
    for _ in range(STOPS):
        time.sleep(0.7)
        if process.poll() is not None:
            return
        process.send_signal(signal.SIGSTOP)
        time.sleep(STOPPED)
        process.send_signal(signal.SIGCONT)


def check(armjig, device, cases, *options):
    with emulated(armjig, device, *options) as target, tempfile.NamedTemporaryFile() as file:
        suite = subprocess.Popen([armjig, "conformance", device, "--target", target, "--allow",
                                  "state,home,move", "--filter", cases, "--require", "0",
                                  "--json", file.name],
                                 stdout=subprocess.PIPE, text=True)
        stopper = threading.Thread(target=stop_now_and_then, args=(suite,))
        stopper.start()
        out = suite.communicate(timeout=300)[0]
        stopper.join()
        report = json.load(open(file.name))
    judged = {row["verdict"] for row in report["rows"]}
    unsupervised = [row for row in report["rows"] if "watches over" in str(row)]
    assert suite.returncode == 0, (suite.returncode, out)
    assert "stopped" in report["facts"], report["facts"]
    assert not unsupervised, unsupervised
    assert judged <= {"pass", "skipped", "inconclusive"}, out
    return f"{device}: {report['facts']['stopped']}"


def main(armjig):
    with concurrent.futures.ThreadPoolExecutor() as both:
        runs = [both.submit(check, armjig, "parol6", "parol6.jog"),
                both.submit(check, armjig, "kinovazed", "kinovazed.joystick.a", "--tcp", "0")]
    for run in runs:
        print(run.result())


main(*sys.argv[1:])
