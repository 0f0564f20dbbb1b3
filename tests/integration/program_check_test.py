# SPDX-License-Identifier: Apache-2.0
"""`armjig emulate --check` judges clients with nothing of ours, one that is good and one that is not:
of a PAROL6 at a good rhythm, and with a gripper that does not exist; of a KinovaZED server one that
waits its turn, and one that writes as it likes and leaves in the middle of a motion.

    /usr/bin/python3 program_check_test.py build/release/cli/armjig
"""
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
import tty


IDLE, JOG = 255, 123
ANSWER_SIZE = 60


def frame(gripper_id, command=IDLE, speed_j1=0):
    bytes_of = bytearray(56)
    bytes_of[:4] = b"\xff\xff\xff\x34"
    bytes_of[22:25] = speed_j1.to_bytes(3, "big", signed=True)
    bytes_of[40] = command
    bytes_of[52] = gripper_id
    bytes_of[53:] = b"\xe4\x01\x02"
    return bytes(bytes_of)


def talk(path, gripper_id, seconds=1.0):
    port = os.open(path, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port)
    end = time.monotonic() + seconds
    due = time.monotonic()
    while due < end:
        os.write(port, frame(gripper_id))
        due += 0.01
        time.sleep(max(0.0, due - time.monotonic()))
        while select.select([port], [], [], 0)[0]:
            os.read(port, 4096)
    os.close(port)


class KinovaClient:
    def __init__(self, place):
        host, port = place.removeprefix("tcp:").split(":")
        self.socket = socket.create_connection((host, int(port)), timeout=30)
        self.lines = self.socket.makefile("rb")

    def hear(self, word):
        while not self.lines.readline().decode().startswith(word):
            pass

    def say(self, line, answer, end="\r\n"):
        self.socket.sendall((line + end).encode())
        self.hear(answer)

    def start(self):
        self.hear("Heartbeat")
        self.say("EStop", "Accepted")
        self.say("QuitEStop", "Accepted")
        self.say("Initialize", "Initialized")
        self.say("SetJoystickMode:XYZ", "JoystickModeSet")

    def leave(self):
        self.lines.close()
        self.socket.close()


def be_good(place):
    for _ in range(2):
        client = KinovaClient(place)
        client.start()
        client.say("MoveJoystick:10:-20:0", "Accepted")
        client.say("MoveJoystick:0:0:0", "Accepted")
        client.say("RunObjective:Home", "ObjectiveDone")
        client.leave()


def be_bad(place):
    client = KinovaClient(place)
    client.start()
    time.sleep(0.1)  # it may have been said before the program saw that the mode is set
    client.say("MoveJoystick:100:0:0", "Accepted", end="\n")
    client.say("Retract", "Rejected")
    client.socket.sendall(b"MoveJoystick:0:0")
    client.leave()


def check(armjig, device, client):
    """Exit code, report and standard error of a session."""
    emulator = subprocess.Popen([armjig, "emulate", *device, "--check", "--json"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    client(json.loads(emulator.stdout.readline())["listening"][0])
    time.sleep(0.3)
    emulator.send_signal(signal.SIGINT)
    out, err = emulator.communicate(timeout=30)
    return emulator.returncode, json.loads(out), err


def failures(report):
    return {row["name"] for row in report["rows"] if row["verdict"] == "fail"}


def check_parol6(armjig):
    code, report, err = check(armjig, ["parol6"],
                              lambda place: talk(place.removeprefix("pty:"), gripper_id=20))
    failed = failures(report)
    # On a machine that has no time for the client its rhythm is bad too.
    assert "parol6.host.gripper-id" in failed, failed
    assert code == 1, code
    assert "parol6.host.gripper-id: gripper.id was 20" in err, err

    code, report, err = check(armjig, ["parol6"],
                              lambda place: talk(place.removeprefix("pty:"), gripper_id=0))
    failed = failures(report)
    assert failed <= {"parol6.host.rate-slow", "parol6.host.jitter"}, failed
    assert code == (1 if failed else 0), code


def check_stopped_emulator(armjig):
    """A program that waits for each answer, while the emulator is stopped for a while."""
    emulator = subprocess.Popen([armjig, "emulate", "parol6", "--check", "--json"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    port = os.open(json.loads(emulator.stdout.readline())["listening"][0].removeprefix("pty:"),
                   os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port)

    answered = time.monotonic()
    own_pauses = []

    def ask(command, speed=0):
        nonlocal answered
        own_pauses.append(time.monotonic() - answered)
        os.write(port, frame(0, command, speed))
        left = ANSWER_SIZE
        while left > 0:
            left -= len(os.read(port, left))
        answered = time.monotonic()
        time.sleep(0.01)

    for _ in range(20):
        ask(IDLE)
    for i in range(60):
        ask(JOG, 500)
        if i == 30:
            threading.Thread(target=stop_for, args=(emulator, 0.6)).start()
            time.sleep(0.1)
            answered = time.monotonic()
    for _ in range(20):
        ask(IDLE)
    os.close(port)
    emulator.send_signal(signal.SIGINT)
    out, err = emulator.communicate(timeout=30)
    report = json.loads(out)
    musts = {name for name in failures(report) if level_of(report, name) == "must"}
    assert not musts or max(own_pauses) > 0.05, err  # this program may have had no time itself
    assert float(report["facts"]["overlooked"].split()[0]) >= 0.5, report["facts"]
    rows = {row["name"]: row for row in report["rows"]}
    gap = rows["parol6.host.gap-in-motion"]
    assert gap["verdict"] in ("inconclusive", "pass"), gap
    assert rows["parol6.host.go-to-range"]["verdict"] == "skipped", rows
    assert rows["parol6.host.jog-pace"]["verdict"] == "pass", rows


def stop_for(process, seconds):
    process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    process.send_signal(signal.SIGCONT)


def level_of(report, name):
    return next(row["level"] for row in report["rows"] if row["name"] == name)


def check_our_own(armjig):
    """What our programs do is good, when they open a port as when they use it."""
    console = "printf 'status\nwait 0.5\nquit\n' |"
    for program in [f"{armjig} watch parol6 --seconds 1.5 --target",
                    f"{console} {armjig} console parol6 --target"]:
        code, report, err = check(
            armjig, ["parol6"],
            lambda place: subprocess.run(f"{program} {place}", shell=True, check=True, timeout=60,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        failed = failures(report)
        assert failed <= {"parol6.host.rate-slow", "parol6.host.jitter"}, (failed, err)


def check_kinovazed(armjig):
    server = ["kinovazed", "--tcp", "0", "--speed", "5"]
    for profile in ["firmware", "documented"]:
        device = server + ["--set", "profile=" + profile]
        code, report, err = check(armjig, device, be_good)
        assert failures(report) == set() and code == 0, (failures(report), err)

        code, report, err = check(armjig, device, be_bad)
        assert failures(report) == {"kinovazed.host.line-end", "kinovazed.host.steering-exit",
                                    "kinovazed.host.line-finished",
                                    "kinovazed.host.leaves-stick"}, (failures(report), err)
        assert code == 1, code
        assert "line-finished: 'MoveJoystick:0:0' has no end" in err, err


def main(armjig):
    check_parol6(armjig)
    check_stopped_emulator(armjig)
    check_our_own(armjig)
    check_kinovazed(armjig)
    print("ok")


main(sys.argv[1])
