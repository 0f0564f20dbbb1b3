#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What becomes of results when a disk is full, nobody reads, or somebody wants an end:
outputs_test.py ARMJIG SOURCE_DIR
"""

import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ARMJIG = sys.argv[1]
SOURCE = pathlib.Path(sys.argv[2])
PATIENCE = 60
DEMO = ["conformance", "demo", "--target", "emulated:"]
LONG = ["conformance", "parol6", "--target", "emulated:", "--repeat", "300"]

# Each prints something.
PRINTS = [
    "--help", "--version", "conformance --help", "conformance demo --target emulated:",
    "conformance demo --list", "conformance demo --explain demo.query",
    "conformance mutants demo --list", "conformance mutants demo", "completion bash",
    "decode demo A5718E", "devices --json", "doctor", "i2c scan --target emulated:", "kin limits",
    "kin fk 0 -90 180 0 0 180", "morap tune --type pd --inertia 0.2 --pole -9",
    "morap simulate --type pd --pole -9 --inertia 0.2",
    f"plan {SOURCE}/harness/script/examples/joint6.rbt",
    f"run {SOURCE}/harness/script/examples/joint6.rbt --target emulated: --home",
    f"script format {SOURCE}/harness/script/examples/joint6.rbt",
    f"trace verify {SOURCE}/captures/parol6/outputs_sweep_a.jsonl",
    "watch parol6 --target emulated: --seconds 1", "watch parol6 --target emulated: --count 5 --json",
]


def run(arguments, **how):
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL,
           "text": True, "timeout": PATIENCE} | how
    if "input" in how:
        del how["stdin"]
    return subprocess.run([ARMJIG, *(arguments.split() if isinstance(arguments, str) else arguments)],
                          check=False, **how)


def limited():
    """A file of the program may not get larger than this, as on a disk that is full then."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))


class Outputs(unittest.TestCase):
    def setUp(self):
        self.folder_ = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder_.cleanup)
        self.folder = pathlib.Path(self.folder_.name)

    def start(self, *arguments, **how):
        process = subprocess.Popen([ARMJIG, *arguments],
                                   **({"stdout": subprocess.PIPE, "stderr": subprocess.PIPE,
                                       "stdin": subprocess.PIPE, "text": True} | how))
        for stream in (process.stdin, process.stdout, process.stderr):
            if stream is not None:
                self.addCleanup(stream.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def emulator(self):
        """A board on a pseudo-terminal, and where."""
        process = self.start("emulate", "parol6")
        return process.stdout.readline().split()[1]

    def await_handler(self, process, number):
        """Until the program takes the signal."""
        for _ in range(PATIENCE * 100):
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            caught = next(line for line in status.splitlines() if line.startswith("SigCgt:"))
            if int(caught.split()[1], 16) >> (number - 1) & 1:
                return
            time.sleep(0.01)
        self.fail("it never took the signal")

    def assert_refused(self, arguments, code, *words):
        ended = run(arguments)
        self.assertEqual(ended.returncode, code, ended.stderr)
        self.assertEqual(ended.stdout, "", "it ran")
        self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)
        for word in words:
            self.assertIn(word, ended.stderr)

    def assert_said_once(self, ended, word):
        self.assertEqual(ended.returncode, 3, ended.stderr)
        lines = [line for line in ended.stderr.splitlines() if "cannot be written" in line]
        self.assertEqual(len(lines), 1, ended.stderr)
        self.assertIn(word, lines[0])

    # Standard output

    def test_a_full_disk_behind_standard_output(self):
        for arguments in PRINTS:
            with self.subTest(arguments), open("/dev/full", "w") as full:
                self.assert_said_once(run(arguments, stdout=full), "standard output")

    def test_a_reader_that_has_gone(self):
        for arguments in PRINTS:
            with self.subTest(arguments):
                reading, writing = os.pipe()
                os.close(reading)
                ended = run(arguments, stdout=writing)
                os.close(writing)
                self.assertEqual(ended.returncode, 141, ended.stderr)
                self.assertNotIn("written", ended.stderr)
                self.assertNotIn("internal", ended.stderr)

    def test_a_reader_that_goes_ends_what_has_no_end(self):
        process = self.start("watch", "parol6", "--target", self.emulator())
        process.stdout.readline()
        process.stdout.close()
        self.assertEqual(process.wait(PATIENCE), 141)

    def test_a_closed_standard_output(self):
        for arguments in PRINTS:
            with self.subTest(arguments):
                self.assert_said_once(run(arguments, preexec_fn=lambda: os.close(1)),
                                      "standard output")

    def test_all_standard_descriptors_closed(self):
        ended = run("devices", preexec_fn=lambda: os.closerange(0, 3))
        self.assertEqual(ended.returncode, 3)

    def test_a_full_disk_behind_standard_error(self):
        with open("/dev/full", "w") as full:
            self.assertEqual(run("decode demo", stderr=full).returncode, 2)
            self.assertEqual(run(DEMO, stderr=full).returncode, 0)

    def test_a_console_ends_when_nobody_sees_its_answers(self):
        with open("/dev/full", "w") as full:
            ended = run("console parol6 --target emulated:", stdout=full, input="status\n" * 1000)
        self.assert_said_once(ended, "standard output")

    def test_a_report_is_written_though_nobody_reads_the_lines(self):
        report = self.folder / "report.json"
        with open("/dev/full", "w") as full:
            self.assertEqual(run([*DEMO, "--json", str(report)], stdout=full).returncode, 3)
        rows = json.loads(report.read_text())["rows"]
        self.assertTrue(all(row["verdict"] == "pass" for row in rows))

    # Files

    def commands_with_files(self, path):
        script = f"{SOURCE}/harness/script/examples/joint6.rbt"
        reports = [f"--{form} {path}" for form in ("json", "html", "junit", "sarif")]
        nodes = self.folder / "nodes.toml"
        nodes.write_text("[[node]]\nid = 2\n")
        return [f"conformance demo --target emulated: {file}" for file in reports] + \
               [f"conformance mutants demo {file}" for file in reports] + \
               [f"emulate parol6 --check {file}" for file in reports[1:]] + \
               [f"lab exec --i2c {nodes} --check {file} -- echo it ran" for file in reports] + \
               [f"plan {script} --{form} {path}" for form in ("csv", "json", "html", "capture")] + \
               [f"morap simulate --type pd --pole -9 --inertia 0.2 --{form} {path}"
                for form in ("csv", "svg", "html")] + \
               [f"{command} --capture {path}"
                for command in ("conformance demo --target emulated:",
                                f"run {script} --target emulated: --home",
                                "console demo --target emulated:", "i2c scan --target emulated:",
                                "watch parol6 --target emulated: --count 5",
                                "morap read-params --target emulated:")]

    def test_a_path_that_cannot_be_written_is_refused_at_once(self):
        for command in self.commands_with_files("/no/such/folder/x"):
            with self.subTest(command):
                self.assert_refused(command, 3, "/no/such/folder/x", "cannot be written")

    def test_plots_are_refused_at_once(self):
        (self.folder / "position.svg").mkdir()
        self.assert_refused(f"run {SOURCE}/harness/script/examples/joint6.rbt --target emulated: "
                            f"--home --plots {self.folder}", 3, "position.svg")

    def test_a_full_disk(self):
        old = self.folder / "old"
        for command in self.commands_with_files(old):
            is_growing = "--capture" in command and not command.startswith("plan")
            if command.startswith("emulate") or is_growing:
                continue
            with self.subTest(command):
                old.write_text("a good old report")
                ended = run(command, preexec_fn=limited)
                is_small = ended.returncode in (0, 4) and old.stat().st_size < 3000
                if not is_small:
                    self.assert_said_once(ended, str(old))
                    self.assertEqual(old.read_text(), "a good old report")
                self.assertEqual({one.name for one in self.folder.iterdir()}, {"old", "nodes.toml"})

    def test_a_full_disk_cuts_a_recording_at_a_line(self):
        log = self.folder / "log"
        for command in self.commands_with_files(log):
            if "--capture" not in command or command.startswith(("console", "i2c", "morap", "plan")):
                continue
            with self.subTest(command):
                self.assert_said_once(run(command, preexec_fn=limited), f"--capture {log}")
                lines = log.read_text().splitlines()
                self.assertGreater(len(lines), 1)
                for line in lines:
                    json.loads(line)

    def test_every_file_is_tried_though_one_fails(self):
        good = self.folder / "good.json"
        ended = run([*DEMO, "--json", str(good), "--html", "/dev/full"])
        self.assert_said_once(ended, "--html /dev/full")
        self.assertEqual(json.loads(good.read_text())["schema"], "armjig.report/1")

    def test_findings_do_not_hide_that_their_report_is_lost(self):
        ended = run("conformance parol6 --target emulated:?fault=zero:speed.j1 --tier quick "
                    "--filter telemetry --json /dev/full")
        self.assert_said_once(ended, "--json /dev/full")

    def test_two_outputs_to_one_place_are_refused(self):
        (self.folder / "link").symlink_to("x")
        for first, second in [("x", "x"), ("x", "./x"), ("x", "link"), ("-", "-"),
                              ("-", "/dev/stdout"), ("/dev/fd/1", "/proc/self/fd/1")]:
            with self.subTest(f"{first} {second}"):
                paths = [path if path[0] in "-/" else f"{self.folder}/{path}"
                         for path in (first, second)]
                self.assert_refused(f"conformance demo --target emulated: --json {paths[0]} "
                                    f"--html {paths[1]}", 2, "--html", "goes there already")
                self.assert_refused(f"conformance demo --target emulated: --json {paths[0]} "
                                    f"--capture {paths[1]}", 2, "goes there already")
        self.assertEqual(run([*DEMO, "--json", "/dev/null", "--html", "/dev/null"]).returncode, 0)

    def test_a_file_that_standard_output_goes_to_is_refused(self):
        path = self.folder / "x"
        with open(path, "w") as out:
            self.assertEqual(run([*DEMO, "--json", str(path)], stdout=out).returncode, 2)

    def test_printed_json_is_not_mixed_with_a_file(self):
        for command in ("watch parol6 --target emulated: --count 5 --json --capture -",
                        f"run {SOURCE}/harness/script/examples/joint6.rbt --target emulated: --json "
                        "--capture -", "emulate parol6 --check --json --html -"):
            with self.subTest(command):
                self.assert_refused(command, 2, "goes there already")

    def test_a_dash_is_standard_output(self):
        for command in self.commands_with_files("-"):
            if command.startswith(("emulate", "lab")):
                continue
            with self.subTest(command):
                ended = run(command)
                self.assertIn(ended.returncode, (0, 4), ended.stderr)
                self.assertFalse(pathlib.Path("-").exists())
                self.assertNotEqual(ended.stdout, "")
                if "--json -" in command:
                    json.loads(ended.stdout)
                elif "--capture" in command:
                    self.assertIn("golden-trace/1", ended.stdout)
                    for line in ended.stdout.splitlines():
                        json.loads(line)
                elif "--html" in command:
                    self.assertTrue(ended.stdout.lower().startswith("<!doctype html>"))

    def test_a_dash_is_refused_where_the_output_is_a_programs(self):
        nodes = self.folder / "nodes.toml"
        nodes.write_text("[[node]]\nid = 2\n")
        self.assert_refused(f"lab exec --i2c {nodes} --check --json - -- echo it ran", 2, "PROGRAM")

    def test_links_and_devices_stay(self):
        target, link = self.folder / "target", self.folder / "link"
        link.symlink_to("target")
        target.write_text("old")
        self.assertEqual(run([*DEMO, "--json", str(link)]).returncode, 0)
        self.assertTrue(link.is_symlink())
        self.assertEqual(json.loads(target.read_text())["schema"], "armjig.report/1")
        self.assertEqual(run([*DEMO, "--json", "/dev/null"]).returncode, 0)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())

    def test_a_fifo_is_read_by_whoever_waits(self):
        fifo = self.folder / "fifo"
        os.mkfifo(fifo)
        process = self.start(*DEMO, "--json", str(fifo), stdout=subprocess.DEVNULL)
        self.assertEqual(json.loads(fifo.read_text())["schema"], "armjig.report/1")
        self.assertEqual(process.wait(PATIENCE), 0)
        self.assertTrue(fifo.is_fifo())

    def test_a_program_in_the_lab_has_its_broken_pipes_as_ever(self):
        nodes = self.folder / "nodes.toml"
        nodes.write_text("[[node]]\nid = 2\n")
        ended = run(["lab", "exec", "--i2c", str(nodes), "--", "sh", "-c", "yes | head -1"])
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "y\n", ""))

    # Signals

    def test_an_interrupted_run_leaves_its_report(self):
        report = self.folder / "report.json"
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                process = self.start(*LONG, "--json", str(report))
                process.stdout.readline()
                process.send_signal(number)
                out, _ = process.communicate(timeout=PATIENCE)
                self.assertEqual(process.returncode, 128 + number)
                self.assertRegex(out, r"skipped: \d+ the run was interrupted")
                rows = json.loads(report.read_text())["rows"]
                self.assertEqual(rows[0]["verdict"], "pass")
                self.assertEqual(rows[-1]["verdict"], "skipped")
                self.assertEqual(rows[-1]["actual"], "the run was interrupted")
                self.assertGreater(len(rows), 200, "cases that were not judged are named")

    def test_an_interrupted_case_on_a_real_link_ends_at_once(self):
        report = self.folder / "report.json"
        process = self.start("conformance", "parol6", "--target", self.emulator(), "--allow", "all",
                             "--filter", "home", "--capture", "-", "--json", str(report),
                             stderr=subprocess.DEVNULL)
        for line in process.stdout:
            if "(home)" in line:
                break
        process.send_signal(signal.SIGINT)
        begin = time.monotonic()
        process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 130)
        self.assertLess(time.monotonic() - begin, 10, "homing takes longer")
        verdicts = {row["verdict"] for row in json.loads(report.read_text())["rows"]}
        self.assertIn("skipped", verdicts)
        self.assertFalse(verdicts & {"fail", "error"})

    def test_interrupted_mutants_leave_their_report(self):
        report = self.folder / "report.json"
        process = self.start("conformance", "mutants", "parol6", "--json", str(report), "--threads",
                             "1")
        self.await_handler(process, signal.SIGTERM)
        process.send_signal(signal.SIGTERM)
        out, _ = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 143)
        self.assertRegex(out, r"interrupted: \d+ mutants were not tried")
        rows = json.loads(report.read_text())["rows"]
        self.assertEqual(rows[-1]["actual"], "the run was interrupted")
        self.assertFalse([row for row in rows if row["verdict"] == "fail"])

    def test_an_interrupted_console_says_so(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                process = self.start("console", "parol6", "--target", "emulated:")
                process.stdin.write("status\n")
                process.stdin.flush()
                process.stdout.readline()
                process.send_signal(number)
                _, errors = process.communicate(timeout=PATIENCE)
                self.assertEqual(process.returncode, 128 + number)
                self.assertIn("interrupted", errors)

    def test_an_interrupted_program_of_an_arm_stands(self):
        process = self.start("run", f"{SOURCE}/harness/script/examples/joint6.rbt", "--home",
                             "--target", self.emulator(), "--allow", "all")
        self.await_handler(process, signal.SIGTERM)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 143, errors)
        self.assertIn("the arm stands", errors)

    def test_a_program_in_the_lab_that_is_ended_is_judged(self):
        nodes, report = self.folder / "nodes.toml", self.folder / "report.json"
        nodes.write_text("[[node]]\nid = 2\n")
        process = self.start("lab", "exec", "--i2c", str(nodes), "--check", "--json", str(report),
                             "--", "sh", "-c", "echo began; exec sleep 100")
        process.stdout.readline()
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 143)
        self.assertEqual(json.loads(report.read_text())["schema"], "armjig.report/1")


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
