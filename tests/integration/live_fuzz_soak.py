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
import json
import re
import subprocess
import sys
import threading
import time

from hosted_devices import DEVICES, come_first, hosted, load
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
MOST_REFUSALS = 100


def campaign(one, report, *arguments):
    return one.run("fuzz", one.device, "--json", str(report), "--out", str(one.folder / "out"), *arguments)


def known_of(device):
    return ["--known", f"{SOURCE}/fuzz/known/{device}-defects.toml"]


def rows_in(report, done):
    if not report.exists():
        raise RuntimeError(done.stderr)
    return json.loads(report.read_text())["rows"]


def failed(rows):
    return [row for row in rows if row["verdict"] == "fail"]


def replayed(one, finding):
    """On one that is as new. A server that was started again takes connections a moment later."""
    subprocess.run(["sh", "-c", one.restart], check=True)
    for _ in range(MOST_REFUSALS):
        done = one.run("replay", finding)
        if "refused" not in done.stdout + done.stderr:
            break
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr)
    return done


def wrong_words(sentence):
    """What the first thing is that it calls wrong, as `echo 0`; none where an answer is missing, or there is one too
    many, so that any difference counts."""
    words = re.search(r" is answered with [^:]*: (.*) instead of ", sentence)
    return words[1].split("; ")[0].removeprefix("nothing") if words else ""


def is_real(device, finding, sentence):
    """A sound device does not show it; what else moves in a long replay is another matter."""
    wrong = wrong_words(sentence)
    with hosted(ARMJIG, device) as sound:
        played = [replayed(sound, finding) for _ in range(3)]
    return any(done.returncode == 0 or wrong not in done.stdout for done in played)


def find_rare(device, name):
    with hosted(ARMJIG, device, "--set", f"fault=rare:{name}") as one:
        report = one.folder / "report.json"
        done = campaign(one, report, "--restart", one.restart, *known_of(device), "--max-time",
                            str(RARE_SECONDS + SHRINKING_SECONDS), "--fail-fast")
        rows = rows_in(report, done)
        found = failed(rows)
        if not found:
            print(f"{device} {name}: not found; {rows[0]['summary']}; {load()}", flush=True)
            return f"{device} {name}: not found"
        seconds, size = re.search(r"([0-9.]+) s after.*?([0-9]+) after shrinking", found[0]["evidence"]).groups()
        most = SHORTEST[device][name] + MOST_SURPLUS
        try:
            finding = next(iter((one.folder / "out" / "findings").glob("*.jsonl")))
            of_it = is_real(device, finding, found[0]["summary"])
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
    with hosted(ARMJIG, device) as one:
        sizes, is_over = [], threading.Event()
        watching = threading.Thread(target=watch, args=(one, sizes, is_over))
        watching.start()
        report = one.folder / "report.json"
        # A program that is started again does not grow.
        restart = ["--restart", one.restart] if DEVICES[device][1] else []
        done = campaign(one, report, *restart, *known_of(device), "--max-time", str(SOUND_SECONDS))
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
    with hosted(ARMJIG, device) as one:
        report = one.folder / "report.json"
        done = campaign(one, report, "--restart", one.restart, "--max-time", str(KNOWN_SECONDS))
        found = failed(rows_in(report, done))
        print(f"{device}: {len(found)} findings without what is known; {load()}", flush=True)
        for row in found:
            print(f"  {row['name']}: {row['summary']}", flush=True)
        return [f"{device}: nothing found"] * (not found)


def side_by_side(what):
    devices = [device for device in DEVICES if is_chosen(device)]
    with concurrent.futures.ThreadPoolExecutor(len(devices)) as pool:
        return [trouble for troubles in pool.map(what, devices) for trouble in troubles]


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
