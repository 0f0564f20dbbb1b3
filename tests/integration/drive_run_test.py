#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A drive at 100 Hz over a real pseudo-terminal, and what it says of itself.

    drive_run_test.py ARMJIG SECONDS

How late and how fast is measured and printed, not judged: it depends on the machine. Judged is that
the counts add up: every deadline has a send or is reported as skipped, every frame was answered or is
reported as lost, and with a link that loses frames on purpose just those are lost. On a machine that
stands still for so long that answers come too late to count, more may be.
"""
import re
import subprocess
import sys

ARMJIG = sys.argv[1]
SECONDS = int(sys.argv[2])
RATE = 100
STALL_MS = 100


def watch(target, *more):
    """The numbers of the summary, by the words behind them."""
    run = subprocess.run([ARMJIG, "watch", "parol6", "--target", target, "--seconds", str(SECONDS),
                          *more], capture_output=True, text=True, timeout=SECONDS + 60)
    assert run.returncode == 0, run.stderr
    link, round_trip, schedule, *rest = re.findall(r"^(?:link|round trip|schedule|impaired) .*$",
                                                   run.stdout, re.M)
    print(link, round_trip, schedule, *rest, sep="\n")
    assert re.search(r"late by [0-9.]+ / [0-9.]+ / [0-9.]+ ms", schedule), "jitter is not reported"
    numbers = {word: int(count) for count, word in re.findall(r"(\d+) (\w+)", f"{link} {schedule}")}
    numbers["most_ms"] = float(re.search(r"([0-9.]+) ms at", round_trip)[1])
    lost_on_purpose = sum(int(count) for count in re.findall(r"(\d+) chunks_lost", *rest or [""]))
    return numbers, lost_on_purpose


def check(numbers, lost_on_purpose):
    deadlines = numbers["sent"] + numbers["skipped"]
    assert deadlines == SECONDS * RATE, f"{deadlines} deadlines in {SECONDS} s"
    assert numbers["answered"] + numbers["lost"] == numbers["sent"], numbers
    assert numbers["bad"] == 0, numbers
    given_up = numbers["lost"] - lost_on_purpose  # and perhaps answered after all, then surplus
    assert 0 <= numbers["surplus"] <= given_up, (numbers, lost_on_purpose)
    assert given_up == 0 or numbers["most_ms"] > STALL_MS, (numbers, lost_on_purpose)


def main():
    emulator = subprocess.Popen([ARMJIG, "emulate", "parol6"], stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True)
    try:
        target = emulator.stdout.readline().split()[1]
        check(*watch(target))
        numbers, lost = watch(target, "--impair", "loss=1%,seed=11")
        check(numbers, lost)
        assert lost > 0, "nothing was lost, so nothing was shown"
    finally:
        emulator.terminate()
        emulator.wait()


main()
