# SPDX-License-Identifier: Apache-2.0
"""The document's how-to "Change Objectives", by a person at a telnet client: choose an objective,
drive to where its way-point shall be, ask for the position, paste the line of the log into the
file, start the server again.

    /usr/bin/python3 change_objectives_test.py build/release/cli/armjig
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SPEED = 10
REACHED = 0.06  # m; the server stops the arm within 0.05 of a way-point
AXES = ("X", "Y", "Z", "pitch", "yaw", "roll")
AT_FIRST = dict(zip(AXES, (0.05, -0.33, 0.47, 1.7, -0.14, -0.11)))


class Server:
    """The server and the telnet client of its user."""

    def __init__(self, armjig, objectives):
        self.process = subprocess.Popen(
            [armjig, "emulate", "kinovazed", "--tcp", "0", "--speed", str(SPEED), "--json",
             "--set", f"objectives={objectives}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        host, port = json.loads(self.process.stdout.readline())["listening"][0].split(":")[1:]
        self.telnet = subprocess.Popen(["telnet", host, port], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.hear("Escape character is '^]'.")

    def type(self, line, *answers):
        self.telnet.stdin.write(line + "\n")
        self.telnet.stdin.flush()
        for answer in answers:
            self.hear(answer)

    def hear(self, answer):
        """Until that line comes; only telnet's greeting and heartbeats may come before it."""
        while (line := self.telnet.stdout.readline().strip()) != answer:
            expected = line.startswith(("Heartbeat:", "Trying", "Connected"))
            assert expected, f"'{line}' instead of '{answer}'"

    def ask_position(self, command, frame):
        """The server writes it to its log, not to the client."""
        self.type(command)
        while line := self.process.stderr.readline():
            if found := re.search(rf"position \({frame}\): (\{{[^}}]*\}})", line):
                return json.loads(found[1])
        raise AssertionError(f"the log ended before it answered {command}")

    def end(self):
        self.process.terminate()
        log = self.process.communicate(timeout=30)[1]
        assert self.process.returncode == 0, log
        self.telnet.communicate(timeout=30)


def save(path, point):
    zero = dict.fromkeys(AXES, 0)
    path.write_text(json.dumps(
        [{"name": "Home", "is_abs": True, "origin": zero, "sequence": [point]}]))


def assert_near(one, other, axes, most):
    for axis in axes:
        assert abs(one[axis] - other[axis]) < most, (axis, one, other)


def main(armjig):
    with tempfile.TemporaryDirectory() as folder:
        objectives = pathlib.Path(folder) / "objectives.json"
        save(objectives, AT_FIRST)

        server = Server(armjig, objectives)
        server.type("QuitEStop", "Accepted")
        server.type("Initialize", "Accepted", "Initialized")
        server.type("SetActiveObjective:Home")
        server.type("SetJoystickMode:XYZ", "Accepted", "JoystickModeSet")
        server.type("MoveJoystick:0:-400:0", "Accepted")
        # As far as it takes for the end to tell the new way-point from the old one.
        while server.ask_position("GetAbsolutePosition", "abs")["Y"] < AT_FIRST["Y"] + 3 * REACHED:
            pass
        server.type("MoveJoystick:0:0:0", "Accepted")
        taught = server.ask_position("GetObjectivePosition", "obj")
        assert set(taught) == set(AXES), taught
        # Home's frame is the arm's, which may still have moved a little between the two lines.
        assert_near(taught, server.ask_position("GetAbsolutePosition", "abs"), AXES, 0.02)
        server.type("EStop", "Accepted")
        server.end()

        save(objectives, taught)
        server = Server(armjig, objectives)
        server.type("QuitEStop", "Accepted")
        server.type("Initialize", "Accepted", "Initialized")
        server.type("RunObjective:Home", "Accepted", "ObjectiveDone")
        reached = server.ask_position("GetAbsolutePosition", "abs")
        server.type("EStop", "Accepted")
        server.end()
        assert_near(reached, taught, AXES[:3], REACHED)
        print("the edited objective is reached")


if __name__ == "__main__":
    main(sys.argv[1])
