# SPDX-License-Identifier: Apache-2.0
"""Lines on standard input reach a hosted server; a server without standard input works all the same.

    /usr/bin/python3 server_inputs_test.py build/release/cli/armjig
"""
import json
import os
import signal
import socket
import subprocess
import sys


class Server:
    def __init__(self, armjig, stdin, before=None):
        self.process = subprocess.Popen(
            [armjig, "emulate", "kinovazed", "--tcp", "0", "--speed", "10", "--json"],
            stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            close_fds=before is None, preexec_fn=before)
        place = json.loads(self.process.stdout.readline())["listening"][0]
        host, port = place.removeprefix("tcp:").split(":")
        self.socket = socket.create_connection((host, int(port)), timeout=30)
        self.lines = self.socket.makefile("rb")

    def tell(self, line):
        """Writes a line and returns what the server has to say about it."""
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


def check_lines(armjig):
    server = Server(armjig, subprocess.PIPE)
    server.say("QuitEStop", "Accepted")
    server.say("Initialize", "Initialized")
    server.hear("Heartbeat:21")
    assert "NAME NUMBER" in server.tell("arm.fail.status_read"), "a number is missing"
    assert "NAME NUMBER" in server.tell("arm.fail.status_read 1 2")
    assert "no input 'arm.foot'" in server.tell("arm.foot 1")
    assert "restart" in server.tell("help")
    for _ in range(11):
        server.process.stderr.readline()
    assert server.tell("arm.joystick.z -500") == "arm.joystick.z is -500"
    assert server.tell("# nobody answers this\n\n  arm.fail.status_read 1\r") == \
        "arm.fail.status_read is 1"
    server.hear("Heartbeat:3")  # which is how an error of the arm shows
    server.process.stdin.close()
    server.process.stdin = None
    server.say("QuitEStop", "Accepted")  # the end of input ends nothing else
    server.end()


def check_without(armjig):
    server = Server(armjig, subprocess.DEVNULL)
    server.say("EStop", "Accepted")
    server.end()
    server = Server(armjig, None, before=lambda: os.close(0))
    server.say("EStop", "Accepted")
    assert server.end().startswith("armjig: 1 clients served")


check_lines(sys.argv[1])
check_without(sys.argv[1])
print("ok")
