# SPDX-License-Identifier: Apache-2.0
"""Labs of several devices: `armjig lab up` serves a PAROL6 board, a KinovaZED server and a MORAP bus
to our own conformance and console and to other programs, one after the other; `armjig lab exec`
shows them to a program with nothing of ours, which finds the board by its USB numbers.

    /usr/bin/python3 lab_test.py build/release/cli/armjig EXAMPLE.toml
"""
import contextlib
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import jsonschema

ARMJIG = sys.argv[1]
EXAMPLE = sys.argv[2]
PYTHON = "/usr/bin/python3"  # Debian's own, which has python3-serial
LAB = """
[[device]]
name = "left"
device = "parol6"
pty = "{folder}/left"
tcp = 0
ttyACM = 0
usb_serial = "L7"
capture = "{folder}/left.jsonl"

[[device]]
device = "kinovazed"
tcp = 0
impair = "delay=2ms"

[[device]]
name = "fingers"
device = "morap"
target = "emulated:?nodes=2,3&pen=yes"
"""
# Asks twice for telemetry, sets the lines and speeds that serial programs set.
FIND_AND_TALK = """
import serial, serial.tools.list_ports
ports = [p for p in serial.tools.list_ports.comports() if (p.vid, p.pid) == (0x0483, 0x5740)]
for p in ports:
    print(p.device, p.serial_number, p.manufacturer, p.product)
frame = bytes([255, 255, 255, 52]) + bytes(36) + bytes([255, 255, 0, 0]) + bytes(9) + bytes([0xE4, 1, 2])
with serial.Serial(ports[0].device, 3_000_000, timeout=10) as port:
    print("lines", port.cts, port.dsr, port.cd, port.ri)
    port.dtr = False
    port.rts = False
    port.dtr = True
    for speed in (250_000, 3_000_000):  # the first has no name in termios
        port.baudrate = speed
        port.write(frame)
        answer = port.read(60)
        assert answer[:4] == bytes([255, 255, 255, 56]), answer
        assert answer[47] == 255, answer[47]
print("answered")
"""


def armjig(*words, environment=(), **how):
    done = subprocess.run([ARMJIG, *words], capture_output=True, text=True, timeout=120,
                          env={**os.environ, **dict(environment)}, **how)
    return done.returncode, done.stdout, done.stderr


class Up:
    """`armjig lab up`, and where everything is."""

    def __init__(self, lab, stdin=subprocess.DEVNULL):
        self.process = subprocess.Popen([ARMJIG, "lab", "up", str(lab), "--json"], text=True,
                                        stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.line = json.loads(self.process.stdout.readline())
        self.places = {device["name"]: device["listening"] for device in self.line["devices"]}
        self.environment = dict(each.split("=", 1) for each in self.line.get("environment", []))

    def place(self, name, scheme):
        return next(place for place in self.places[name] if place.startswith(scheme + ":"))

    def run(self, *program):
        """A program in the environment of the lab."""
        path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
        return subprocess.run(program, capture_output=True, text=True, timeout=60,
                              env={**os.environ, "PATH": path, **self.environment})

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        out, err = self.process.communicate(timeout=60)
        return self.process.returncode, out, err


@contextlib.contextmanager
def up(lab, **how):
    running = Up(lab, **how)
    try:
        yield running
    finally:
        if running.process.poll() is None:
            running.end()


class Lab(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def lab(self, text=LAB):
        path = self.folder / "lab.toml"
        path.write_text(text.format(folder=self.folder))
        return path

    def test_one_lab_has_a_board_a_server_and_a_bus_for_our_own_programs(self):
        with up(self.lab()) as lab:
            schema = pathlib.Path(EXAMPLE).parents[2] / "docs/schemas/lab.schema.json"
            jsonschema.validate(lab.line, json.loads(schema.read_text()))
            self.assertEqual(list(lab.places), ["left", "kinovazed", "fingers"])
            self.assertIn(f"pty:{self.folder}/left", lab.places["left"])
            self.assertEqual(lab.place("left", "serial"), "serial:/dev/ttyACM0")
            self.assertEqual(lab.place("fingers", "i2c"), "i2c:/dev/i2c-1")
            for device, name, scheme, topic in (("parol6", "left", "pty", "parol6.frame.one-answer"),
                                                ("parol6", "left", "tcp", "parol6.frame.one-answer"),
                                                ("kinovazed", "kinovazed", "tcp", "kinovazed.line.case"),
                                                ("morap", "fingers", "i2c", "morap.read.")):
                code, out, err = armjig("conformance", device, "--target", lab.place(name, scheme),
                                        "--tier", "quick", "--allow", "all", "--filter", topic,
                                        environment=lab.environment)
                self.assertEqual(code, 0, (device, scheme, out[-2000:], err))
                self.assertRegex(out, r"[1-9]\d* passed, 0 failed")
            code, out, err = armjig("console", "morap", "--target", "i2c:/dev/i2c-1", "--allow", "all",
                                    environment=lab.environment, input="calibrate\nstatus\n")
            self.assertEqual(code, 0, (out, err))
            code, _, err = lab.end()
            self.assertEqual(code, 0, err)
            self.assertRegex(err, r"left: [1-9]\d* clients served")
            self.assertFalse((self.folder / "left").is_symlink(), "the name goes with the lab")
        code, out, _ = armjig("trace", "info", str(self.folder / "left.jsonl"))
        self.assertEqual(code, 0)
        self.assertIn("parol6", out)

    def test_programs_one_after_the_other_find_a_bus_that_lives_on(self):
        with up(self.lab()) as lab:
            found = lab.run("i2cdetect", "-y", "1")
            self.assertIn("10: -- -- 12 13 -- -- -- -- -- 19", found.stdout, found.stderr)
            # Chooses what the next read gives, and ends; the next program reads it.
            self.assertEqual(lab.run("i2ctransfer", "-y", "1", "w1@0x13", "0x88").returncode, 0)
            self.assertEqual(lab.run("i2ctransfer", "-y", "1", "r1@0x13").stdout.split(), ["0x13"])
            # Two programs at once.
            holder = subprocess.Popen(
                [PYTHON, "-c", "import os; os.open('/dev/i2c-1', os.O_RDWR); print(1, flush=True); input()"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                env={**os.environ, **lab.environment})
            self.assertEqual(holder.stdout.readline(), "1\n")
            self.assertEqual(lab.run("i2ctransfer", "-y", "1", "r1@0x13").stdout.split(), ["0x13"])
            holder.communicate("\n", timeout=30)
            self.assertEqual(holder.returncode, 0)
            # And a serial program in the same environment.
            talked = lab.run(PYTHON, "-c", FIND_AND_TALK)
            self.assertIn("/dev/ttyACM0 L7", talked.stdout, talked.stderr)
            self.assertIn("answered", talked.stdout)

    def test_an_unmodified_program_finds_the_board_by_its_usb_numbers(self):
        code, out, err = armjig("lab", "exec", str(self.lab()), "--", PYTHON, "-c", FIND_AND_TALK)
        self.assertEqual(code, 0, err)
        self.assertEqual(out.splitlines(), ["/dev/ttyACM0 L7 armjig PAROL6 control board",
                                            "lines True True True False", "answered"])

    def test_libserialport_finds_the_board_by_its_usb_numbers(self):
        code, out, err = armjig("lab", "exec", str(self.lab()), "--", ARMJIG, "conformance", "parol6",
                                "--target", "serial:0483:5740:L7", "--filter", "parol6.frame.one-answer")
        self.assertEqual(code, 0, err)
        self.assertIn("1 passed, 0 failed", out)

    def test_two_boards_of_a_kind_are_told_apart(self):
        lab = self.lab("[[device]]\ndevice = 'parol6'\nname = 'a'\n"
                       "[[device]]\ndevice = 'parol6'\nname = 'b'\n")
        code, out, err = armjig("lab", "exec", str(lab), "--", ARMJIG, "devices")
        self.assertEqual(code, 0, err)
        self.assertRegex(out, r"ttyACM0 .*a-emulated[\s\S]*ttyACM1 .*b-emulated")

    def test_the_exit_code_is_that_of_the_program(self):
        lab = self.lab()
        for program, wanted in (("exit 42", 42), ("kill -TERM $$", 128 + 15), ("true", 0)):
            self.assertEqual(armjig("lab", "exec", str(lab), "--", "sh", "-c", program)[0], wanted)

    def test_a_program_of_the_lab_finds_the_server_on_loopback(self):
        lab = self.lab("[[device]]\ndevice = 'kinovazed'\ntcp = {}\n".replace("{}", str(free_port())))
        port = int(re.search(r"\d{4,}", lab.read_text())[0])
        code, out, err = armjig("lab", "exec", str(lab), "--", PYTHON, "-c",
                                "import socket; s = socket.create_connection(('127.0.0.1', "
                                f"{port}), 30); print(s.recv(3))")
        self.assertEqual((code, err), (0, ""))
        self.assertTrue(out.startswith("b'"), out)

    def test_inputs_begin_with_the_name_of_their_device(self):
        with up(self.lab(), stdin=subprocess.PIPE) as lab:
            def tell(line):
                lab.process.stdin.write(line + "\n")
                lab.process.stdin.flush()
                return lab.process.stderr.readline().strip().removeprefix("armjig: ")
            self.assertEqual(tell("left.estop 0"), "left.estop is 0")
            self.assertIn("no input 'estop'", tell("estop 0"))
            self.assertIn("no input 'right.estop'", tell("right.estop 0"))
            self.assertIn("no input 'kinovazed.estop'", tell("kinovazed.estop 0"))
            code, out, err = armjig("conformance", "parol6", "--target", lab.place("left", "pty"),
                                    "--filter", "parol6.estop", "--tier", "quick")
            self.assertNotIn("internal error", err)

    def test_programs_are_judged_by_device(self):
        lab = self.lab("[[device]]\ndevice = 'morap'\nname = 'a'\ncheck = true\n"
                       "[[device]]\ndevice = 'morap'\nname = 'b'\ncheck = true\n")
        bad = "i2ctransfer -y 2 w5@0x12 0x01 0x00 0x00 0x00 0x00"  # drives and never calibrated
        code, _, err = armjig("lab", "exec", str(lab), "--", "sh", "-c", bad,
                              environment={"PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"})
        self.assertEqual(code, 1, err)
        self.assertRegex(err, r"armjig: b: [0-9.]+ s morap\.host\.calibrates-first")
        self.assertNotRegex(err, r"armjig: a: [0-9.]+ s morap\.host")
        code, _, err = armjig("lab", "exec", str(lab), "--", "sh", "-c", bad + "; exit 7",
                              environment={"PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"})
        self.assertEqual(code, 7, "a program that fails says it itself")
        code, _, err = armjig("lab", "exec", str(lab), "--", "true")
        self.assertEqual(code, 4, "nobody was told anything")
        with up(lab) as running:
            self.assertEqual(running.run("i2ctransfer", "-y", "1", "w1@0x12", "0x88").returncode, 0)
            code, out, _ = running.end()
            self.assertEqual((code, out.count('"armjig.report/1"')), (0, 2), out)

    def test_impairments_are_between_the_device_and_its_programs(self):
        lab = self.lab("[[device]]\ndevice = 'parol6'\npty = ''\nimpair = 'in.loss=100%'\n"
                       "[[device]]\ndevice = 'morap'\nimpair = 'out.loss=100%'\n")
        with up(lab) as running:
            code, out, err = armjig("conformance", "parol6", "--target", running.place("parol6", "pty"),
                                    "--filter", "parol6.frame.one-answer")
            self.assertIn(code, (1, 3), (out, err))
            self.assertNotIn("0x12", running.run("i2cdetect", "-y", "1").stdout)
            code, _, err = armjig("i2c", "scan", "--target", "i2c:/dev/i2c-1",
                                  environment=running.environment)
            self.assertEqual(code, 4, err)

    def test_a_device_that_is_not_emulated_is_served_and_its_end_is_told(self):
        board = subprocess.Popen([ARMJIG, "emulate", "parol6", "--tcp", "0", "--json"], text=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.DEVNULL)
        place = json.loads(board.stdout.readline())["listening"][0]
        lab = self.lab(f"[[device]]\ndevice = 'parol6'\nname = 'real'\ntarget = '{place}'\n"
                       "capture = '{folder}/real.jsonl'\n[[device]]\ndevice = 'demo'\ntcp = 0\n")
        with up(lab) as running:
            talked = running.run(PYTHON, "-c", FIND_AND_TALK)
            self.assertIn("answered", talked.stdout, talked.stderr)
            board.send_signal(signal.SIGTERM)
            board.communicate(timeout=30)
            host, port = running.place("demo", "tcp").removeprefix("tcp:").split(":")
            socket.create_connection((host, int(port)), timeout=30).close()  # the others live on
            code, _, err = running.end()
        self.assertEqual(code, 3, err)
        self.assertIn("real: tcp:", err)
        self.assertIn("the device has gone", err)
        self.assertGreater((self.folder / "real.jsonl").stat().st_size, 500)

    def test_a_place_that_somebody_else_has_is_named(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            lab = self.lab("[[device]]\ndevice = 'demo'\npty = ''\n"
                           f"[[device]]\ndevice = 'kinovazed'\nname = 'arm'\ntcp = {port}\n")
            for words in (("up", str(lab)), ("exec", str(lab), "--", "true")):
                code, out, err = armjig("lab", *words)
                self.assertEqual((code, out, len(err.splitlines())), (3, "", 1), err)
                self.assertIn("arm: ", err)
                self.assertIn(str(port), err)

    def test_the_example_of_the_guide_works(self):
        with up(EXAMPLE) as lab:
            self.assertEqual(list(lab.places), ["left", "right", "jaco", "fingers"])
            self.assertEqual(lab.place("right", "serial"), "serial:/dev/ttyACM1")
            self.assertEqual(lab.end()[0], 4, "one is checked, and nobody talked to it")


def free_port():
    """One that is free now. Nothing else here listens on a port that was not given to it."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
