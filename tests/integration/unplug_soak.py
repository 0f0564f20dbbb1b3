#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Links that break at random moments: unplug_soak.py ARMJIG [LINK [COUNT [SEED]]]

For each link (all of LINKS if none is said) COUNT times, several at a time: a program talks to a hosted emulated
device, and the link breaks at a random moment, its start included. Each time the program has to end soon, with exit
code 3 and one clear line, and leave no process behind. And a tenth as often a watch that shall go on does: one process
all the time, which at the end has no more files open than at the start, and has not grown by a mebibyte.
"""

import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

ARMJIG = sys.argv[1]
AT_ONCE = 4
MOMENTS = 0.4  # seconds from the start of the program
PATIENCE = 45  # seconds; who takes longer hangs. Cases wait 15 s for a server that may be started again
MOST_GROWTH = 1024  # KiB

STREAM = [["latency", "parol6", "--seconds", "100"], ["watch", "parol6", "--json"], ["console", "parol6"],
          ["console", "parol6", "--allow", "state,move"],
          ["conformance", "parol6", "--tier", "quick", "--allow", "state"]]
SERVER = [["latency", "kinovazed", "--allow", "state", "--seconds", "100"], ["watch", "kinovazed", "--json"],
          ["console", "kinovazed"]] * 3 + [["conformance", "kinovazed", "--tier", "quick", "--allow", "state"]]
BUS = [["latency", "morap", "--seconds", "100"], ["watch", "morap", "--json"],
       ["conformance", "morap", "--tier", "quick", "--allow", "state"]]
# Of each link: how its device is hosted, what talks to it, and whether it is a socket that can be reset.
LINKS = {
    "pty": (["parol6", "--link"], STREAM, False),
    "tcp": (["parol6", "--tcp"], STREAM, True),
    "rfc2217": (["parol6", "--rfc2217"], STREAM, True),
    "server": (["kinovazed", "--tcp"], SERVER, True),
    "virtual-i2c": (None, BUS, False),
}
SUMMARY = re.compile(r"(link|round trip|schedule|impaired) ")  # of a watch, which it has in any case
BUS_GONE = "ERROR: libumockdev-preload: Error communicating with ioctl socket"


class Emulator:
    """On a link, until it breaks. `place`: of the one before, to come back to."""

    def __init__(self, link, folder, place=None):
        device, _, _ = LINKS[link]
        self.place = place or (str(folder / "arm") if link == "pty" else "0")
        self.process = subprocess.Popen([ARMJIG, "emulate", *device, self.place], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self.process.stdout:
            self.target = line.split()[1]  # a stable link comes last
            if link != "pty" or self.place in self.target:
                break
        if link != "pty":
            self.place = self.target.rpartition(":")[2]

    def end(self, how):
        self.process.send_signal(how)
        self.process.wait()
        self.process.stdout.close()


class Relay:
    """Between a program and an emulator on TCP, to break their connections by resets."""

    def __init__(self, target):
        self.port = int(target.rpartition(":")[2])
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.target = f"{target.partition(':')[0]}:127.0.0.1:{self.listener.getsockname()[1]}"
        self.sockets = []
        self.is_broken = False
        self.guard = threading.Lock()
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        try:
            while True:
                client = self.listener.accept()[0]
                other = socket.create_connection(("127.0.0.1", self.port))
                with self.guard:
                    self.sockets += [client, other]
                    if self.is_broken:
                        self.break_all()
                        return
                for one, two in ((client, other), (other, client)):
                    one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    threading.Thread(target=self.pass_on, args=(one, two), daemon=True).start()
        except OSError:
            pass

    def pass_on(self, one, two):
        try:
            while some := one.recv(4096):
                two.sendall(some)
            two.shutdown(socket.SHUT_WR)
        except OSError:
            pass

    def reset(self):
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        with self.guard:  # one that is accepted at this moment is reset, too
            self.is_broken = True
            self.break_all()

    def break_all(self):
        for one in self.sockets:
            try:
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                one.shutdown(socket.SHUT_RD)  # wakes the thread that reads it, or it would stay open
                one.close()
            except OSError:
                pass


def marked(mark):
    """An environment by which a process and all that it has started are found."""
    return dict(os.environ, ARMJIG_SOAK_RUN=mark)


def those_left(mark):
    """Processes with that mark that have not ended; a supervisor is in a session of its own."""
    words = f"\0ARMJIG_SOAK_RUN={mark}\0".encode()
    left = []
    for environ in pathlib.Path("/proc").glob("[0-9]*/environ"):
        try:
            if words in b"\0" + environ.read_bytes() + b"\0":
                left.append(int(environ.parent.name))
        except OSError:
            pass
    return left


def is_any_left(mark, patience):
    """Whether there is one after that time. It is killed."""
    deadline = time.monotonic() + patience
    while left := those_left(mark):
        if time.monotonic() > deadline:
            for process in left:
                os.kill(process, signal.SIGKILL)
            return True
        time.sleep(0.02)
    return False


def tell(program, words):
    try:
        program.stdin.write(words)
        program.stdin.flush()
    except BrokenPipeError:
        pass


def faults_of(words, target, code, seconds, output, mark):
    """What is wrong with how a program has ended."""
    place = target.partition(":")[2]
    errors = output["err"].read_text().splitlines()
    lines = [line for line in errors if not SUMMARY.match(line)]
    verdicts = [line for line in output["out"].read_text().splitlines() if line.startswith("ERROR ")]
    if code != 3:
        yield f"exit code {code}"
    if seconds > PATIENCE:
        yield "it hangs"
    if words[0] == "conformance" and not lines:
        if not verdicts:
            yield "no case says that the target has gone"
    elif len(lines) != 1 or not lines[0].startswith("armjig: ") or place not in lines[0]:
        yield f"{len(lines)} lines, where one clear line should be"
    if is_any_left(mark, 2):
        yield "a process is left"


def wait_for(program):
    began = time.monotonic()
    try:
        return program.wait(PATIENCE), time.monotonic() - began
    except subprocess.TimeoutExpired:
        program.kill()
        program.wait()
        return None, PATIENCE + 1


def break_once(link, seed):
    """How a program has ended, and what is wrong with that."""
    chance = random.Random(seed)
    _, programs, has_sockets = LINKS[link]
    words = chance.choice(programs)
    how = chance.choice(["killed", "ended"] + ["reset"] * 2 * has_sockets)
    moment = chance.random() * MOMENTS
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        output = {name: folder / name for name in ("out", "err")}
        emulator = Emulator(link, folder)
        relay = Relay(emulator.target) if how == "reset" else None
        target = (relay or emulator).target
        with open(output["out"], "wb") as out, open(output["err"], "wb") as err:
            program = subprocess.Popen([ARMJIG, *words, "--target", target], stdin=subprocess.PIPE, stdout=out,
                                       stderr=err, env=marked(folder.name))
        if "state,move" in words:
            tell(program, b"enable\njog j1 300 30\n")
        time.sleep(moment)
        if relay:
            relay.reset()
        else:
            emulator.end(signal.SIGKILL if how == "killed" else signal.SIGTERM)
        code, seconds = wait_for(program)
        program.stdin.close()
        faults = list(faults_of(words, target, code, seconds, output, folder.name))
        if relay:
            emulator.end(signal.SIGTERM)
        if faults:
            print(f"{link}, seed {seed}: {' '.join(words)}, {how} after {moment:.3f} s: {'; '.join(faults)}\n"
                  + output["err"].read_text()[-1000:], flush=True)
        last = (output["err"].read_text().splitlines() or ["(in the verdicts)"])[-1]
        return link, bool(faults), seconds, re.sub(r"/\S*|" + re.escape(target), "TARGET", last)


def break_bus(link, seed):
    """The virtual bus is a library in the program, which ends it when the bus's host has gone."""
    chance = random.Random(seed)
    words = chance.choice(LINKS[link][1])
    moment = chance.random() * MOMENTS
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "nodes.toml").write_text("[[node]]\nid = 2\n")
        own = folder / "pid"
        with open(folder / "out", "wb") as out, open(folder / "err", "wb") as err:
            lab = subprocess.Popen(
                [ARMJIG, "lab", "exec", "--i2c", folder / "nodes.toml", "--", "sh", "-c",
                 f'echo $$ >"{own}.new" && mv "{own}.new" "{own}"; exec "$@"', "sh", ARMJIG, *words,
                 "--target", "i2c:/dev/i2c-1"],
                stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=marked(folder.name))
        while not own.exists():
            time.sleep(0.005)
        time.sleep(moment)
        lab.kill()
        lab.wait()
        began = time.monotonic()
        hangs = is_any_left(folder.name, PATIENCE)
        seconds = time.monotonic() - began
        lines = [line for line in (folder / "err").read_text().splitlines() if not SUMMARY.match(line)]
        faults = ["it hangs"] if hangs else []
        if len(lines) != 1:
            faults.append(f"{len(lines)} lines, where one clear line should be")
        if faults:
            print(f"{link}, seed {seed}: {' '.join(words)}, after {moment:.3f} s: {'; '.join(faults)}\n" +
                  "\n".join(lines), flush=True)
        last = lines[-1] if lines else ""
        return link, bool(faults), seconds, "(the library's)" if last.startswith(BUS_GONE) else last


def state_of(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return len(os.listdir(f"/proc/{process}/fd")), int(re.search(r"VmRSS:\s+(\d+)", status)[1])


def resume(link, count):
    """A watch that goes on each time its device is back. What is wrong, and how long it took at most."""
    chance = random.Random(count)
    device = LINKS[link][0][0]
    with tempfile.TemporaryDirectory() as folder:
        emulator = Emulator(link, pathlib.Path(folder))
        watch = subprocess.Popen([ARMJIG, "watch", device, "--target", emulator.target, "--reconnect", "--json"],
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        heard = collections.Counter()

        def listen():
            for line in watch.stdout:
                heard["lines"] += bool(json.loads(line))

        threading.Thread(target=listen, daemon=True).start()

        def wait_for_more():
            before, began = heard["lines"], time.monotonic()
            while heard["lines"] < before + 2 and time.monotonic() - began < PATIENCE:
                time.sleep(0.01)
            return time.monotonic() - began

        took = [wait_for_more()]
        begin = None
        for i in range(count):
            if i == min(10, count - 1):
                begin = state_of(watch.pid)
            time.sleep(chance.random() * MOMENTS)
            emulator.end(chance.choice([signal.SIGKILL, signal.SIGTERM]))
            emulator = Emulator(link, pathlib.Path(folder), emulator.place)
            took.append(wait_for_more())
            if took[-1] >= PATIENCE or watch.poll() is not None:
                return f"it does not go on after unplug {i}, exit code {watch.poll()}", took[-1]
        end = state_of(watch.pid)
        watch.send_signal(signal.SIGTERM)
        code = watch.wait(PATIENCE)
        emulator.end(signal.SIGTERM)
        fault = f"exit code {code}; " if code != 0 else ""
        fault += f"files {begin[0]} and then {end[0]}; " if end[0] > begin[0] else ""
        fault += f"memory grew by {end[1] - begin[1]} KiB" if end[1] - begin[1] > MOST_GROWTH else ""
        return fault, max(took)


def soak(link, count, first):
    began = time.monotonic()
    once = break_bus if link == "virtual-i2c" else break_once
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE * (1 + (link == "server"))) as pool:
        resumed = pool.submit(resume, link, count // 10) if link != "virtual-i2c" else None
        results = list(pool.map(lambda seed: once(link, seed), range(first, first + count)))
        fault, longest = resumed.result() if resumed else ("", 0)
    bad = sum(result[1] for result in results)
    print(f"{link}: {count} unplugs, {bad} not as they should be, the slowest end after {max(r[2] for r in results):.2f} s"
          f", {time.monotonic() - began:.0f} s in all")
    for line, times in collections.Counter(result[3] for result in results).most_common():
        print(f"  {times:5}  {line}")
    if resumed:
        print(f"  a watch went on {count // 10} times, within {longest:.2f} s" + (f": {fault}" if fault else ""))
    sys.stdout.flush()
    return bad == 0 and not fault


def main():
    links = [sys.argv[2]] if len(sys.argv) > 2 else list(LINKS)
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    return 0 if all([soak(link, count, first) for link in links]) else 1


sys.exit(main())
