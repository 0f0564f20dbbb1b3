# SPDX-License-Identifier: Apache-2.0
"""A client with nothing of ours drives the emulated PAROL6 board over its pseudo-terminal, and over
RFC 2217 with no option that makes allowances for the server, also beside a recording.

Only python3-serial and the frame layout of the board's document: 100 Hz frames built by hand, every
answer checked, a jog that must move the joint by what it says, a stop that must end it.

    /usr/bin/python3 pyserial_client_test.py build/release/cli/armjig
"""
import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time

try:
    import serial
except ImportError:
    print("skipped: Debian's python3-serial is not installed")
    sys.exit(77)

JOG, DISABLE, ENABLE, IDLE = 123, 102, 101, 255
PERIOD = 0.01
TICK = 10e-3 / 7031.25  # of timing_data: 45 MHz / 64


def i24(value):
    return (value & 0xFFFFFF).to_bytes(3, "big")


def command(code, speeds=(0,) * 6, outputs=0):
    body = b"".join(i24(0) for _ in range(6))  # positions
    body += b"".join(i24(speed) for speed in speeds)
    body += bytes([code, 0xFF, outputs, 0])  # command, affected joints, outputs, timeout
    body += bytes(6) + bytes([0, 0, 0])  # gripper: position, speed, current; command, mode, id
    body += bytes([0xE4, 0x01, 0x02])  # CRC field as the vendor's program sends it, end
    assert len(body) == 52
    return bytes([0xFF, 0xFF, 0xFF, len(body)]) + body


class Telemetry:
    def __init__(self, frame):
        assert len(frame) == 60, f"{len(frame)} bytes instead of 60: {frame.hex(' ')}"
        assert frame[:4] == bytes([0xFF, 0xFF, 0xFF, 56]), frame.hex(" ")
        assert frame[57:] == bytes([0xD4, 0x01, 0x02]), frame.hex(" ")
        field = lambda at: int.from_bytes(frame[at:at + 3], "big", signed=True)
        self.positions = [field(4 + 3 * joint) for joint in range(6)]
        self.speeds = [field(22 + 3 * joint) for joint in range(6)]
        self.io = frame[41]
        self.seconds = int.from_bytes(frame[44:46], "big") * TICK
        self.echo = frame[47]


def exchange(port, code, **fields):
    port.write(command(code, **fields))
    answer = Telemetry(port.read(60))
    assert answer.echo == code, f"echo {answer.echo} of {code}"
    return answer


def cycle(port, code, seconds, **fields):
    """`cycle_once`, again if the machine was too busy: the timing field wraps after 93 ms."""
    for _ in range(10):
        answers, elapsed, longest_gap = cycle_once(port, code, seconds, **fields)
        if longest_gap < 0.08:
            return answers, elapsed
    raise AssertionError("this machine cannot keep a period of 80 ms")


def cycle_once(port, code, seconds, **fields):
    """100 Hz frames for that long; all answers, the time the board saw between the outer two, and
    the longest time between two frames here."""
    answers = []
    gaps = [0.0]
    due = sent = time.monotonic()
    while len(answers) < round(seconds / PERIOD):
        gaps.append(time.monotonic() - sent)
        sent = time.monotonic()
        answers.append(exchange(port, code, **fields))
        due += PERIOD
        time.sleep(max(0.0, due - time.monotonic()))
    return answers, sum(answer.seconds for answer in answers[1:]), max(gaps)


def check(port):
    first = exchange(port, IDLE)
    assert first.io & 0x08, "the emergency stop is released"
    assert first.speeds == [0] * 6

    answers, elapsed = cycle(port, JOG, 1.0, speeds=(1000, -500, 0, 0, 0, 0))
    moved = [b - a for a, b in zip(answers[0].positions, answers[-1].positions)]
    assert answers[-1].speeds[:2] == [1000, -500], answers[-1].speeds
    for joint, speed in ((0, 1000), (1, -500)):
        # The board's own clock says how long it was; a frame may lie a step to either side.
        assert abs(moved[joint] - speed * elapsed) <= 3, (joint, moved, elapsed)
    assert moved[2:] == [0] * 4, moved

    stopped = exchange(port, IDLE)
    answers, _ = cycle(port, IDLE, 0.2)
    assert answers[-1].speeds == [0] * 6
    assert abs(answers[-1].positions[0] - stopped.positions[0]) <= 1, "it stands still"

    assert exchange(port, IDLE, outputs=0x20).io & 0x30 == 0x20, "output 1 follows its bit"
    assert exchange(port, DISABLE).io & 0x08
    return moved, elapsed


def check_modem_lines(port):
    assert (port.cts, port.dsr, port.cd, port.ri) == (True, True, True, False)
    for state in (False, True):  # raises if the server does not acknowledge it
        port.dtr = port.rts = port.break_condition = state
    port.break_condition = False
    port.reset_input_buffer()
    port.reset_output_buffer()
    port.apply_settings({"baudrate": 9600, "bytesize": 7, "parity": "E", "stopbits": 2})
    port.apply_settings({"baudrate": 3_000_000, "bytesize": 8, "parity": "N", "stopbits": 1})
    port.rtscts = True
    port.rtscts = False


@contextlib.contextmanager
def armjig(places, *arguments):
    """Runs it, and says where it listens: `places` lines."""
    program = subprocess.Popen([sys.argv[1], *arguments], stdout=subprocess.PIPE, text=True)
    try:
        yield [program.stdout.readline().strip().removeprefix("listening ") for _ in range(places)]
    finally:
        program.send_signal(signal.SIGTERM)
        exit_code = program.wait(timeout=30)
    assert exit_code == 0, exit_code


def drive(place):
    scheme, address = place.split(":", 1)
    is_remote = scheme == "rfc2217"
    url = "rfc2217://" + address if is_remote else address
    with serial.serial_for_url(url, 3_000_000, timeout=10) as port:
        if is_remote:
            check_modem_lines(port)
        moved, elapsed = check(port)
        exchange(port, ENABLE)
    print(f"jogged {moved} steps in {elapsed:.4f} s of the board's time over {url}")


def main():
    with armjig(2, "emulate", "parol6", "--pty", "--rfc2217", "0") as (pty, remote):
        for place in (pty, pty, remote, remote):  # and again, as a second client
            drive(place)
    with tempfile.TemporaryDirectory() as folder:
        recording = os.path.join(folder, "session.jsonl")
        with armjig(1, "record", "parol6", "--listen", "rfc2217:0", "--target", "emulated:",
                    "--out", recording) as (place,):
            drive(place)
        assert os.path.getsize(recording) > 10_000, "what passed is recorded"


main()
