#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig record` between clients with nothing of ours and a device: every byte passes, both ways,
and is in the file: record_test.py ARMJIG
"""

import json
import os
import pathlib
import random
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
import tty
import unittest

ARMJIG = sys.argv[1]
PATIENCE = 60
IDLE = b"\xff\xff\xff\x34" + bytes(36) + b"\xff" + bytes(12) + b"\xe4\x01\x02"
ANSWER_SIZE = 60
NO_GRIPPER = 200  # an identifier that none can have


class Record(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out.pcapng"

    def start(self, *words):
        """A program that says as JSON where it listens; the process, and what it said."""
        process = subprocess.Popen([ARMJIG, *map(str, words), "--json"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        line = process.stdout.readline()
        self.assertTrue(line, process.stderr.read() if not line else "")
        return process, json.loads(line)

    def tap(self, device, listen, target, *more):
        return self.start("record", device, "--listen", listen, "--target", target, "--out",
                          self.out, *more)

    def end(self, process, code=0, number=signal.SIGINT):
        process.send_signal(number)
        out, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, code, errors)
        return out, errors

    def recorded(self):
        text = self.folder / "out.jsonl"
        done = subprocess.run([ARMJIG, "trace", "convert", self.out, text], capture_output=True,
                              text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [json.loads(line) for line in text.read_text().splitlines()]

    @staticmethod
    def bytes_of(lines, direction):
        return b"".join(bytes.fromhex(line["hex"]) for line in lines
                        if line.get("dir") == direction)

    @staticmethod
    def open_terminal(place):
        port = os.open(place.removeprefix("pty:"), os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port)
        return port

    def read(self, port, size):
        data = b""
        while len(data) < size:
            self.assertTrue(select.select([port], [], [], PATIENCE)[0], data)
            data += os.read(port, size - len(data))
        return data

    def connect(self, place):
        host, port = place.removeprefix("tcp:").rsplit(":", 1)
        client = socket.create_connection((host, int(port)), timeout=PATIENCE)
        self.addCleanup(client.close)
        return client

    def listen(self):
        """A server of ours, in place of a device, and the target."""
        server = socket.create_server(("127.0.0.1", 0))
        server.settimeout(PATIENCE)
        self.addCleanup(server.close)
        return server, f"tcp:127.0.0.1:{server.getsockname()[1]}"

    def test_terminals(self):
        _, board = self.start("emulate", "parol6")
        link = self.folder / "arm"
        process, said = self.tap("parol6", f"pty:{link}", board["listening"][0])
        self.assertEqual(said["listening"][-1], f"pty:{link}")
        port = self.open_terminal(f"pty:{link}")
        sent, answers = b"", b""
        for number in range(50):
            cut = number % len(IDLE)
            for piece in (IDLE[:cut], IDLE[cut:]):
                os.write(port, piece)
            sent += IDLE
            answers += self.read(port, ANSWER_SIZE)
        os.close(port)
        _, errors = self.end(process)
        self.assertIn("pieces passed on", errors)
        lines = self.recorded()
        self.assertEqual(self.bytes_of(lines, "to_device"), sent)
        self.assertEqual(self.bytes_of(lines, "from_device"), answers)
        self.assertEqual(lines[0]["target"], board["listening"][0])
        self.assertFalse(link.is_symlink())

    def test_every_byte_passes_both_ways_on_any_stream(self):
        server, target = self.listen()
        for listen in ("tcp:0", "pty:"):
            with self.subTest(listen):
                process, said = self.tap("parol6", listen, target)
                device, _ = server.accept()
                if listen == "pty:":
                    port = self.open_terminal(said["listening"][0])
                else:
                    port = self.connect(said["listening"][0]).detach()
                data = random.Random(17).randbytes(20_000) + bytes(range(256))
                device.settimeout(PATIENCE)
                for at in range(0, len(data), 1500):
                    piece = data[at:at + 1500]
                    os.write(port, piece)
                    got = b""
                    while len(got) < len(piece):
                        got += device.recv(4096)
                    self.assertEqual(got, piece)
                    device.sendall(piece[::-1])
                    self.assertEqual(self.read(port, len(piece)), piece[::-1])
                os.close(port)
                self.end(process)
                device.close()
                self.assertEqual(self.bytes_of(self.recorded(), "to_device"), data)

    def test_a_device_that_speaks_first_is_heard(self):
        server, target = self.listen()
        process, said = self.tap("parol6", "tcp:0", target)
        device, _ = server.accept()
        client = self.connect(said["listening"][0])
        client.settimeout(0.05)
        for _ in range(PATIENCE * 20):  # what comes before the client is for nobody
            device.sendall(b"hello")
            try:
                self.assertEqual(client.recv(5), b"hello")
                break
            except TimeoutError:
                continue
        else:
            self.fail("it was not heard")
        self.end(process)
        device.close()

    def test_connections_to_a_server(self):
        server, target = self.listen()
        process, said = self.tap("kinovazed", "tcp:0", target)
        place = said["listening"][0]
        one = self.connect(place)
        at_one, _ = server.accept()
        two = self.connect(place)
        at_two, _ = server.accept()
        for socket_ in (at_one, at_two):
            socket_.settimeout(PATIENCE)
        one.sendall(b"Quit")
        self.assertEqual(at_one.recv(64), b"Quit")
        two.sendall(b"EStop\r\n")
        self.assertEqual(at_two.recv(64), b"EStop\r\n")
        at_two.sendall(b"answer\r\n")
        self.assertEqual(two.recv(64), b"answer\r\n")
        one.shutdown(socket.SHUT_WR)
        self.assertEqual(at_one.recv(64), b"", "a half-close passes")
        at_one.sendall(b"late\r\n")
        self.assertEqual(one.recv(64), b"late\r\n", "and answers still come")
        at_one.close()
        self.assertEqual(one.recv(64), b"")
        two.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        two.close()
        with self.assertRaises(ConnectionResetError):
            at_two.recv(64)
        at_two.close()
        self.end(process)
        said = [(line["dir"], line["conn"], line.get("text", line.get("hex")))
                for line in self.recorded()[1:] if line.get("dir") != "overlooked"]
        self.assertEqual(said, [("connect", 0, "ok"), ("connect", 1, "ok"),
                                ("to_device", 0, b"Quit".hex()),
                                ("to_device", 1, b"EStop\r\n".hex()),
                                ("from_device", 1, b"answer\r\n".hex()),
                                ("disconnect", 0, "client-half-close"),
                                ("from_device", 0, b"late\r\n".hex()),
                                ("disconnect", 0, "device-eof"),
                                ("disconnect", 1, "client-reset")])

    def test_a_program_is_judged(self):
        _, board = self.start("emulate", "parol6")
        for gripper, code in ((0, 0), (NO_GRIPPER, 1)):
            with self.subTest(gripper):
                process, said = self.tap("parol6", "pty:", board["listening"][0], "--check")
                port = self.open_terminal(said["listening"][0])
                frame = bytearray(IDLE)
                frame[52] = gripper
                due = time.monotonic()
                for _ in range(100):
                    os.write(port, frame)
                    self.read(port, ANSWER_SIZE)
                    due += 0.01
                    time.sleep(max(0.0, due - time.monotonic()))
                os.close(port)
                out, _ = self.end(process, code)
                report = json.loads(out)
                verdicts = [row["verdict"] for row in report["rows"]]
                self.assertEqual("fail" in verdicts, code == 1, out)
                self.assertIn("pass", verdicts)

    def test_its_own_lateness_is_known_and_nobodys_fault(self):
        _, board = self.start("emulate", "parol6")
        process, said = self.tap("parol6", "pty:", board["listening"][0], "--check")
        port = self.open_terminal(said["listening"][0])
        os.write(port, IDLE)
        self.read(port, ANSWER_SIZE)
        process.send_signal(signal.SIGSTOP)
        for _ in range(20):
            os.write(port, IDLE)
            time.sleep(0.01)
        process.send_signal(signal.SIGCONT)
        self.read(port, 20 * ANSWER_SIZE)
        os.close(port)
        out, errors = self.end(process)
        self.assertIn("late itself", errors)
        self.assertEqual(json.loads(out)["conclusion"], "passed")
        self.assertTrue([line for line in self.recorded() if line.get("dir") == "overlooked"])

    def test_a_device_that_goes(self):
        server, target = self.listen()
        process, said = self.tap("parol6", "tcp:0", target)
        device, _ = server.accept()
        client = self.connect(said["listening"][0])
        client.sendall(IDLE)
        self.assertTrue(device.recv(64))
        device.close()
        _, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 3, errors)
        self.assertIn("the device has gone", errors)
        self.assertEqual(self.bytes_of(self.recorded(), "to_device"), IDLE)

    def test_a_killed_tap_leaves_all_that_passed(self):
        _, board = self.start("emulate", "parol6")
        process, said = self.tap("parol6", "pty:", board["listening"][0])
        port = self.open_terminal(said["listening"][0])
        for _ in range(10):
            os.write(port, IDLE)
            self.read(port, ANSWER_SIZE)
        self.end(process, -signal.SIGKILL, signal.SIGKILL)
        os.close(port)
        self.assertEqual(self.bytes_of(self.recorded(), "to_device"), 10 * IDLE)

    def test_an_emulated_bus(self):
        process, said = self.tap("morap", "i2c:7", "emulated:?nodes=2")
        self.assertEqual(said["listening"], ["i2c:/dev/i2c-7"])
        environment = dict(word.split("=", 1) for word in said["environment"])
        done = subprocess.run(["i2ctransfer", "-y", "7", "w1@0x12", "0x80", "r4"],
                              env=os.environ | environment, capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.end(process)
        lines = [line for line in self.recorded()[1:] if line["op"] != "overlooked"]
        self.assertEqual([(line["op"], line["addr"], line["ack"]) for line in lines],
                         [("write", 18, "AA"), ("read", 18, "A")])

    def test_what_cannot_be_recorded_is_refused(self):
        for device, listen, target, code in (
                ("morap", "i2c:1", "i2c:/dev/i2c-9", 2), ("morap", "pty:", "emulated:", 2),
                ("kinovazed", "pty:", "tcp:127.0.0.1:1", 2), ("parol6", "nowhere", "emulated:", 2),
                ("parol6", "tcp:x", "emulated:", 2), ("parol6", "pty:", "nowhere", 2),
                ("parol6", "tcp:0", "tcp:127.0.0.1:1", 3), ("parol6", "pty:", "pty:/no/such", 3)):
            with self.subTest(f"{device} {listen} {target}"):
                done = subprocess.run([ARMJIG, "record", device, "--listen", listen, "--target",
                                       target, "--out", self.out], capture_output=True, text=True,
                                      check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
                self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
