#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""An emulated device beside another one: `armjig record --shadow` tells where they part, `conformance
--shadow` too: shadow_test.py ARMJIG
"""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

ARMJIG = sys.argv[1]
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

    def test_beside_conformance_it_changes_no_verdict(self):
        words = ("conformance", "demo", "--target", "emulated:", "--shadow")
        done = self.run_armjig(*words, "emulated:")
        self.assertIn(" 0 divergences", done.stderr)
        done = self.run_armjig(*words, "emulated:?fault=off-by-one:state")
        self.assertRegex(done.stderr, r"shadow: \d+ messages, [1-9]\d* divergences")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
