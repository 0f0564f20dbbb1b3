# SPDX-License-Identifier: Apache-2.0
"""Lines on standard input reach a hosted device; one without standard input works all the same.

    /usr/bin/python3 device_inputs_test.py build/release/cli/armjig
"""
import json
import os
import signal
import socket
import subprocess
import sys


class Hosted:
    def __init__(self, armjig, device, stdin, before=None):
        self.process = subprocess.Popen(
            [armjig, "emulate", device, "--tcp", "0", "--speed", "10", "--json"],
            stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            close_fds=before is None, preexec_fn=before)
        place = json.loads(self.process.stdout.readline())["listening"][0]
        host, port = place.removeprefix("tcp:").split(":")
        self.socket = socket.create_connection((host, int(port)), timeout=30)
        self.lines = self.socket.makefile("rb")

    def tell(self, line):
        """Writes a line and returns what the emulator has to say about it."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stderr.readline().strip().removeprefix("armjig: ")

    def say(self, line, answer):
        self.socket.sendall((line + "\r\n").encode())
        self.hear(answer)

    def hear(self, answer):
        while True:
            line = self.lines.readline().decode()
            assert line, "the server is gone"
            if line.strip() == answer:
                return

    def end(self):
        self.socket.close()
        self.process.send_signal(signal.SIGTERM)
        errors = self.process.communicate(timeout=30)[1]
        assert self.process.returncode == 0, self.process.returncode
        return errors


def check_server(armjig):
    server = Hosted(armjig, "kinovazed", subprocess.PIPE)
    server.say("QuitEStop", "Accepted")
    server.say("Initialize", "Initialized")
    server.hear("Heartbeat:21")
    assert "NAME NUMBER" in server.tell("arm.fail.status_read"), "a number is missing"
    assert "NAME NUMBER" in server.tell("arm.fail.status_read 1 2")
    assert "no input 'arm.foot' here that takes 1" in server.tell("arm.foot 1")
    assert "restart" in server.tell("help")
    for _ in range(18):
        server.process.stderr.readline()
    assert server.tell("arm.joystick.z -500") == "arm.joystick.z is -500"
    assert server.tell("# nobody answers this\n\n  arm.fail.status_read 1\r") == \
        "arm.fail.status_read is 1"
    server.hear("Heartbeat:3")  # which is how an error of the arm shows
    server.process.stdin.close()
    server.process.stdin = None
    server.say("QuitEStop", "Accepted")  # the end of input ends nothing else
    server.end()


IDLE = bytes.fromhex("ff ff ff 34") + bytes(36) + bytes([255, 255]) + bytes(11) + b"\xe4\x01\x02"
ESTOP_RELEASED = 0x08


def is_estop_pressed(board):
    board.socket.sendall(IDLE)
    frame = board.lines.read(60)
    assert frame[:4] == bytes.fromhex("ff ff ff 38"), frame.hex(" ")
    return not frame[41] & ESTOP_RELEASED


def check_board(armjig):
    board = Hosted(armjig, "parol6", subprocess.PIPE)
    assert not is_estop_pressed(board)
    assert board.tell("estop 0") == "estop is 0"
    assert is_estop_pressed(board)
    assert "no input 'switch.j1' here that takes 9" in board.tell("switch.j1 9")
    assert board.tell("estop 1") == "estop is 1"
    assert not is_estop_pressed(board)
    board.end()


def check_without(armjig):
    server = Hosted(armjig, "kinovazed", subprocess.DEVNULL)
    server.say("EStop", "Accepted")
    server.end()
    server = Hosted(armjig, "kinovazed", None, before=lambda: os.close(0))
    server.say("EStop", "Accepted")
    assert server.end().startswith("armjig: 1 clients served")


check_server(sys.argv[1])
check_board(sys.argv[1])
check_without(sys.argv[1])
print("ok")
