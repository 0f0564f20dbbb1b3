#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How often `armjig latency --against` is right on real pseudo-terminals.

    latency_against_soak.py ARMJIG DELAYED_ECHO [TRIALS [SECONDS [AT_ONCE]]]

Each trial starts two devices that take about a millisecond for an answer, and measures one against
the other for 60 s a side: an identical one, one that is 10 % slower, one that is 20 us slower. Of
200 trials at least 184 have to flag the slower one, and at most 6 the identical one.
"""
import concurrent.futures
import itertools
import json
import os
import subprocess
import sys

ARMJIG, ECHO = sys.argv[1:3]
GIVEN = [int(text) for text in sys.argv[3:]]
TRIALS, SECONDS, AT_ONCE = GIVEN + [200, 60, 16][len(GIVEN):]
MEAN, DEVIATION = 1000, 100
SIDES = {"identical": MEAN, "10 % slower": 1.1 * MEAN, "20 us slower": MEAN + 20}


def start_echo(mean, seed):
    return subprocess.Popen([ECHO, str(mean), str(DEVIATION), str(seed)], stdout=subprocess.PIPE, text=True)


def is_flagged(name, number):
    """Whether it is said to be slower or faster."""
    echoes = [start_echo(MEAN, 2 * number), start_echo(SIDES[name], 2 * number + 1)]
    try:
        first, second = ("pty:" + echo.stdout.readline().strip() for echo in echoes)
        run = subprocess.run([ARMJIG, "latency", "demo", "--target", first, "--against", second, "--seconds",
                              str(SECONDS), "--json", "-"], capture_output=True, text=True)
    finally:
        for echo in echoes:
            echo.kill()
            echo.wait()
    told, _ = json.JSONDecoder().raw_decode(run.stdout)
    if run.returncode not in (0, 1):
        sys.exit(f"latency_against_soak: trial {number} ended with {run.returncode}: {run.stderr[-500:]}")
    is_one = told["comparison"]["difference"] != "no difference" if name == "identical" else run.returncode == 1
    if is_one == (name == "identical"):
        print(f"trial {number}, {name}: {json.dumps(told['comparison'])}", flush=True)
    return is_one


def main():
    trials = list(itertools.product(range(TRIALS), SIDES))
    flagged = dict.fromkeys(SIDES, 0)
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        results = pool.map(lambda trial: is_flagged(trial[1], trial[0] * len(SIDES)), trials)
        for (number, name), is_one in zip(trials, results):
            flagged[name] += is_one
            if name == list(SIDES)[-1]:
                told = ", ".join(f"{side} {count}" for side, count in flagged.items())
                print(f"of {number + 1} each flagged: {told}; load {os.getloadavg()[0]:.1f}", flush=True)
    is_met = flagged.pop("identical") * 200 <= 6 * TRIALS and all(
        count * 200 >= 184 * TRIALS for count in flagged.values())
    sys.exit(0 if is_met else 1)


main()
