#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig fuzz` keeps what it finds, in virtual time and over a pseudo-terminal: fuzz_test.py ARMJIG SOURCE"""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

ARMJIG, SOURCE = sys.argv[1:3]
PATIENCE = 120
KNOWN = f"{SOURCE}/fuzz/known/parol6-defects.toml"
FAULTY = "emulated:?fault=quirk:counters-reset-by-clear"


class Fuzz(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fuzz(self, *arguments, code):
        done = subprocess.run([ARMJIG, "fuzz", "parol6", *arguments], capture_output=True, text=True,
                              timeout=PATIENCE, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def play(self, out, *arguments, code=1):
        return self.fuzz("--target", FAULTY, "--known", KNOWN, "--out", self.folder / out, *arguments,
                         code=code)

    def finding(self, out):
        return next(iter((self.folder / out / "findings").glob("*.jsonl")))

    def replay(self, file, target):
        return subprocess.run([ARMJIG, "replay", file, "--target", target], capture_output=True,
                              timeout=PATIENCE, check=False).returncode

    def test_keeps_a_finding_that_replay_plays(self):
        self.play("found", "--fail-fast", "--cases", "50")
        finding = self.finding("found")
        self.assertEqual(self.replay(finding, FAULTY), 1)
        self.assertEqual(self.replay(finding, "emulated:"), 0)
        self.assertIn("TEST(FuzzFinding, ", finding.with_suffix(".cpp").read_text())
        self.assertIn("answered with telemetry", finding.with_suffix(".txt").read_text())

    def test_goes_on_where_it_was(self):
        self.play("found", "--cases", "5")
        self.play("found", "--cases", "5")
        campaign = json.loads((self.folder / "found" / "campaign.json").read_text())
        self.assertEqual(campaign["cases"], 10)
        self.play("found", "--cases", "5", "--seed", "2", code=2)

    def test_merges_shards(self):
        for shard in ("1/2", "2/2"):
            self.play(shard[0], "--shard", shard, "--fail-fast", "--cases", "50")
        report = self.folder / "report.json"
        self.fuzz("--merge", self.folder / "1", self.folder / "2", "--out", self.folder / "all", "--json",
                  report, code=1)
        rows = [row["name"] for row in json.loads(report.read_text())["rows"]]
        self.assertEqual(len(rows), len(set(rows)))
        self.assertTrue(self.finding("all").exists())

    def test_says_nothing_of_a_sound_device(self):
        out = self.fuzz("--target", "emulated:", "--known", KNOWN, "--cases", "20", code=0)
        self.assertIn("20 cases were played", out)

    def test_ends_with_its_report_when_it_is_interrupted(self):
        process = subprocess.Popen([ARMJIG, "fuzz", "parol6", "--target", FAULTY, "--known", KNOWN],
                                   stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.assertIn("FINDING", process.stdout.readline())
        process.send_signal(signal.SIGINT)
        self.assertIn("not every case was played", process.communicate(timeout=PATIENCE)[0])
        self.assertEqual(process.returncode, 130)

    def live_board(self, *arguments):
        link = self.folder / "board"
        emulator = subprocess.Popen([ARMJIG, "emulate", "parol6", "--link", link, *arguments],
                                    stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        self.addCleanup(emulator.stdout.close)
        self.addCleanup(emulator.wait)
        self.addCleanup(emulator.terminate)
        emulator.stdout.readline()
        return link

    def test_does_not_pass_what_ended_early(self):
        link = self.live_board("--set", "fault=zero:gripper.object")
        report = self.folder / "report.json"
        out = self.fuzz("--target", f"pty:{link}", "--allow", "state", "--restart", "false", "--json", report, code=3)
        self.assertRegex(out, "ERROR +parol6[.]fuzz[.]end")
        self.assertEqual(json.loads(report.read_text())["conclusion"], "rig")

    def test_says_what_differed_before_it_began(self):
        link = self.live_board("--set", "fault=zero:gripper.object")
        # It differs from the beginning, and nobody can start it again.
        out = self.fuzz("--target", f"pty:{link}", "--allow", "state", "--known", KNOWN, "--cases", "3", code=0)
        self.assertRegex(out, "nothing is said of telemetry: .*gripper.object 0")

    def learn(self, device, *arguments, code):
        done = subprocess.run([ARMJIG, "fuzz", device, "--learn", *arguments], capture_output=True, text=True,
                              timeout=PATIENCE, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_learns_the_documented_machines_and_draws_them(self):
        for device in ("kinovazed", "parol6", "morap"):
            drawing = self.folder / f"{device}.json"
            out = self.learn(device, "--target", "emulated:", "--draw", drawing, code=0)
            self.assertRegex(out, f"PASS +{device}[.]learn[.].*, as documented")
            self.assertLessEqual(int(re.search("letters +([0-9]+)", out)[1]), 10000)
            self.assertTrue(json.loads(drawing.read_text())["machines"][0]["states"][0]["documented"])
        for ending in ("dot", "svg", "html"):
            drawing = self.folder / f"node.{ending}"
            self.learn("morap", "--target", "emulated:", "--draw", drawing, code=0)
            self.assertIn("uncalibrated", drawing.read_text())

    def test_names_a_wrong_step_of_a_machine(self):
        out = self.learn("kinovazed", "--target", "emulated:?fault=row:frozen.Unfreeze.rejected", code=1)
        self.assertRegex(out, "FAIL +kinovazed.learn.server.frozen.Unfreeze")

    def test_says_when_letters_do_not_suffice(self):
        out = self.learn("kinovazed", "--target", "emulated:", "--most-letters", "500", code=3)
        self.assertIn("the letters were used up", out)

    def test_says_what_it_lacks(self):
        link = self.live_board("--speed", "20")
        out = self.learn("parol6", "--target", f"pty:{link}", "--allow", "all", "--machine", "gripper", code=2)
        self.assertIn("--restart", out)
        self.assertIn("its entry has no alphabet", self.learn("demo", "--target", "emulated:", code=2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
