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
import time
import tty


def idle(gripper_id):
    frame = bytearray(56)
    frame[:4] = b"\xff\xff\xff\x34"
    frame[40] = 255
    frame[52] = gripper_id
    frame[53:] = b"\xe4\x01\x02"
    return bytes(frame)


def talk(path, gripper_id, seconds=1.0):
    port = os.open(path, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port)
    end = time.monotonic() + seconds
    due = time.monotonic()
    while due < end:
        os.write(port, idle(gripper_id))
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
    check_kinovazed(armjig)
    print("ok")


main(sys.argv[1])
