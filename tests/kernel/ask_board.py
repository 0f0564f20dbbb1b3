# SPDX-License-Identifier: Apache-2.0
"""A program with nothing of ours, in the guest: ask_board.py PORT. Idle frames, as the board's document lays them out;
each answer has to be a whole frame that repeats the command."""

import sys

import serial

IDLE = 255
FRAME = bytes([0xFF, 0xFF, 0xFF, 52]) + bytes(36) + bytes([IDLE, 0xFF]) + bytes(11) + bytes([0xE4, 0x01, 0x02])

with serial.Serial(sys.argv[1], 3_000_000, timeout=2) as port:
    for _ in range(100):
        port.write(FRAME)
        answer = port.read(60)
        assert answer[:4] == bytes([0xFF, 0xFF, 0xFF, 56]) and answer[57:] == bytes([0xD4, 0x01, 0x02]), answer.hex(" ")
        assert answer[47] == IDLE, answer.hex(" ")
print("100 answers")
