#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""An emulated device beside another one: `armjig record --shadow` tells where they part, `conformance
--shadow` too: shadow_test.py ARMJIG SOURCE
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

ARMJIG, SOURCE = sys.argv[1:3]
PATIENCE = 120

class Shadow(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.processes = []

    def run_armjig(self, *words, codes=(0,)):
        done = subprocess.run([ARMJIG, *map(str, words)], capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertIn(done.returncode, codes, done.stdout + done.stderr)
        return done

    def record(self, target, shadow):
        """What is said of both while a host watches; and the exit code."""
        tap = subprocess.Popen([ARMJIG, "record", "kinovazed", "--listen", "tcp:0", "--target",
                                target, "--out", self.folder / "a.jsonl", "--shadow", shadow,
                                "--json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        place = json.loads(tap.stdout.readline())["listening"][0]
        self.run_armjig("watch", "kinovazed", "--target", place, "--seconds", 2, "--json")
        tap.send_signal(signal.SIGINT)
        _, told = tap.communicate(timeout=PATIENCE)
        return tap.returncode, told

    def test_of_a_device_like_the_other_it_says_nothing(self):
        code, told = self.record("emulated:", "emulated:")
        self.assertEqual(code, 0, told)
        self.assertIn(" 0 divergences", told)

    def test_it_tells_the_first_message_that_differs(self):
        code, told = self.record("emulated:?clock=-3", "emulated:")
        self.assertEqual(code, 1, told)
        self.assertRegex(told.splitlines()[0], r"shadow: \d\.\d+ s, connection 0: 'Heartbeat' "
                                               r"comes from the emulated one only")

    def fit(self, device, recording, board):
        """What is told of a board like that, from what it says to the host of a recording; and the
        recording."""
        file = self.folder / "board.jsonl"
        target = "emulated:?" + "&".join(f"{name}={value}" for name, value in board.items())
        self.run_armjig("replay", f"{SOURCE}/captures/{device}/{recording}.jsonl", "--target",
                        target, "--capture", file, "--rules", self.loose(), codes=(0, 1))
        done = self.run_armjig("shadow", "fit", file, "--json")
        found = json.loads(done.stdout)
        told = {one["option"]: one["value"] for one in found["figures"] if "value" in one}
        for name, value in board.items():
            pairs = zip(value.split(","), told[name].split(","), strict=True)
            for one, other in pairs:
                if one.replace(".", "").replace("-", "").isdigit():
                    self.assertLessEqual(abs(float(one) - float(other)), 0.02 * abs(float(one)),
                                         f"{name}: {done.stdout}")
                else:
                    self.assertEqual(one, other, done.stdout)
        return found, file

    def loose(self):
        rules = self.folder / "loose.toml"
        rules.write_text('time_ms = 1000\norder = "free"\n')
        return rules

    def test_fit_finds_the_board(self):
        """And nothing parts with what was found; with a defect it is told at its first message."""
        for device, recording, board, defect, named in (
                ("parol6", "home_full_a",
                 {"clock": "-0.6", "pass-us": "13", "to-switch": "2600,3100,1900,2200,1700,5200"},
                 "zero:echo", "echo: "),
                ("kinovazed", "session-joystick-modes",
                 {"clock": "0.9", "plant": "bench", "call-us": "2300"}, "missing:JoystickModeSet", "JoystickModeSet"),
                ("morap", "loop-speed-default",
                 {"nodes": "1", "motor": "dcx22l", "inertia": "0.08"}, "out:zero:angle.angle", "angle: ")):
            with self.subTest(device):
                found, file = self.fit(device, recording, board)
                self.assertEqual(found["differences"], 0)
                self.assertGreater(found["differences_before"], 0)
                self.run_armjig("replay", file, "--target", found["target"])
                done = self.run_armjig("replay", file, "--target",
                                       f"{found['target']}&fault={defect}", "--json", codes=(1,))
                self.assertIn(named, json.dumps(json.loads(done.stdout)["differences"][0]))

    def test_a_shadow_with_what_was_found_does_not_part(self):
        board = {"clock": "-0.8", "call-us": "1500", "plant": "jaco"}
        found, _ = self.fit("kinovazed", "session-joystick-modes", board)
        target = "emulated:?" + "&".join(f"{name}={value}" for name, value in board.items())
        code, told = self.record(target, found["target"])
        self.assertEqual(code, 0, told)
        self.assertIn(" 0 divergences", told)

    def beside_a_live_one(self, device, place, options, shadow, lines):
        """What is told of a device that another program emulates on a link of that kind, while
        somebody drives it by hand; and the exit code. Again if the one who drives had no time, so
        that a supervisor stopped the arm, and what followed was rejected."""
        for _ in range(3):
            code, told, was_stopped = self.driven_by_hand(device, place, options, shadow, lines)
            if not was_stopped:
                break
        return code, told

    def driven_by_hand(self, device, place, options, shadow, lines):
        board = self.start("emulate", device, *place,
                           *(word for name, value in options.items()
                             for word in ("--set", f"{name}={value}")))
        listen = "pty:" if "pty" in board else "tcp:0"
        tap = self.start("record", device, "--listen", listen, "--target", board, "--out",
                         self.folder / "live.jsonl", "--shadow", *shadow)
        driver = subprocess.run([ARMJIG, "console", device, "--target", tap, "--allow", "all"],
                                input="\n".join(lines), stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, check=False, timeout=PATIENCE)
        process = self.processes.pop()
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=PATIENCE)
        return process.returncode, told, "was rejected" in driver.stdout

    def start(self, *words):
        """A program that says as JSON where it listens: the place."""
        process = subprocess.Popen([ARMJIG, *map(str, words), "--json"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.processes.append(process)
        return json.loads(process.stdout.readline())["listening"][0]

    def test_beside_a_live_device_it_says_hardly_anything_but_of_a_defect(self):
        """On real links. On a machine that is busy a piece comes so late that even a device like the
        other one does otherwise, so a few divergences are no failure, and of a server, which says
        little, times are not judged."""
        patient = self.folder / "patient.toml"
        patient.write_text('time_ms = 2000\norder = "free"\n'
                           'message = [{name = "Heartbeat", ignore = true}]\n')
        for device, place, options, rules, defect, named, lines in (
                ("parol6", (), {"clock": "-0.6", "pass-us": "17"}, (), "zero:echo", "echo: ",
                 ("enable", "jog j1 1000 1", "jog j1 -1000 1", "disable")),
                ("kinovazed", ("--tcp", "0"), {"clock": "0.9", "call-us": "2300"},
                 ("--rules", patient), "missing:Freezed", "Freezed",
                 ("quitestop", "initialize", "freeze", "unfreeze", "estop"))):
            target = "emulated:?" + "&".join(f"{name}={value}" for name, value in options.items())
            for is_faulty in (False, True):
                with self.subTest(device, is_faulty=is_faulty):
                    more = {"fault": defect} if is_faulty else {}
                    code, told = self.beside_a_live_one(device, place, options | more,
                                                        (target, *rules), lines)
                    messages, apart = map(int, re.search(
                        r"shadow: (\d+) messages, (\d+) divergences", told).groups())
                    self.assertGreater(messages, 5, told)
                    if is_faulty:
                        self.assertEqual(code, 1, told)
                        self.assertIn(named, told.splitlines()[0])
                    else:
                        self.assertLessEqual(apart, 0.05 * messages, told)

    def test_fit_says_what_was_so_before_the_recording(self):
        """A gripper that is calibrated already, here."""
        told = self.run_armjig("shadow", "fit", f"{SOURCE}/captures/parol6/jog_stops_a.jsonl",
                               "--json", codes=(0, 4)).stdout
        self.assertTrue(json.loads(told)["differs_from_the_beginning"], told)
        done = self.run_armjig("shadow", "fit", f"{SOURCE}/captures/parol6/jog_stops_a.jsonl",
                               codes=(0, 4))
        self.assertRegex(done.stdout, "the first: 0\\.\\d+ s")
        self.assertIn("was the board switched on before", done.stdout)

    def test_fit_says_what_it_cannot_tell(self):
        file = self.folder / "short.jsonl"
        self.run_armjig("watch", "parol6", "--target", "emulated:", "--seconds", 1, "--capture",
                        file)
        found = json.loads(self.run_armjig("shadow", "fit", file, "--json").stdout)
        told = {one["option"]: one for one in found["figures"]}
        self.assertNotIn("value", told["to-switch"])
        self.assertIn("homes", told["to-switch"]["basis"])
        done = self.run_armjig("shadow", "fit", f"{SOURCE}/captures/demo/start-and-halt.jsonl",
                               codes=(4,))
        self.assertIn("nobody has said how figures of demo are told", done.stderr)

    def test_beside_conformance_it_changes_no_verdict(self):
        words = ("conformance", "demo", "--target", "emulated:", "--shadow")
        done = self.run_armjig(*words, "emulated:")
        self.assertIn(" 0 divergences", done.stderr)
        done = self.run_armjig(*words, "emulated:?fault=off-by-one:state")
        self.assertRegex(done.stderr, r"shadow: \d+ messages, [1-9]\d* divergences")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
