#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Programs with nothing of ours on a virtual I2C bus: i2c_test.py ARMJIG

Each row is a program that runs in `armjig lab exec`, its exit code, and words that it must print
(or, with a leading "!", write to standard error).
"""

import os
import pathlib
import subprocess
import sys
import tempfile

ARMJIG = sys.argv[1]
NODES = """
[[node]]
id = 1
[[node]]
id = 2
[[node]]
id = 3
motor = "dcx22l"
[[node]]
id = 3
motor = "dcx26l"
[[pen]]
[[thermometer]]
address = 0x18
[[thermometer]]
address = 0x48
celsius = 21.5
"""
PARAMETERS = """
controller = "position"
rate_hz = {}
d = [1.0]
c = [1.0]
f = [0.0]
"""
TWO_FILES = """
import fcntl, os
SLAVE = 0x703
files = [os.open("/dev/i2c-1", os.O_RDWR) for _ in range(2)]
for file, address in zip(files, (0x11, 0x12)):
    fcntl.ioctl(file, SLAVE, address)
for file in files:
    os.write(file, b"\\x88")  # own address
print([os.read(file, 1)[0] for file in files])
"""
NODE_SETTLES = """
import struct, subprocess, time
def i2c(*words):
    return subprocess.run(["i2ctransfer", "-y", "1", *words], check=True, capture_output=True,
                          text=True).stdout
def angle():
    return struct.unpack("<f", bytes(int(b, 16) for b in i2c("w1@0x12", "0x80", "r4@0x12").split()))[0]
i2c("w1@0x12", "0x10")                                    # calibrate
i2c("w5@0x12", "0x01", "0x00", "0x00", "0x00", "0x3f")    # go to 0.5 rad
deadline = time.monotonic() + 30
while abs(angle() - 0.5) > 0.01 and time.monotonic() < deadline:
    pass
print("arrived" if abs(angle() - 0.5) <= 0.01 else angle())
"""


def program(file, node):
    return [ARMJIG, "morap", "program", str(file), "--target", "i2c:/dev/i2c-1", "--node", str(node),
            "--allow", "program"]


def rows(folder):
    good, fast, forbidden = (folder / name for name in ("good.toml", "fast.toml", "forbidden"))
    good.write_text(PARAMETERS.format(200))
    fast.write_text(PARAMETERS.format(2000))
    forbidden.touch(mode=0o000)
    no_root = ["setpriv", "--bounding-set=-dac_override,-dac_read_search"] if os.geteuid() == 0 else []
    return [
        (["i2cdetect", "-y", "1"], 0, ["10: -- 11 12 13 --", "18 19 --", "40: -- -- -- -- -- -- -- -- 48"]),
        (["i2cdetect", "-y", "-r", "1"], 0, ["10: -- 11 12 13 --"]),
        (["i2cdetect", "-y", "-q", "1"], 0, ["10: -- 11 12 13 --"]),
        (["i2cdetect", "-l"], 0, ["i2c-1", "armjig emulated bus"]),
        (["i2cdetect", "-F", "1"], 0, ["I2C                              yes"]),
        (["i2ctransfer", "-y", "1", "w1@0x12", "0x83", "r1@0x12"], 0, ["0x03"]),
        (["i2ctransfer", "-y", "1", "w5@0x11", "0x11", "0x00", "0x00", "0x80", "0x3f"], 0, []),
        (["i2ctransfer", "-y", "1", "r1@0x55"], 1, ["!No such device or address"]),
        (["i2ctransfer", "-y", "2", "r1@0x12"], 1, ["!/dev/i2c-2"]),
        (["i2cget", "-y", "1", "0x12"], 0, ["0x00"]),
        (["i2cget", "-y", "1", "0x48", "0x00", "w"], 0, ["0x8015"]),  # 21.5 degrees, high byte first
        (["i2cget", "-y", "1", "0x48", "0x00", "i", "2"], 0, ["0x15 0x80"]),
        (["i2cget", "-y", "1", "0x30"], 2, ["!Read failed"]),
        (["i2cset", "-y", "1", "0x48", "0x02", "0x60"], 0, []),
        (["i2cset", "-y", "1", "0x48", "0x09"], 1, ["!Write failed"]),
        (["python3", "-c", TWO_FILES], 0, ["[17, 18]"]),
        (["python3", "-c", NODE_SETTLES], 0, ["arrived"]),
        # Our own program is a program like any other.
        ([ARMJIG, "i2c", "scan", "--target", "i2c:/dev/i2c-1"], 0, ["0x11", "0x12", "0x19", "0x48"]),
        ([ARMJIG, "i2c", "scan", "--target", "i2c:/dev/i2c-1", "--impair", "loss=100%"], 4,
         ["!nobody answers"]),
        ([ARMJIG, "i2c", "scan", "--target", "i2c:/dev/i2c-2"], 3, ["!there is no such bus"]),
        ([ARMJIG, "i2c", "scan", "--target", "i2c:/dev/null"], 2, ["!not an I2C bus"]),
        ([ARMJIG, "i2c", "read", "0x12", "1", "--select", "88", "--target", "i2c:/dev/i2c-1"], 0,
         ["18"]),
        ([ARMJIG, "i2c", "read", "0x33", "1", "--target", "i2c:/dev/i2c-1"], 3, ["!0x33"]),
        ([ARMJIG, "i2c", "write", "0x48", "09", "--target", "i2c:/dev/i2c-1", "--allow", "state"], 1,
         ["!not acknowledged"]),
        ([ARMJIG, "i2c", "write", "0x12", "01 00 00 80 3F", "--target", "i2c:/dev/i2c-1"], 3,
         ["!--allow move"]),
        ([ARMJIG, "morap", "tune", "--type", "pd", "--inertia", "0.2", "--pole", "-9", "--target",
          "i2c:/dev/i2c-1", "--node", "2", "--allow", "program"], 0, ["rate_hz = 400"]),
        # Two motors with one identifier: both accept, and what is read is a mixture.
        ([ARMJIG, "morap", "tune", "--type", "pd", "--inertia", "0.2", "--pole", "-9", "--target",
          "i2c:/dev/i2c-1", "--node", "3", "--allow", "program"], 1, ["!node 3: accepted, but"]),
        (program(good, 2), 0, ["rate_hz = 200"]),
        (program(good, 5), 3, ["!0x15"]),
        (program(good, 8), 1, ["!0x18: a byte was not acknowledged"]),
        (program(fast, 2), 2, ["!fast.toml", "!1500 Hz"]),
        (program(folder / "none.toml", 2), 2, ["!none.toml"]),
        ([*no_root, ARMJIG, "i2c", "scan", "--target", f"i2c:{forbidden}"], 3,
         ["!permission denied", "!usermod -aG i2c"]),
        ([ARMJIG, "morap", "read-params", "--target", "i2c:/dev/i2c-1", "--node", "5"], 3, ["!0x15"]),
        *(([ARMJIG, "conformance", "morap", "--target", "i2c:/dev/i2c-1", "--tier", "quick", "--allow",
            "all", "--filter", f"morap.{topic}"], 0, [" passed, 0 failed"])
          for topic in ("read.", "program.", "motion.speed", "motion.current")),
        (["sh", "-c", "exit 42"], 42, []),
        (["sh", "-c", "kill -TERM $$"], 128 + 15, []),
        (["no-such-program"], 3, ["!no-such-program"]),
    ]


def check(row, nodes):
    program, code, words = row
    environment = dict(os.environ, PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    done = subprocess.run([ARMJIG, "lab", "exec", "--i2c", nodes, "--", *program], text=True,
                          capture_output=True, timeout=60, env=environment)
    missing = [word for word in words
               if word.lstrip("!") not in (done.stderr if word.startswith("!") else done.stdout)]
    if done.returncode == code and not missing:
        return True
    print(f"{' '.join(program)[:100]}\n  exit code {done.returncode}, wanted {code}; missing {missing}"
          f"\n{done.stdout}{done.stderr}")
    return False


def main():
    with tempfile.TemporaryDirectory() as folder:
        nodes = pathlib.Path(folder) / "nodes.toml"
        nodes.write_text(NODES)
        results = [check(row, nodes) for row in rows(pathlib.Path(folder))]
    print(f"{sum(results)} of {len(results)} rows as wanted")
    return 0 if all(results) else 1


sys.exit(main())
