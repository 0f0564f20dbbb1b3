#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The dissectors for Wireshark against decode, message by message: wireshark_test.py
ARMJIG SOURCE_DIR

tshark shows each message of a recording with the values that `armjig decode --json` has. Ends with 77,
which CTest takes for skipped, where tshark is not.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from xml.etree import ElementTree

ARMJIG, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
RECORDINGS = ("demo/start-and-halt", "parol6/gripper_can_burst_a", "parol6/estop_and_inputs_a",
              "kinovazed/session-startup", "kinovazed/connection-three",
              "kinovazed/framing-boundary-alone", "kinovazed/framing-blank-and-colon",
              "kinovazed/framing-arg-count", "kinovazed/framing-byte-by-byte",
              "kinovazed/framing-long-junk-5000", "kinovazed/framing-long-padded-1152",
              "kinovazed/framing-nul", "kinovazed/joystick-numbers-bad",
              "kinovazed/joystick-numbers-tail", "morap/static-status-transitions", "morap/bus-scan",
              "morap/bus-three-nodes", "morap/bus-closed-loop", "morap/bus-nodes-and-pen",
              "morap/pen-random", "morap/pen-unknown-command", "morap/static-overlong-writes",
              "morap/static-overread", "morap/static-partial-writes",
              "morap/static-program-checksum", "morap/static-program-limits",
              "morap/static-program-sizes", "morap/static-program-truncated",
              "morap/static-read-wrap", "morap/static-tune-partial", "morap/static-unknown-ids")
START = b"\xff\xff\xff\x34"
COMMAND = (START + bytes(range(1, 37)) + b"\xff\x81\x10\x07\x80\x01\x00\xff\x7f\xff\x90\x02\x06"
           b"\xe4\x01\x02")


PATIENCE = 60
CLIENT, SERVER = (b"\x7f\0\0\1", 40000), (b"\x7f\0\0\1", 51717)
SYN, SYN_ACK, ACK = 2, 18, 16
ETHERNET, USB_SHORT, USB_LONG, I2C = 1, 189, 220, 209


def segment(sender, receiver, sequence, flags, payload=b""):
    """A frame of Ethernet with a segment of TCP."""
    tcp = struct.pack(">HHIIBBHHH", sender[1], receiver[1], sequence, 1000, 0x50, flags, 65535, 0, 0)
    packet = struct.pack(">BBHHHBBH", 0x45, 0, 40 + len(payload), 1, 0, 64, 6, 0)
    return bytes(12) + b"\x08\x00" + packet + sender[0] + receiver[0] + tcp + payload


def tcp_session(pieces):
    """A connection, in which the client says the pieces."""
    packets = [segment(CLIENT, SERVER, 999, SYN), segment(SERVER, CLIENT, 999, SYN_ACK),
               segment(CLIENT, SERVER, 1000, ACK)]
    sequence = 1000
    for piece in pieces:
        packets.append(segment(CLIENT, SERVER, sequence, ACK, piece))
        sequence += len(piece)
    return packets


def usb_events(pieces, header, kind=3, is_in=False):
    """Bulk transfers to, or from, device 4 of bus 1: each submitted, then complete."""
    packets = []
    for number, piece in enumerate(pieces):
        for step, data in ((b"S", b"" if is_in else piece), (b"C", piece if is_in else b"")):
            event = struct.pack("<Q1sBBBHBBqiiII8s", number, step, kind, 0x81 if is_in else 1, 4, 1,
                                ord("-"), 0 if data else ord("<" if is_in else ">"), 1, 0, 0,
                                len(piece), len(data), b"")
            packets.append(event + bytes(header - len(event)) + data)
    return packets


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, check=False)


class Wireshark(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        done = run(ARMJIG, "wireshark", "install", "--to", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        written = [pathlib.Path(line) for line in done.stdout.decode().splitlines()]
        self.scripts = [path for path in written if path.suffix == ".lua"]

    def run_tshark(self, *words):
        scripts = [word for script in self.scripts for word in ("-X", f"lua_script:{script}")]
        return run("tshark", *scripts, *words)

    def tshark(self, path, *words):
        done = self.run_tshark("-r", path, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn(b"Lua", done.stderr)
        self.assertNotIn(b"Lua Error", done.stdout)
        return done.stdout

    def compare(self, path, device, *words, can_miss_rest=False):
        done = run(ARMJIG, "decode", device, "--file", path, "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        decoded = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertTrue(decoded)
        found = self.messages_of(path, device, *words)
        # Noise that comes in several packets is one for decode and several for tshark.
        joined = []
        for name, direction, fault, values in found:
            same = [one for one in joined if one[1] == direction][-1:]
            if same and same[0][0] == "rest":  # its message is shown in the packet that ends it
                joined.remove(same[0])
                same = [one for one in joined if one[1] == direction][-1:]
            if device != "morap" and name == "noise" and same and same[0][0] == "noise":
                same[0][3]["noise"] += values["noise"]
            else:
                joined.append([name, direction, fault, values])
        for direction in ("to_device", "from_device"):
            theirs = [one for one in joined if one[1] == direction]
            if theirs and theirs[-1][0] == "rest":  # nothing came that ends it
                rest = theirs.pop()
                if theirs and theirs[-1][0] == "noise":
                    theirs[-1][3]["noise"] += rest[3]["noise"]
                else:
                    theirs.append(["noise", *rest[1:]])
                if device == "kinovazed":
                    theirs[-1] = ["rest", direction, "a line without an end", rest[3]]
            ours = [one for one in decoded if one["direction"] == direction]
            if can_miss_rest and ours and ours[-1]["message"] == "rest":
                ours.pop()
            self.assertEqual([one[0] for one in theirs], [one["message"] for one in ours])
            for their, our in zip(theirs, ours):
                if "fault" in our:
                    self.assertEqual(their[3]["noise"], our["hex"].replace(" ", "").lower())
                    if device in ("kinovazed", "morap"):
                        self.assertEqual(their[2], our["fault"])
                    continue
                wanted = {name: field["value"] for name, field in our["fields"].items()
                          if name != "message"}  # that is the kind of message
                for name, value in their[3].items():
                    if isinstance(value, float):
                        value = struct.unpack("<f", struct.pack("<I", wanted[name]))[0]
                        is_same = value == their[3][name] or abs(value / their[3][name] - 1) < 1e-5
                        wanted[name] = their[3][name] if is_same or value != value else value
                self.assertEqual(their[3], wanted)
        return decoded

    def messages_of(self, path, device, *words):
        made = run(ARMJIG, "wireshark", "dissector", device).stdout.decode()
        floats = set(re.findall(r'name = "([a-z0-9_.]+)", [^{}]*type = "float"', made))
        root = ElementTree.fromstring(self.tshark(path, *words, "-T", "pdml"))
        messages = []
        for layer in root.iter("proto"):
            if layer.get("name") != device:
                continue
            values = {}
            for field in layer.findall("field"):
                if field.get("name").startswith(device + "."):
                    values[field.get("name").removeprefix(device + ".")] = field.get("show")
            message = values.pop("message")
            direction = "from_device" if values.pop("from_device") in ("1", "True") else "to_device"
            fault = values.pop("fault", "")
            if message == "rest" or "noise" in values:
                what = "rest" if message == "rest" else "noise"
                values = {"noise": values[what].replace(":", "")}
            else:
                values = {name: int(value) if re.fullmatch("-?[0-9]+", value) and
                          name not in floats else float(value) for name, value in values.items()}
            messages.append((message, direction, fault, values))
        return messages

    def converted(self, name):
        path = self.folder / f"{pathlib.Path(name).name}.pcapng"
        done = run(ARMJIG, "trace", "convert", SOURCE / "captures" / f"{name}.jsonl", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        return path

    def recording(self, pieces):
        """A recording of what the host sent to a board, as pcapng."""
        return self.recording_of("parol6", ({"dir": "to_device", "hex": piece.hex()}
                                            for piece in pieces))

    def recording_of(self, device, events):
        text, path = self.folder / "own.jsonl", self.folder / "own.pcapng"
        lines = [{"format": "golden-trace/1", "device": device}]
        lines += [{"t_us": 1000 * number, **event} for number, event in enumerate(events)]
        text.write_text("".join(json.dumps(line) + "\n" for line in lines))
        done = run(ARMJIG, "trace", "convert", text, path)
        self.assertEqual(done.returncode, 0, done.stderr)
        return path

    def pcap(self, link, packets):
        """A recording of another program, a millisecond between two packets."""
        path = self.folder / f"foreign{link}.pcap"
        data = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 262144, link)
        for number, packet in enumerate(packets):
            data += struct.pack("<IIII", 100, 1000 * number, len(packet), len(packet)) + packet
        path.write_bytes(data)
        return path

    def test_sessions_on_the_port_of_the_server(self):
        folder = SOURCE / "tests/data/captures"
        self.assertEqual(len(self.compare(folder / "kinovazed-lo.pcap", "kinovazed")), 10)
        lines = b"QuitEStop\r\n MoveJoystick:1:-2:+3\nBogus\r\nSetJoystickMode:XYZ\r\nEStop:1\r\n\r\n"
        lines += b"RunObjective:Nowhere\r\nMoveJoystick:1:2:x\n" + 1200 * b"x" + b"\r\nFreeze\r\n"
        for size in (1, 3, 40, 1400):
            with self.subTest(size):
                pieces = [lines[i:i + size] for i in range(0, len(lines), size)]
                path = self.pcap(ETHERNET, tcp_session([*pieces, b"Unfr"]))
                self.assertEqual(len(self.compare(path, "kinovazed", can_miss_rest=True)), 12)
        with self.subTest("out of order, and sent again"):
            packets = tcp_session([lines[:7], lines[7:20], lines[20:]])
            path = self.pcap(ETHERNET, [*packets[:4], packets[5], packets[4], packets[4]])
            in_order = ("-o", "tcp.reassemble_out_of_order:TRUE")
            self.compare(path, "kinovazed", *in_order)
        shown = self.tshark(path, *in_order, "-Y", 'kinovazed.mode == "XYZ" && kinovazed.message == '
                            '"SetJoystickMode"', "-T", "fields", "-e", "_ws.col.Info")
        self.assertIn(b"MoveJoystick x=1 y=-2 z=3; line: a word that nobody knows; "
                      b"SetJoystickMode mode=XYZ", shown)

    def test_bulk_transfers_of_usb(self):
        stream = COMMAND * 4 + b"junk" + COMMAND
        for link, header in ((USB_SHORT, 48), (USB_LONG, 64)):
            for size in (7, 57, 64, 300):
                with self.subTest(link=link, size=size):
                    # Before the first message nobody knows whose transfers they are.
                    pieces = [COMMAND] + [stream[i:i + size] for i in range(0, len(stream), size)]
                    path = self.pcap(link, usb_events(pieces, header))
                    self.assertEqual(len(self.compare(path, "parol6")), 7)
        answers = []
        for line in (SOURCE / "captures/parol6/outputs_sweep_a.jsonl").read_text().splitlines():
            one = json.loads(line)
            if one.get("dir") == "from_device":
                answers.append(bytes.fromhex(one["hex"]))
        path = self.pcap(USB_LONG, usb_events(answers, 64, is_in=True))
        self.assertGreater(len(self.compare(path, "parol6")), 10)
        others = usb_events([b"USBC" + bytes(27)] * 3, 64) + usb_events([COMMAND], 64, kind=1)
        path = self.pcap(USB_LONG, others)
        self.assertEqual(self.tshark(path, "-Y", "parol6"), b"")

    def test_transfers_of_i2c(self):
        pieces = [b"\x22\x80", b"\x23" + struct.pack("<f", 1.5), b"\x22\x02\0\0", b"\x22",
                  b"\x22\x83", b"\x23\x03", b"\x23\x03\x07", b"\x32\x07\x80", b"\x33\x01",
                  b"\x22\x63\x01\x02", b"\x22\x21"]
        path = self.pcap(I2C, [bytes(5) + piece for piece in pieces])
        done = run(ARMJIG, "decode", "morap", "--file", path, "--json")
        self.assertTrue(done.stdout, done.stderr)
        self.compare(path, "morap")
        shown = self.tshark(path, "-Y", "_ws.expert && morap.fault", "-T", "fields", "-e",
                            "frame.number", "-e", "morap.fault", "-e", "i2c.addr")
        self.assertEqual(len(shown.splitlines()), 4)
        self.assertIn(b"a pen has nothing to read", shown)
        event = bytes.fromhex("8000000001")
        self.assertEqual(self.tshark(self.pcap(I2C, [event]), "-Y", "morap.message"), b"")
        off = self.tshark(path, "-o", "morap.i2c:FALSE", "-Y", "morap.message")
        self.assertEqual(off, b"")

    def test_what_was_not_acknowledged_is_not_shown_as_said(self):
        def write(data, acks, address=17):
            return {"op": "write", "addr": address, "hex": data, "ack": acks}
        path = self.recording_of("morap-bus", [
            write("02", "AA"), write("020000c03f", "AAAAAA"), write("02", "N", 18),
            write("020000c03f", "AAAAAN"), write("63", "AN"), write("80", "AA"),
            {"op": "read", "addr": 17, "hex": "11", "ack": "A"},
            {"op": "read", "addr": 18, "hex": "", "ack": "N"}])
        self.assertEqual(len(self.compare(path, "morap")), 6)
        shown = self.tshark(path, "-Y", "morap.nack.expert", "-T", "fields", "-e", "frame.number",
                            "-e", "_ws.expert.message")
        self.assertEqual([line.split("\t")[1].split(",")[0] for line in shown.decode().splitlines()],
                         ["nobody acknowledged the address", "byte 4 was not acknowledged",
                          "byte 0 was not acknowledged", "nobody acknowledged the address"])

    def test_what_is_wrong_is_expert_information(self):
        for name, fault in (("kinovazed/joystick-numbers-bad", b"not a number"),
                            ("kinovazed/framing-arg-count", b"too few or too many arguments"),
                            ("morap/static-program-checksum", b"wrong checksum at byte"),
                            ("morap/static-program-limits", b"a count above four at byte"),
                            ("morap/static-partial-writes", b"is cut short")):
            with self.subTest(name):
                shown = self.tshark(self.converted(name), "-Y", "_ws.expert", "-T",
                                    "fields", "-e", "_ws.expert.message")
                self.assertIn(fault, shown)

    def test_no_error_of_lua_whatever_the_capture(self):
        sources = [self.converted(name) for name in
                   ("parol6/gripper_can_burst_a", "kinovazed/framing-blank-and-colon",
                    "morap/static-program-sizes", "morap/pen-random")]
        sources.append(SOURCE / "tests/data/captures/kinovazed-lo.pcap")
        sources.append(self.pcap(USB_LONG, usb_events([COMMAND] * 20, 64)))
        damaged = self.folder / "damaged"
        for source in sources:
            for words in (("-E", "0.02", "--seed", "1"), ("-E", "0.2", "--seed", "2"),
                          ("-s", "71"), ("-s", "38"), ("-s", "2"), ("-C", "5:30"), ("-C", "40")):
                with self.subTest(f"{source.name} {words}"):
                    made = run("editcap", *words, source, damaged)
                    self.assertEqual(made.returncode, 0, made.stderr)
                    # Twice, as Wireshark does when the user comes back to a packet.
                    done = self.run_tshark("-2", "-r", damaged, "-V")
                    self.assertNotIn(b"Lua", done.stderr)
                    self.assertNotIn(b"Lua Error", done.stdout)

    def test_a_live_session_through_an_interface_of_wireshark(self):
        home, link, words = self.folder / "home", self.folder / "arm", self.folder / "said"
        home.mkdir()
        own = {**os.environ, "HOME": str(home), "XDG_CONFIG_HOME": str(home / ".config")}
        done = subprocess.run([ARMJIG, "wireshark", "install"], env=own, capture_output=True,
                              check=True)
        self.assertEqual(len([line for line in done.stdout.splitlines()
                              if line.endswith(b"/extcap/armjig")]), 2)
        listed = subprocess.run(["tshark", "-D"], env=own, capture_output=True, check=True).stdout
        self.assertIn(b"armjig-parol6 (armjig: PAROL6 control board)", listed)
        self.assertIn(b"armjig-kinovazed", listed)
        with words.open("wb") as output, (self.folder / "errors").open("wb") as errors:
            shark = subprocess.Popen(
                ["tshark", "-i", "armjig-parol6", "-o", f"extcap.armjig_parol6.listen:pty:{link}",
                 "-l", "-Y", "parol6.message", "-T", "fields", "-e", "parol6.message"],
                env=own, stdout=output, stderr=errors)
        self.addCleanup(shark.wait)
        self.addCleanup(shark.kill)
        self.wait_for(link.is_symlink)
        done = run(ARMJIG, "watch", "parol6", "--target", f"pty:{link}", "--count", "3")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.wait_for(lambda: words.read_text().count("telemetry") >= 3)
        shark.send_signal(signal.SIGINT)
        self.assertEqual(shark.wait(PATIENCE), 0)
        self.assertGreaterEqual(words.read_text().count("command"), 3)
        errors = (self.folder / "errors").read_text()
        self.assertNotIn("extcap pipe", errors)
        self.assertNotIn("Lua", errors)

    def wait_for(self, is_so):
        end = time.monotonic() + PATIENCE
        while not is_so():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def test_what_wireshark_asks_of_the_program_that_captures(self):
        program = self.folder / "extcap/armjig"
        for words, wanted in (
                (["--extcap-interfaces", "--extcap-version=4.0"],
                 b"interface {value=armjig-morap}{display=armjig: MORAP motor nodes}"),
                (["--extcap-interface", "armjig-morap", "--extcap-dlts"],
                 b"dlt {number=209}{name=I2C_LINUX}"),
                (["--extcap-interface", "armjig-kinovazed", "--extcap-config"],
                 b"{call=--listen}{display=Listen}{type=string}{required=true}{default=tcp:51717}")):
            with self.subTest(words):
                done = run(program, *words)
                self.assertEqual((done.returncode, done.stderr), (0, b""))
                self.assertIn(wanted, done.stdout)

    def test_every_message_and_field_of_recordings(self):
        for name in RECORDINGS:
            with self.subTest(name):
                self.compare(self.converted(name), name.split("/", maxsplit=1)[0])

    def test_messages_that_are_split_and_merged(self):
        stream = COMMAND * 5
        for size in (1, 7, 55, 57, 130, 280):
            with self.subTest(size):
                path = self.recording(stream[i:i + size] for i in range(0, len(stream), size))
                self.assertEqual(len(self.compare(path, "parol6")), 5)

    def test_what_is_damaged_is_noise_with_its_reason(self):
        wrong_length = COMMAND[:3] + b"\x35" + COMMAND[4:]
        wrong_end = COMMAND[:-1] + b"\x03"
        path = self.recording([b"junk" + COMMAND, wrong_length + COMMAND, wrong_end, b"\xff" + COMMAND])
        self.compare(path, "parol6")
        shown = self.tshark(path, "-T", "fields", "-e", "parol6.fault", "-e", "_ws.expert.message")
        self.assertEqual([line.split("\t")[0] for line in shown.decode().splitlines()],
                         ["no start of a message", "length: 0x35 where 0x34 is due",
                          "end: 0x03 where 0x02 is due", "no start of a message"])
        self.assertIn(b"end: 0x03 where 0x02 is due\tend: 0x03", shown)

    def test_fields_and_their_flags_are_display_filters(self):
        # position.j1 is 01 02 03: 66051; bit 7 of affected_joints, 0x81, is j1; 0xFF is idle
        path = self.recording([COMMAND, COMMAND.replace(b"\x01\x02\x03\x04", b"\x01\x02\x04\x04")])
        for text, count in (("parol6.position.j1 == 66051", 1), ("parol6.position.j1 == 66052", 1),
                            ("parol6.affected_joints.j1 == 1", 2), ("parol6.affected_joints.j2 == 1", 0),
                            ("parol6.gripper.speed == 255", 2), ("parol6.command == 255", 2)):
            with self.subTest(text):
                shown = self.tshark(path, "-Y", text, "-T", "fields", "-e", "frame.number")
                self.assertEqual(len(shown.split()), count)


if __name__ == "__main__":
    if not shutil.which("tshark") or not shutil.which("editcap"):
        print("tshark and editcap are not here")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
