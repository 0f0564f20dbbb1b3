#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig trace what-if` finds the least that goes wrong on a link before a talk breaks, with the
host of a recording and with a program in the loop: what_if_test.py ARMJIG SOURCE
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

ARMJIG, SOURCE = sys.argv[1:3]
PATIENCE = 120
# A client that loses track after one lost answer: it goes on with the next request, and misses the
# answer in the end.
CLIENT = """
import socket
import sys

host, port = sys.argv[1].rsplit(":", 1)
link = socket.create_connection((host, int(port)), timeout=0.5)
held = b""
answers = 0
for request in (b"EStop", b"QuitEStop", b"EStop"):
    link.sendall(request + b"\\r\\n")
    try:
        while not held.count(b"Accepted"):
            held += link.recv(4096)
        held = b""
        answers += 1
    except TimeoutError:
        pass
sys.exit(0 if answers == 3 else 3)
"""


class WhatIf(unittest.TestCase):
    def what_if(self, *words, codes=(1,)):
        done = subprocess.run([ARMJIG, "trace", "what-if", *map(str, words), "--json"],
                              capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertIn(done.returncode, codes, done.stdout + done.stderr)
        return json.loads(done.stdout)

    def test_of_a_recording_it_finds_the_one_piece(self):
        for name in ("parol6/jog_stops_a", "kinovazed/connection-half-close",
                     "morap/loop-direct-voltage"):
            with self.subTest(name):
                file = f"{SOURCE}/captures/{name}.jsonl"
                told = self.what_if(file)
                self.assertEqual(len(told["found"]["perturbations"]), 1)
                rule = told["found"]["rule"]
                other = self.what_if(file, "--ignore", rule, "--most", 1, codes=(0, 1))
                self.assertNotEqual((other["found"] or {}).get("rule"), rule)

    def test_a_program_that_loses_track_is_found_out_by_one_lost_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            client = pathlib.Path(folder) / "client.py"
            client.write_text(CLIENT)
            began = time.monotonic()
            told = self.what_if(f"{SOURCE}/captures/kinovazed/connection-half-close.jsonl",
                                *(word for rule in ("one-at-a-time", "estop-once",
                                                    "leaves-answered")
                                  for word in ("--ignore", f"kinovazed.host.{rule}")),
                                "--", sys.executable, client, "{}")
            self.assertLess(time.monotonic() - began, 60)
        self.assertEqual(told["found"]["rule"], "program")
        self.assertEqual(told["found"]["what"], "it ends with 3 and not with 0")
        self.assertEqual([one["kind"] for one in told["found"]["perturbations"]], ["lost"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
