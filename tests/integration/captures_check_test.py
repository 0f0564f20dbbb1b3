#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig captures check`: a corpus against emulators and targets, in parts, renewed, and told
apart from what is not in it any more: captures_check_test.py ARMJIG SOURCE
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ARMJIG, SOURCE = sys.argv[1:3]
PATIENCE = 120
# Of each device one with a header of its own.
GOLDEN = {"parol6": "parol6/jog_stops_a", "kinovazed": "kinovazed/estop-flap",
          "morap": "morap/static-status-transitions"}


class CapturesCheck(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.corpus = self.folder / "corpus"
        self.corpus.mkdir()

    def run_armjig(self, *words, code=0):
        done = subprocess.run([ARMJIG, *map(str, words)], capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, timeout=PATIENCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def check(self, *words, code=0):
        """Verdicts by path, and what was printed."""
        report = self.folder / "report.json"
        done = self.run_armjig("captures", "check", self.corpus, *words, "--json", report,
                               code=code)
        rows = json.loads(report.read_text())["rows"]
        return {row["name"].removeprefix(f"captures.{self.corpus}/"): row for row in rows}, done

    def add_golden(self):
        for device, name in GOLDEN.items():
            (self.corpus / device).mkdir()
            shutil.copy(f"{SOURCE}/captures/{name}.jsonl", self.corpus / device)

    def add_captures(self):
        """What --capture writes, in both forms."""
        for device, ending in (("parol6", "jsonl"), ("kinovazed", "pcapng"), ("morap", "jsonl")):
            self.run_armjig("watch", device, "--target", "emulated:", "--seconds", 3, "--capture",
                            self.corpus / f"{device}.{ending}")

    def change_answer(self, path, what='"from_device"'):
        """Another last digit in the middle one of the lines that the device said."""
        lines = path.read_text().splitlines()
        said = [i for i, line in enumerate(lines) if what in line and '"hex"' in line]
        place = said[len(said) // 2]
        event = json.loads(lines[place])
        digit = event["hex"][-1]
        event["hex"] = event["hex"][:-1] + ("0" if digit != "0" else "1")
        lines[place] = json.dumps(event)
        path.write_text("\n".join(lines) + "\n")
        return place + 1

    def test_all_is_as_recorded(self):
        self.add_golden()
        self.add_captures()
        rows, done = self.check()
        self.assertEqual({row["verdict"] for row in rows.values()}, {"pass"})
        self.assertEqual(len(rows), 6)
        self.assertIn("6 passed, 0 failed", done.stdout)

    def test_a_changed_answer_is_found_in_its_file_and_line(self):
        self.add_golden()
        for device, what in (("parol6", "from_device"), ("kinovazed", "from_device"),
                             ("morap", "read")):
            with self.subTest(device):
                file = self.corpus / f"{GOLDEN[device]}.jsonl"
                whole = file.read_text()
                line = self.change_answer(file, f'"{what}"')
                junit = self.folder / "junit.xml"
                rows, done = self.check("--junit", junit, code=1)
                failed = [name for name, row in rows.items() if row["verdict"] == "fail"]
                self.assertEqual(failed, [f"{GOLDEN[device]}.jsonl"])
                self.assertIn(f"{file}:{line}", rows[failed[0]]["evidence"])
                self.assertIn("2 passed, 1 failed", done.stdout)
                suites = xml.etree.ElementTree.parse(junit).getroot()
                self.assertEqual((suites.get("tests"), suites.get("failures")), ("3", "1"))
                file.write_text(whole)

    def test_each_folder_is_a_suite(self):
        self.add_golden()
        junit = self.folder / "junit.xml"
        self.check("--junit", junit)
        suites = xml.etree.ElementTree.parse(junit).getroot().findall("testsuite")
        self.assertEqual(sorted(suite.get("name") for suite in suites),
                         sorted(f"{self.corpus}/{device}" for device in GOLDEN))
        self.assertEqual({suite.get("tests") for suite in suites}, {"1"})

    def test_shards_together_have_each_recording_once(self):
        self.add_golden()
        self.add_captures()
        seen = []
        for part in ("1/4", "2/4", "3/4", "4/4"):
            seen += self.check("--shard", part, "--jobs", 3)[0]
        self.assertEqual(len(seen), 6)
        self.assertEqual(len(set(seen)), 6)
        self.check("--shard", "7/7", code=4)

    def test_update_tells_first_and_is_equal_then(self):
        self.add_golden()
        self.add_captures()
        texts = [self.corpus / f"{GOLDEN['parol6']}.jsonl", self.corpus / "morap.jsonl",
                 self.corpus / "parol6.jsonl"]
        before = [text.read_text() for text in texts]
        for text in texts:
            self.change_answer(text, '"read"' if "morap" in text.name else '"from_device"')
        _, done = self.check("--update")
        self.assertIn("3 passed, 3 failed", done.stdout)
        for text in texts:
            self.assertLess(done.stdout.index(f"{text}:"), done.stdout.index(f"updated {text}\n"))
        self.assertEqual(texts[0].read_text(), before[0])
        self.assertEqual(set(self.corpus.rglob("*.new.*")), set())
        _, done = self.check("--update")
        self.assertNotIn("updated", done.stdout)

    def test_a_target_and_rules(self):
        self.add_captures()
        self.check("--target", "emulated:")
        rules = self.folder / "rules.toml"
        rules.write_text('[[field]]\nname = "timing"\nignore = true\n')
        file = self.corpus / "parol6.jsonl"
        file.rename(self.folder / "parol6.jsonl")
        shutil.rmtree(self.corpus)
        self.corpus.mkdir()
        (self.folder / "parol6.jsonl").rename(file)
        slow = ("--target", "emulated:?pass-us=100")
        rows, _ = self.check(*slow, code=1)
        self.assertIn("timing", rows["parol6.jsonl"]["evidence"])
        self.assertIn("armjig replay ", rows["parol6.jsonl"]["repeat"])

        # The change is accepted knowingly: recorded anew from that board.
        self.check(*slow, "--update")
        self.check(*slow)
        self.check("--target", "emulated:")  # each is like the recorded one
        self.check("--target", "emulated:?pass-us=10", code=1)

    def test_what_cannot_be_judged_is_not_called_passed(self):
        (self.corpus / "broken.jsonl").write_text("no recording\n")
        rows, _ = self.check(code=3)
        self.assertEqual(rows["broken.jsonl"]["verdict"], "error")
        (self.corpus / "broken.jsonl").write_text(
            '{"format":"golden-trace/1","device":"toaster"}\n')
        rows, _ = self.check(code=4)
        self.assertEqual(rows["broken.jsonl"]["verdict"], "skipped")
        (self.corpus / "broken.jsonl").unlink()
        self.check(code=4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
