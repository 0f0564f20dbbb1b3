#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig replay` plays the host or the device of a recording: in virtual time, and on
pseudo-terminals, TCP and a virtual I2C bus: replay_test.py ARMJIG SOURCE
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

ARMJIG, SOURCE = sys.argv[1:3]
PATIENCE = 120
# The machine may be slow; what is said, and how often, has to be the same.
RULES = """
time_ms = 3000
[[field]]
name = "timing"
ignore = true
"""
JOG = f"{SOURCE}/captures/parol6/jog_stops_a.jsonl"


class Replay(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.rules = self.folder / "rules.toml"
        self.rules.write_text(RULES)

    def run_armjig(self, *words, code=0):
        done = subprocess.run([ARMJIG, *map(str, words)], capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def emulate(self, *words):
        """An emulated device for other programs, and where it listens."""
        process = subprocess.Popen([ARMJIG, "emulate", *map(str, words), "--json"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.send_signal, signal.SIGINT)
        return json.loads(process.stdout.readline())["listening"][0]

    def record(self, device, seconds=1):
        """What a host that only watches and an emulated device say to each other."""
        file = self.folder / f"{device}.jsonl"
        self.run_armjig("watch", device, "--target", "emulated:", "--seconds", seconds,
                        "--capture", file)
        return file

    def changed(self, file, direction, what, by):
        """The recording with something else in the middle of those lines."""
        lines = file.read_text().splitlines()
        of_it = [i for i, line in enumerate(lines) if direction in line and what in line]
        place = of_it[len(of_it) // 2]
        lines[place] = lines[place].replace(what, by, 1)
        other = self.folder / "changed.jsonl"
        other.write_text("\n".join(lines) + "\n")
        return other

    def test_in_virtual_time_each_byte_and_time_is_the_same(self):
        for device in ("parol6", "kinovazed", "morap"):
            with self.subTest(device):
                file = self.record(device, 3)
                for _ in range(2):
                    done = self.run_armjig("replay", file, "--target", "emulated:")
                    self.assertEqual((done.stdout, done.stderr), ("equal\n", ""))
                packets = self.folder / f"{device}.pcapng"
                self.run_armjig("trace", "convert", file, packets)
                self.run_armjig("replay", packets, "--target", "emulated:")

    def test_recordings_of_real_devices_set_the_emulated_one_up(self):
        """Switches, parameters, clocks, a shaft turned by hand, an arm that is unplugged."""
        loose = self.folder / "loose.toml"
        loose.write_text('time_ms = 60\norder = "free"\n')
        for name, rules in (("parol6/jog_stops_a", ()), ("parol6/estop_and_inputs_a", ()),
                            ("morap/loop-friction", ()), ("morap/stim-encoder-angle", ()),
                            ("morap/stim-adc-current", ()), ("morap/pen-buttons", ()),
                            ("kinovazed/fault-unplug-idle", ("--rules", loose))):
            with self.subTest(name):
                file = f"{SOURCE}/captures/{name}.jsonl"
                done = self.run_armjig("replay", file, "--target", "emulated:", *rules)
                self.assertEqual(done.stdout, "equal\n")
                self.assertNotIn("input", done.stderr)
        # On another one they are not equal, so that the header counts.
        for name in ("parol6/jog_stops_a", "morap/loop-friction"):
            with self.subTest(name):
                other = {"parol6": "pass-us=10", "morap": "nodes=1"}[name.split("/", 1)[0]]
                self.run_armjig("replay", f"{SOURCE}/captures/{name}.jsonl", "--target",
                                f"emulated:?{other}", code=1)

    def test_a_hosted_device_is_like_that_of_a_recording(self):
        file = f"{SOURCE}/captures/parol6/framing_crc_any_a.jsonl"
        place = self.emulate("parol6", "--pty", "--set", f"like={file}")
        target = place if place.startswith("pty:") else f"pty:{place}"
        self.run_armjig("replay", file, "--target", target, "--rules", self.rules, "--allow",
                        "state,move")

    def test_like_stands_alone_and_says_what_it_cannot_read(self):
        for words, said in (("like=/no/such", "like=/no/such: "),
                            (f"like={JOG}&pass-us=10", "place of all other options"),
                            (f"like={SOURCE}/README.md", "README.md")):
            with self.subTest(words):
                done = self.run_armjig("console", "parol6", "--target", f"emulated:?{words}", code=2)
                self.assertIn(said, done.stderr)

    def test_what_was_written_by_hand(self):
        self.run_armjig("replay", f"{SOURCE}/captures/demo/start-and-halt.jsonl", "--target",
                        "emulated:")

    def test_what_differs_is_named(self):
        file = self.record("kinovazed", 5)
        other = self.changed(file, "from_device", "".join(f"{ord(c):02x}" for c in "Heartbeat:3"),
                             "".join(f"{ord(c):02x}" for c in "Heartbeat:2"))
        done = self.run_armjig("replay", other, "--target", "emulated:", code=1)
        self.assertIn("state: ", done.stdout)
        self.assertIn("1 times state", done.stdout)
        self.assertIn("1 times what kinovazed.beat.values speaks of: ", done.stdout)
        found = json.loads(self.run_armjig("replay", other, "--target", "emulated:", "--json",
                                           code=1).stdout)
        self.assertEqual((len(found["differences"]), found["fields"]), (1, {"state": 1}))
        self.assertEqual(found["requirements"], {"kinovazed.beat.values": 1})

    def test_what_the_host_sends_reaches_the_device(self):
        file = self.record("morap")
        other = self.changed(file, '"write"', '"80"', '"88"')  # the address, and not the angle
        done = self.run_armjig("replay", other, "--target", "emulated:", code=1)
        self.assertIn("different", done.stdout)

    def test_a_pseudo_terminal(self):
        place = self.emulate("parol6", "--pty")
        target = place if place.startswith("pty:") else f"pty:{place}"
        self.run_armjig("replay", self.record("parol6"), "--target", target, "--rules", self.rules,
                        "--allow", "state")

    def test_tcp(self):
        target = self.emulate("kinovazed", "--tcp", "0")
        self.run_armjig("replay", self.record("kinovazed", 8), "--target", target, "--rules",
                        self.rules)

    def test_without_rules_a_real_device_may_be_late_and_not_wrong(self):
        target = self.emulate("kinovazed", "--tcp", "0")
        file = self.record("kinovazed", 8)
        done = subprocess.run([ARMJIG, "replay", file, "--target", target, "--json"], capture_output=True,
                              text=True, check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        # To the nanosecond each would differ; on a busy machine few may, by the 100 ms that are let pass.
        self.assertLess(len(json.loads(done.stdout)["differences"]), 3, done.stdout)
        wrong = self.changed(file, "from_device", b"Heartbeat".hex(), b"heartbeat".hex())
        done = self.run_armjig("replay", wrong, "--target", target, code=1)
        self.assertIn("different", done.stdout)

    def test_a_corpus_on_a_real_device_is_judged_as_a_replay(self):
        target = self.emulate("kinovazed", "--tcp", "0")
        corpus = self.folder / "corpus"
        corpus.mkdir()
        self.record("kinovazed", 8).rename(corpus / "idle.jsonl")
        done = subprocess.run([ARMJIG, "captures", "check", corpus, "--target", target], capture_output=True,
                              text=True, check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertLess(done.stdout.count("time"), 3, done.stdout)

    def test_a_virtual_bus(self):
        bus = self.folder / "bus.toml"
        bus.write_text("[[node]]\nid = 2\n")
        self.run_armjig("lab", "exec", "--i2c", bus, "--", ARMJIG, "replay", self.record("morap"),
                        "--target", "i2c:/dev/i2c-1", "--rules", self.rules)

    def rules_of_devices(self):
        """What armjig says first to a serial device, so that it finds the beginning of frames."""
        rules = self.folder / "of-devices.toml"
        rules.write_text(RULES + '[[message]]\nname = "noise"\nignore = true\n')
        return rules

    def play_device(self, file, listen, *words):
        """The device of a recording for other programs, where it is, and what they need for it."""
        process = subprocess.Popen([ARMJIG, "replay", file, "--listen", listen, "--json", *words],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: process.poll() is None and process.communicate())
        self.addCleanup(lambda: process.poll() is None and process.kill())
        said = json.loads(process.stdout.readline())
        place = said["listening"][0]
        needs = dict(word.split("=", 1) for word in said.get("environment", []))
        return process, place, needs

    def verdict_of(self, process, code):
        out, err = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, code, out + err)
        return json.loads(out)

    def test_a_host_hears_the_device_that_was_recorded(self):
        for device, listen in (("parol6", "pty:"), ("parol6", "tcp:0"), ("kinovazed", "tcp:0")):
            with self.subTest(device, listen=listen):
                file = self.record(device, 3)
                process, place, _ = self.play_device(file, listen, "--rules", self.rules_of_devices())
                self.run_armjig("replay", file, "--target", place, "--rules", self.rules,
                                "--allow", "state")
                self.assertTrue(self.verdict_of(process, 0)["equal"])

    def test_a_host_on_a_bus_hears_it_until_ctrl_c(self):
        file = self.record("morap", 2)
        process, place, needs = self.play_device(file, "i2c:1", "--rules", self.rules)
        done = subprocess.run([ARMJIG, "replay", file, "--target", place, "--rules", self.rules],
                              env={**os.environ, **needs}, capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        process.send_signal(signal.SIGINT)
        self.assertTrue(self.verdict_of(process, 0)["equal"])

    def test_a_host_that_says_something_else_is_told(self):
        file = self.record("parol6", 2)
        other = self.changed(file, "to_device", '"hex":"ffffff34000000', '"hex":"ffffff34000001')
        process, target, _ = self.play_device(file, "pty:", "--rules", self.rules_of_devices())
        self.run_armjig("replay", other, "--target", target, "--rules", self.rules, "--allow",
                        "state")
        found = self.verdict_of(process, 1)
        self.assertTrue(found["differences"])
        self.assertEqual({one["lane"] for one in found["differences"]},
                         {"parol6 stream 0 to_device"})

    def test_a_host_that_stops_in_the_middle_is_told(self):
        file = self.record("parol6", 3)
        lines = file.read_text().splitlines()
        half = self.folder / "half.jsonl"
        half.write_text("\n".join(lines[: len(lines) // 2]) + "\n")
        process, target, _ = self.play_device(file, "pty:", "--rules", self.rules_of_devices())
        self.run_armjig("replay", half, "--target", target, "--rules", self.rules, "--allow",
                        "state")
        process.send_signal(signal.SIGINT)
        found = self.verdict_of(process, 1)
        self.assertEqual({one["change"] for one in found["differences"]}, {"missing"})

    def test_speed_is_scaled_back(self):
        """Ten times as fast, a server says a tenth of its heartbeats."""
        done = self.run_armjig("replay", self.record("kinovazed", 10), "--target", "emulated:",
                               "--speed", 10, code=1)
        self.assertIn("missing", done.stdout)

    def test_what_moves_an_arm_is_asked_for_before_the_first_byte(self):
        place = self.emulate("parol6", "--pty", "--capture", self.folder / "got.jsonl")
        target = place if place.startswith("pty:") else f"pty:{place}"
        done = self.run_armjig("replay", JOG, "--target", "teleport:", code=2)
        self.assertIn("this is no target", done.stderr)
        done = self.run_armjig("replay", JOG, "--target", target, code=3)
        self.assertIn("nothing was sent: this recording needs --allow ", done.stderr)
        self.assertIn("move", done.stderr)
        self.assertNotIn("to_device", (self.folder / "got.jsonl").read_text())

    def test_misuse(self):
        empty = self.folder / "empty.jsonl"
        empty.write_text('{"format":"golden-trace/1","device":"parol6"}\n')
        toaster = self.folder / "toaster.jsonl"
        toaster.write_text('{"format":"golden-trace/1","device":"toaster"}\n'
                           '{"t_us":0,"dir":"to_device","hex":"00"}\n')
        for words in ((JOG,), (JOG, "--target", "nowhere"), (empty, "--target", "emulated:"),
                      (toaster, "--target", "emulated:"), ("/no/such", "--target", "emulated:"),
                      (JOG, "--target", "emulated:", "--speed", "0"),
                      (JOG, "--target", "emulated:", "--rules", "/no/such"),
                      (JOG, "--target", "emulated:", "--listen", "pty:"),
                      (JOG, "--listen", "pty:", "--allow", "move"),
                      (JOG, "--listen", "i2c:1"), (JOG, "--listen", "nowhere")):
            with self.subTest(words=words):
                self.run_armjig("replay", *words, code=2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
