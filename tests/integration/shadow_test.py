#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""An emulated device beside another one: `armjig record --shadow` tells where they part, `conformance
--shadow` too: shadow_test.py ARMJIG SOURCE
"""

import json
import pathlib
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
                 {"clock": "-0.6", "pass-us": "17", "to-switch": "2600,3100,1900,2200,1700,5200"},
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
    unittest.main(argv=sys.argv[:1])
