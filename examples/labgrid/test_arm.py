# SPDX-License-Identifier: Apache-2.0
"""What labgrid hands out is a board: asked by hand over labgrid's own driver, and judged by armjig."""

import os
import subprocess

import pytest

IDLE = 255
FRAME = bytes([0xFF, 0xFF, 0xFF, 52]) + bytes(36) + bytes([IDLE, 0xFF]) + bytes(11) + bytes([0xE4, 0x01, 0x02])
ANSWER_SIZE = 60


@pytest.fixture
def line(target):
    """The board's serial port; free for others afterwards, for it serves one at a time."""
    driver = target.get_driver("SerialDriver")
    yield driver
    target.deactivate(driver)


def test_the_board_answers_each_frame(line):
    for _ in range(20):
        line.write(FRAME)
        answer = line.read(ANSWER_SIZE, timeout=5)
        assert answer[:4] == bytes([0xFF, 0xFF, 0xFF, 56])
        assert len(answer) == ANSWER_SIZE and answer[47] == IDLE


def test_the_board_conforms(target):
    port = target.get_resource("NetworkSerialPort")
    done = subprocess.run(
        [os.environ.get("ARMJIG", "armjig"), "conformance", "parol6", "--target", f"rfc2217:{port.host}:{port.port}",
         "--tier", "quick", "--allow", "state"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
