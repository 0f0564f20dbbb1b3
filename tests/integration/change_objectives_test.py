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

    def hear_beat(self):
        line = self.telnet.stdout.readline()
        assert line.startswith("Heartbeat:"), f"'{line}' instead of a heartbeat"

    def end(self):
        """The server's log."""
        self.process.terminate()
        log = self.process.communicate(timeout=30)[1]
        assert self.process.returncode == 0, log
        self.telnet.communicate(timeout=30)
        return log


def save(path, point):
    zero = dict.fromkeys(AXES, 0)
    path.write_text(json.dumps(
        [{"name": "Home", "is_abs": True, "origin": zero, "sequence": [point]}]))


def logged_pose(log, frame):
    found = re.search(rf"position \({frame}\): (\{{[^}}]*\}})", log)
    assert found, log
    return json.loads(found[1])


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
        server.hear_beat()
        server.type("MoveJoystick:0:0:0", "Accepted")
        server.type("GetObjectivePosition")
        server.type("GetAbsolutePosition")
        server.type("EStop", "Accepted")
        log = server.end()
        taught = logged_pose(log, "obj")
        assert set(taught) == set(AXES), taught
        # Home's frame is the arm's, which may still have moved a little between the two lines.
        assert_near(taught, logged_pose(log, "abs"), AXES, 0.02)
        assert abs(taught["Y"] - AT_FIRST["Y"]) > 2 * REACHED, taught  # or the end would tell nothing

        save(objectives, taught)
        server = Server(armjig, objectives)
        server.type("QuitEStop", "Accepted")
        server.type("Initialize", "Accepted", "Initialized")
        server.type("RunObjective:Home", "Accepted", "ObjectiveDone")
        server.type("GetAbsolutePosition")
        server.type("EStop", "Accepted")
        reached = logged_pose(server.end(), "abs")
        assert_near(reached, taught, AXES[:3], REACHED)
        print("the edited objective is reached")


if __name__ == "__main__":
    main(sys.argv[1])
