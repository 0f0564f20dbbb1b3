#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Captures and the tools that people have: captures_test.py ARMJIG SOURCE_DIR

What armjig writes, capinfos and tshark read without a warning, and what editcap and mergecap made of
it, armjig reads. Ends with 77, which CTest takes for skipped, where Wireshark's tools are not.
"""

import csv
import io
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import tty
import unittest

ARMJIG, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TOOLS = ("capinfos", "tshark", "editcap", "mergecap")
RECORDINGS = ("demo/start-and-halt", "parol6/gripper_can_burst_a", "parol6/estop_and_inputs_a",
              "morap/bus-three-nodes", "morap/static-repeated-start", "morap/pen-buttons",
              "kinovazed/connection-three", "kinovazed/session-startup",
              "kinovazed/framing-long-junk-5000")
# Said to root, whatever the file.
AS_ROOT = "Running as user"
PATIENCE = 60
IDLE = b"\xff\xff\xff\x34" + bytes(36) + b"\xff" + bytes(12) + b"\xe4\x01\x02"
ANSWER_SIZE = 60


def run(*words):
    done = subprocess.run(words, capture_output=True, check=False)
    errors = [line for line in done.stderr.decode().splitlines() if not line.startswith(AS_ROOT)]
    return done.returncode, done.stdout.decode(errors="replace"), errors


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines() if line]


class Captures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def ok(self, *words):
        code, output, errors = run(*map(str, words))
        self.assertEqual((code, errors), (0, []), words)
        return output

    def packets_of(self, name):
        path = self.folder / f"{pathlib.Path(name).name}.pcapng"
        self.ok(ARMJIG, "trace", "convert", SOURCE / "captures" / f"{name}.jsonl", path)
        return path

    def back(self, path):
        text = path.with_suffix(".back.jsonl")
        self.ok(ARMJIG, "trace", "convert", path, text)
        return lines_of(text)

    def test_wireshark_reads_each_recording_without_a_warning(self):
        for name in RECORDINGS:
            with self.subTest(name):
                path = self.packets_of(name)
                self.assertIn("nanoseconds", self.ok("capinfos", path))
                shown = self.ok("tshark", "-r", path, "-T", "fields", "-e", "frame.number",
                                "-e", "_ws.malformed", "-e", "frame.interface_name")
                self.assertTrue(shown)
                for line in shown.splitlines():
                    number, malformed, interface = line.split("\t")
                    self.assertEqual(malformed, "", number)
                    self.assertTrue(interface)

    def test_wireshark_shows_what_was_recorded(self):
        path = self.packets_of("demo/start-and-halt")
        shown = self.ok("tshark", "-r", path, "-T", "fields", "-e", "frame.time_epoch",
                        "-e", "frame.packet_flags_direction", "-e", "exported_pdu.prot_name",
                        "-e", "exported_pdu.exported_pdu")
        time, direction, dissector, _ = shown.splitlines()[0].split("\t")
        self.assertEqual((float(time), int(direction, 0), dissector), (0.01, 2, "demo"))
        bus = self.packets_of("morap/bus-three-nodes")
        first = next(line for line in lines_of(SOURCE / "captures/morap/bus-three-nodes.jsonl")
                     if line.get("op") == "write")
        shown = self.ok("tshark", "-r", bus, "-Y", "i2c", "-T", "fields", "-e", "i2c.addr")
        self.assertEqual(int(shown.splitlines()[0], 0) & 0x7F, first["addr"])

    def test_editcap_and_mergecap_lose_nothing(self):
        demo, arm = self.packets_of("demo/start-and-halt"), self.packets_of(RECORDINGS[1])
        edited = self.folder / "edited.pcapng"
        self.ok("editcap", demo, edited)
        self.assertEqual(self.back(edited), self.back(demo))
        merged = self.folder / "merged.pcapng"  # of three link types
        self.ok("mergecap", "-w", merged, demo, arm)
        lines = self.back(merged)
        # Its header is mergecap's, and its first packet came at 5 ms.
        for path in (demo, arm):
            for line in self.back(path)[1:]:
                found = [other for other in lines[1:]
                         if all(other.get(key) == line.get(key)
                                for key in ("dir", "hex", "name", "value", "id"))]
                self.assertTrue(found, line)
        self.assertEqual(len(lines) - 1, len(self.back(demo)) + len(self.back(arm)) - 2)

    def test_commands_take_both_formats(self):
        path = self.packets_of("kinovazed/connection-three")
        self.ok(ARMJIG, "trace", "verify", path)
        self.ok(ARMJIG, "decode", "kinovazed", "--file", path)
        shown = self.ok(ARMJIG, "trace", "show", path)
        self.assertIn("3 conversations", shown)
        self.assertIn("round trips", shown)
        summary = json.loads(self.ok(ARMJIG, "trace", "show", path, "--json"))
        self.assertEqual(summary["schema"], "armjig.session/1")
        one = self.folder / "one.pcapng"
        self.ok(ARMJIG, "trace", "cut", path, one, "--connection", "1")
        connections = {line["conn"] for line in self.back(one)[1:] if line["dir"].endswith("device")}
        self.assertEqual(connections, {1})
        both = self.folder / "both.pcapng"
        self.ok(ARMJIG, "trace", "merge", "--out", both, path, self.packets_of(RECORDINGS[0]), path)
        self.ok("capinfos", both)
        self.assertEqual({line.get("link", "kinovazed") for line in self.back(both)[1:]},
                         {"kinovazed", "demo", "kinovazed#3"})

    def decoded(self, *words):
        """The lines of `decode --json`, and the rows of `decode --csv`."""
        lines = [json.loads(line) for line in self.ok(ARMJIG, "decode", *words, "--json").splitlines()]
        text = self.ok(ARMJIG, "decode", *words, "--csv")
        return lines, list(csv.DictReader(io.StringIO(text)))

    def test_a_table_has_what_the_json_has(self):
        path = self.packets_of("parol6/outputs_sweep_a")
        lines, rows = self.decoded("parol6", "--file", path)
        self.assertEqual(len(rows), len(lines))
        self.assertGreater(len(rows), 20)
        flags = 0
        for line, row in zip(lines, rows):
            self.assertEqual(row["message"], line["message"])
            self.assertAlmostEqual(float(row["time_s"]) * 1e6, line["t_us"], delta=1)
            self.assertEqual(row["direction"], line["direction"])
            for name, field in line["fields"].items():
                if name in row:  # all but what is the same in every message
                    self.assertEqual(int(row[name]), field["value"])
                for flag in [column for column in row if column.startswith(f"{name}.")]:
                    flags += 1
                    is_set = flag.removeprefix(f"{name}.") in field["text"].split()
                    self.assertEqual(row[flag], str(int(is_set)), (flag, field))
        self.assertGreater(flags, 100)
        self.assertTrue(all(None not in row and None not in row.values() for row in rows))

    def test_filters_keep_what_they_name(self):
        path = self.packets_of("parol6/outputs_sweep_a")
        everything, _ = self.decoded("parol6", "--file", path)
        half = everything[len(everything) // 2]["t_us"]
        for words, keeps in (
                (("--field", "io.out1=1"), lambda one: "out1" in one["fields"]["io"]["text"].split()
                 if "io" in one["fields"] else False),
                (("--field", "command=idle"),
                 lambda one: one["fields"].get("command", {}).get("value") == 255),
                (("--direction", "from-device"), lambda one: one["direction"] == "from_device"),
                (("--from", f"{half / 1e6:.6f}"), lambda one: one["t_us"] >= half),
                (("--to", f"{half / 1e6:.6f}"), lambda one: one["t_us"] <= half)):
            with self.subTest(words):
                lines, _ = self.decoded("parol6", "--file", path, *words)
                self.assertEqual(lines, [one for one in everything if keeps(one)])
                self.assertTrue(0 < len(lines) < len(everything))
        three = self.packets_of("kinovazed/connection-three")
        lines, _ = self.decoded("kinovazed", "--file", three, "--connection", "1")
        alone = self.folder / "one.pcapng"
        self.ok(ARMJIG, "trace", "cut", three, alone, "--connection", "1")
        self.assertEqual(lines, self.decoded("kinovazed", "--file", alone)[0])
        bus = str(SOURCE / "captures/morap/loop-voltage.jsonl")
        lines, _ = self.decoded("morap", "--file", bus)
        self.assertEqual(self.decoded("morap", "--file", bus, "--address", "0x11")[0], lines)
        code, shown, _ = run(ARMJIG, "decode", "morap", "--file", bus, "--address", "0x12")
        self.assertEqual((code, shown), (4, ""))

    def test_a_recording_of_several_devices_is_decoded_by_device(self):
        demo, arm = self.packets_of("demo/start-and-halt"), self.packets_of("parol6/outputs_sweep_a")
        both = self.folder / "both.pcapng"
        self.ok(ARMJIG, "trace", "merge", "--out", both, demo, arm)
        code, _, _ = run(ARMJIG, "decode", "parol6", "--file", str(both))
        self.assertEqual(code, 0, "nothing of the other device was taken for noise")

    def test_a_part_in_time_and_metadata_that_is_taken_away(self):
        text = self.folder / "in.jsonl"
        text.write_text('{"format":"golden-trace/1","device":"demo","target":"tcp:lab:1"}\n'
                        '{"t_us":1000000,"dir":"to_device","hex":"a5718e"}\n'
                        '{"t_us":3000000,"dir":"to_device","hex":"a5718e"}\n')
        out = self.folder / "out.pcapng"
        self.ok(ARMJIG, "trace", "cut", text, out, "--to", "2", "--redact")
        self.assertEqual(self.back(out), [{"format": "golden-trace/1", "device": "demo"},
                                          {"t_us": 1000000, "dir": "to_device", "hex": "a5718e"}])

    # Of sessions

    def start(self, *words, **how):
        """A program that says where it listens; the process, and where."""
        process = subprocess.Popen([ARMJIG, *map(str, words)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, **how)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process, process.stdout.readline().split()[1]

    @staticmethod
    def ask(place, count):
        """Idles to a board on a pseudo-terminal, each answered. What it answered."""
        port = os.open(place.removeprefix("pty:"), os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port)
        answers = b""
        for number in range(count):
            os.write(port, IDLE)
            while len(answers) < (number + 1) * ANSWER_SIZE:
                answers += os.read(port, 4096)
        os.close(port)
        return answers

    @staticmethod
    def bytes_of(lines, direction):
        return b"".join(bytes.fromhex(line["hex"]) for line in lines
                        if line.get("dir") == direction)

    def test_every_command_with_a_wire_records_in_both_formats(self):
        script = f"{SOURCE}/harness/script/examples/joint6.rbt"
        nodes = self.folder / "nodes.toml"
        nodes.write_text("[[node]]\nid = 2\n")
        for words in ("watch parol6 --target emulated: --count 5",
                      "conformance demo --target emulated: --filter query",
                      "conformance kinovazed --target emulated: --filter connection",
                      "latency demo --target emulated: --count 10",
                      f"run {script} --target emulated: --home", f"plan {script}",
                      f"lab exec --i2c {nodes} -- i2ctransfer -y 1 r1@0x12",
                      "morap read-params --target emulated:",
                      "i2c scan --target emulated:"):
            with self.subTest(words):
                packets, text = self.folder / "x.pcapng", self.folder / "x.jsonl"
                for path in (packets, text):
                    command, dashes, program = words.partition(" -- ")
                    run(ARMJIG, *command.split(), "--capture", str(path),
                        *(dashes + program).split())
                self.ok("capinfos", packets)
                counts = [[re.sub(r"^.*?: ", "", line)
                           for line in self.ok(ARMJIG, "trace", "info", path).splitlines()
                           if line.startswith("link ")] for path in (packets, text)]
                self.assertEqual(counts[0], counts[1])
                self.assertTrue(counts[0])
                self.ok(ARMJIG, "trace", "convert", packets, self.folder / "y.jsonl")

    def test_a_killed_emulator_leaves_all_that_passed(self):
        for name in ("x.pcapng", "x.jsonl"):
            with self.subTest(name):
                path = self.folder / name
                process, place = self.start("emulate", "parol6", "--capture", path)
                answers = self.ask(place, 20)
                process.send_signal(signal.SIGKILL)
                process.wait(PATIENCE)
                self.ok(ARMJIG, "trace", "info", path)
                lines = lines_of(path) if name.endswith("jsonl") else self.back(path)
                self.assertEqual(self.bytes_of(lines, "to_device"), 20 * IDLE)
                self.assertEqual(self.bytes_of(lines, "from_device"), answers)
                age = time.time() - lines[0]["epoch_ns"] / 1e9
                self.assertTrue(0 <= age < 600, age)

    def test_a_file_is_readable_wherever_a_program_died(self):
        path = self.folder / "x.pcapng"
        process, place = self.start("emulate", "parol6", "--capture", path)
        self.ask(place, 3)
        process.send_signal(signal.SIGTERM)
        process.wait(PATIENCE)
        whole, cut = path.read_bytes(), self.folder / "cut.pcapng"
        records = []
        for size in range(200, len(whole) + 1, 7):
            cut.write_bytes(whole[:size])
            code, output, _ = run(ARMJIG, "trace", "info", str(cut))
            if code != 0:  # within the header
                self.assertEqual(records, [])
                continue
            found = re.search(r"(\d+) records", output)
            records.append(int(found.group(1)) if found else 0)
        self.assertEqual(records, sorted(records))
        self.assertGreaterEqual(records[-1], 5)

    def test_connections_of_an_emulated_server(self):
        path = self.folder / "x.pcapng"
        process, place = self.start("emulate", "kinovazed", "--tcp", "0", "--set", "profile=firmware",
                                    "--capture", path)
        host, port = place.removeprefix("tcp:").rsplit(":", 1)
        with socket.create_connection((host, int(port)), timeout=PATIENCE) as client:
            client.sendall(b"QuitEStop\r\n")
            self.assertTrue(client.recv(4096))
        process.send_signal(signal.SIGTERM)
        process.wait(PATIENCE)
        lines = self.back(path)
        self.assertEqual(lines[0]["target"], "emulated:?profile=firmware")
        self.assertEqual(lines[1]["dir"], "connect")
        self.assertEqual(self.bytes_of(lines, "to_device"), b"QuitEStop\r\n")
        self.assertIn("1 conversations", self.ok(ARMJIG, "trace", "show", path))
        self.ok("tshark", "-r", path)

    def test_files_rotate(self):
        path = self.folder / "x.pcapng"
        self.ok(ARMJIG, "watch", "parol6", "--target", "emulated:", "--count", "500", "--capture",
                path, "--rotate", "20kB,3")
        files = sorted(file.name for file in self.folder.iterdir())
        self.assertEqual(files, ["x.1.pcapng", "x.2.pcapng", "x.pcapng"])
        last = 0.0
        for name in reversed(files[:2]):
            self.assertLessEqual((self.folder / name).stat().st_size, 20_000)
        for name in ("x.2.pcapng", "x.1.pcapng", "x.pcapng"):
            lines = self.back(self.folder / name)
            self.assertGreater(lines[1]["t_us"], last)
            last = lines[-1]["t_us"]
        for words in ("--capture - --rotate 20kB,3", "--rotate 20kB,3", "--redact",
                      f"--capture {path} --rotate 20kB", f"--capture {path} --rotate 1B,3",
                      f"--capture {path} --rotate 20kB,0", f"--capture {path}.pcap"):
            with self.subTest(words):
                code, _, errors = run(ARMJIG, "watch", "demo", "--target", "emulated:", "--count",
                                      "1", *words.split())
                self.assertEqual((code, len(errors)), (2, 1), errors)

    def test_nothing_is_said_of_a_target_that_is_redacted(self):
        path = self.folder / "x.pcapng"
        self.ok(ARMJIG, "watch", "parol6", "--target", "emulated:?pass-us=20", "--count", "2",
                "--capture", path, "--redact")
        self.assertNotIn(b"pass-us=20", path.read_bytes())
        self.assertEqual(set(self.back(path)[0]), {"format", "device", "title", "source"})

    # Of files

    def test_a_cut_file_is_read_with_a_warning_and_a_damaged_one_with_a_problem(self):
        path = self.packets_of("demo/start-and-halt")
        whole = path.read_bytes()
        path.write_bytes(whole[:-1])
        code, output, errors = run(ARMJIG, "trace", "info", str(path))
        self.assertEqual(code, 0)
        self.assertIn("17 records", output)
        self.assertEqual(len(errors), 1)
        self.assertIn("ends within a block", errors[0])
        path.write_bytes(whole[:-4] + b"\xff\xff\xff\xff")
        code, output, errors = run(ARMJIG, "trace", "convert", str(path),
                                   str(self.folder / "out.jsonl"))
        self.assertEqual(code, 2)
        self.assertEqual(len(errors), 1)
        self.assertIn("its two lengths differ", errors[0])
        self.assertEqual(len(lines_of(self.folder / "out.jsonl")), 18)

    def test_a_file_is_not_written_onto_itself(self):
        path = self.packets_of("demo/start-and-halt")
        before = path.read_bytes()
        code, _, errors = run(ARMJIG, "trace", "convert", str(path), str(path))
        self.assertEqual((code, len(errors)), (2, 1))
        self.assertEqual(path.read_bytes(), before)


if __name__ == "__main__":
    if not all(map(shutil.which, TOOLS)):
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
