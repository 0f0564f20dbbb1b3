# SPDX-License-Identifier: Apache-2.0
"""Makes a large recording out of a small one: big_capture.py IN.pcapng OUT.pcapng BYTES [TIMES]

The packets are repeated until OUT has so many bytes; each round goes on in time where the one before
ended. IN is one that armjig wrote: one section, little-endian, nanoseconds.
"""

import struct
import sys

PACKET = 6
ROUNDS_AT_ONCE = 256


def blocks(data):
    place = 0
    while place < len(data):
        kind, size = struct.unpack_from("<II", data, place)
        yield kind, data[place:place + size]
        place += size


def time_of(packet):
    high, low = struct.unpack_from("<II", packet, 12)
    return high << 32 | low


def enlarge(source, target, wanted):
    """Writes at least `wanted` bytes; returns how many packets there are."""
    with open(source, "rb") as file:
        all_blocks = list(blocks(file.read()))
    packets = [bytearray(block) for kind, block in all_blocks if kind == PACKET]
    times = [time_of(packet) for packet in packets]
    length = max(times) - min(times) + 10_000_000
    written = 0
    with open(target, "wb") as file:
        for kind, block in all_blocks:
            if kind != PACKET:
                written += file.write(block)
        count = 0
        shift = 0
        while written < wanted:
            pieces = []
            for _ in range(ROUNDS_AT_ONCE):
                for packet, time in zip(packets, times):
                    time += shift
                    struct.pack_into("<II", packet, 12, time >> 32, time & 0xFFFFFFFF)
                    pieces.append(bytes(packet))
                shift += length
                count += len(packets)
                if sum(map(len, packets)) * len(pieces) // len(packets) + written >= wanted:
                    break
            written += file.write(b"".join(pieces))
    return count


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    print(enlarge(sys.argv[1], sys.argv[2], int(sys.argv[3])), "packets")
