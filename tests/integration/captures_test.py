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

    def test_diff_finds_both_formats_equal_and_names_what_is_missing(self):
        for name in RECORDINGS:
            with self.subTest(name):
                lines = SOURCE / "captures" / f"{name}.jsonl"
                self.assertEqual(self.ok(ARMJIG, "diff", lines, self.packets_of(name)), "equal\n")
        lines = SOURCE / "captures/kinovazed/session-startup.jsonl"
        kept = lines.read_text().splitlines(keepends=True)
        part, page = self.folder / "part.jsonl", self.folder / "diff.html"
        part.write_text("".join(kept[:-1]))
        lost = json.loads(kept[-1])
        code, output, errors = run(ARMJIG, "diff", str(lines), str(part), "--json",
                                   "--html", str(page))
        self.assertEqual((code, errors), (1, []))
        found = json.loads(output)
        self.assertEqual((found["schema"], found["equal"]), ("armjig.diff/1", False))
        [difference] = found["differences"]
        self.assertEqual(difference["change"], "missing")
        self.assertEqual(difference["before"]["t_us"], lost["t_ms"] * 1000)
        self.assertIn("Side by side", page.read_text())

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
        code, _, errors = run(ARMJIG, "trace", "cut", str(text), str(out), "--from", "5")
        self.assertEqual(code, 4)
        self.assertIn("it has no record that was asked for", errors[0])

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

    def session_of(self, path):
        """Of a session of another program: direction and bytes of each message."""
        code, output, errors = run(ARMJIG, "decode", "kinovazed", "--json", "--file", str(path))
        self.assertEqual(code, 1, errors)  # the client says a word that nobody knows
        messages = [json.loads(line) for line in output.splitlines()]
        return [(one["direction"], bytes.fromhex(one["hex"])) for one in messages], errors

    def test_sessions_of_other_programs_are_read(self):
        folder = SOURCE / "tests/data/captures"
        whole = folder / "kinovazed-lo.pcap"
        made = {"pcapng": self.folder / "a.pcapng", "nsecpcap": self.folder / "a.pcap",
                "modpcap": self.folder / "b.pcap"}
        for form, path in made.items():
            self.ok("editcap", "-F", form, whole, path)
        odd, even = self.folder / "odd.pcap", self.folder / "even.pcapng"
        self.ok("editcap", "-r", whole, odd, *range(1, 25, 2))
        self.ok("editcap", "-r", "-F", "pcapng", whole, even, *range(2, 25, 2))
        both, swapped = self.folder / "both.pcapng", self.folder / "swapped.pcapng"
        self.ok("mergecap", "-w", both, odd, even)
        pieces = []
        for numbers in ("1-7", "11", "8-10", "12-15", "18", "16-17", "19-24"):
            pieces.append(self.folder / f"{numbers}.pcap")
            self.ok("editcap", "-r", whole, pieces[-1], numbers)
        self.ok("mergecap", "-a", "-w", swapped, *pieces)
        messages, _ = self.session_of(whole)
        self.assertEqual(b"".join(raw for to, raw in messages if to == "to_device"),
                         b"QuitEStop\r\nEStop\r\nQuitEStop\r\nBogus\r\nEStop\r\n")
        for path in (*made.values(), both, folder / "kinovazed-lo-and-any.pcapng"):
            with self.subTest(path.name):
                found, errors = self.session_of(path)
                self.assertEqual(found, messages)
                self.assertEqual(errors, [])
        with self.subTest("out of order"):
            for direction in ("to_device", "from_device"):
                self.assertEqual([one for one in self.session_of(swapped)[0] if one[0] == direction],
                                 [one for one in messages if one[0] == direction])
        text = self.folder / "a.jsonl"
        self.ok(ARMJIG, "trace", "convert", whole, text)
        self.assertEqual(self.session_of(text)[0], messages)

    def test_what_is_missing_in_a_session_of_another_program_is_told(self):
        whole, part = SOURCE / "tests/data/captures/kinovazed-lo.pcap", self.folder / "part.pcap"
        self.ok("editcap", whole, part, "11")  # the second QuitEStop, which was answered
        messages, errors = self.session_of(part)
        self.assertEqual([raw for to, raw in messages if to == "to_device"],
                         [b"QuitEStop\r\n", b"EStop\r\n", b"Bogus\r\n", b"EStop\r\n"])
        self.assertEqual(errors, [f"armjig: {part}: 11 bytes of TCP were not captured; "
                                  "records that follow a gap say so"])
        text = self.folder / "part.jsonl"
        run(ARMJIG, "trace", "convert", str(part), str(text))
        self.assertEqual([line["lost"] for line in lines_of(text) if "lost" in line], [11])

    def test_an_interface_that_is_not_there_is_refused_with_those_that_are(self):
        code, _, errors = run(ARMJIG, "decode", "kinovazed", "--interface", "no-such-one")
        self.assertEqual(code, 3)
        self.assertIn("no-such-one", errors[0])

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
                if words.startswith("plan"):  # of what would be sent; no device is there
                    continue
                for path in (packets, text):
                    self.assertIn("identical: 1", self.ok(ARMJIG, "trace", "verify", path))

    def test_a_recording_of_real_time_is_verified_to_the_byte(self):
        for name in ("x.pcapng", "x.jsonl"):
            path = self.folder / name
            process, place = self.start("emulate", "parol6", "--set", "pass-us=37", "--capture",
                                        path)
            self.ask(place, 20)
            process.send_signal(signal.SIGINT)
            process.wait(PATIENCE)
            self.assertIn("identical: 1", self.ok(ARMJIG, "trace", "verify", path))

    def verdict_on(self, lines):
        path = self.folder / "changed.jsonl"
        path.write_text("".join(json.dumps(line) + "\n" for line in lines))
        code, output, errors = run(ARMJIG, "trace", "verify", str(path))
        return code, output + "".join(errors)

    def test_what_an_emulated_device_did_not_do_is_found(self):
        path = self.folder / "x.jsonl"
        for device, exchange in (("parol6", "jog.speed"), ("kinovazed", "freeze"),
                                 ("morap", "position")):
            self.ok(ARMJIG, "conformance", device, "--target", "emulated:", "--filter", exchange,
                    "--require", "0", "--capture", path)
            lines = lines_of(path)
            self.assertEqual(self.verdict_on(lines)[0], 0, device)
            said = [i for i, line in enumerate(lines)
                    if line.get("dir") == "from_device" or line.get("op") == "read"]
            for i in (said[0], said[len(said) // 2], said[-1]):
                changed = json.loads(json.dumps(lines))
                number = int(changed[i]["hex"], 16) ^ 1
                changed[i]["hex"] = f"{number:0{len(changed[i]['hex'])}x}"
                code, told = self.verdict_on(changed)
                self.assertEqual(code, 1, told)
                self.assertIn(f":{i + 1}: differs", told)
            late = dict(lines[1], since_us=0, text="armjig was late itself")
            late["op" if "op" in late else "dir"] = "overlooked"
            self.assertEqual(self.verdict_on([lines[0], late, *lines[1:]])[0], 0)
            without = lines[:said[-1]] + lines[said[-1] + 1:]
            self.assertEqual(self.verdict_on(without)[0], 0, "a host need not read the last")
            early = json.loads(json.dumps(lines))
            early[said[0]]["t_us"] = early[said[0] - 1].get("t_us", 0)
            if device == "parol6":  # the answer was not there yet
                self.assertEqual(self.verdict_on(early)[0], 1)

    def test_what_cannot_be_verified_is_said(self):
        path = self.folder / "x.jsonl"
        self.ok(ARMJIG, "watch", "demo", "--target", "emulated:", "--count", "2", "--capture", path)
        header, *records = lines_of(path)
        for target, hint in ((None, "does not say what device"), ("pty:/tmp/arm", "pty:/tmp/arm"),
                             ("emulated:?no-such=1", "no-such")):
            header["target"] = target
            if target is None:
                del header["target"]
            code, told = self.verdict_on([header, *records])
            self.assertEqual(code, 2, told)
            self.assertIn(hint, told)
        header["target"] = "emulated:"
        code, told = self.verdict_on([header])
        self.assertEqual((code, "no answer is in there" in told), (2, True), told)
        code, told = self.verdict_on([header, {"t_us": 5, "dir": "connect", "conn": 0}])
        self.assertEqual((code, "not a line of" in told), (2, True), told)

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
        events = [line["dir"] for line in lines[1:] if line["dir"] != "overlooked"]  # a busy machine
        self.assertEqual(events[0], "connect")
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
