#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What the program says to those who call it wrongly: hostile_calls_test.py ARMJIG TABLE [FILTER]

The table's head says what a row is. FILTER runs only the rows that have it in them.
"""

import concurrent.futures
import os
import pathlib
import re
import shlex
import socket
import subprocess
import sys
import tempfile

ARMJIG = sys.argv[1]
TABLE = pathlib.Path(sys.argv[2])
FILTER = sys.argv[3] if len(sys.argv) > 3 else ""
DEVICES = ["parol6", "kinovazed", "morap", "demo"]
SECONDS = 10  # the slowest waits one for a pipe; the rest is for busy machines
MEMORY = 1 << 20  # KiB
HEADER = '{"format":"golden-trace/1","device":"parol6"}\n'
CRASHES = {70, 124, 134, 139}


def make_files(folder):
    """The names in braces that calls use."""
    def write(name, content):
        path = folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path
    files = {
        "dir": folder,
        "absent": folder / "absent",
        "empty": write("empty", ""),
        "binary": write("binary", bytes(range(256)) * 8),
        "text": write("text.txt", "What is this?\n"),
        "deep": write("deep.json", "[" * 200_000 + "]" * 200_000),
        "deep_line": write("deep.jsonl", HEADER + '{"t_us":0,"dir":"to_device","hex":"","x":'
                           + "[" * 200_000 + "]" * 200_000 + "}\n"),
        "long_line": write("long.jsonl", HEADER + "x" * (2 << 20)),
        "header": write("header.jsonl", HEADER),
        "bad_line": write("bad.jsonl", HEADER + '{"t_us":0,"dir":"to_device"\n'),
        "backwards": write("backwards.jsonl", HEADER + "".join(
            f'{{"t_us":{t},"dir":"to_device","hex":""}}\n' for t in (5, 4))),
        "bad_hex": write("hex.jsonl", HEADER + '{"t_us":0,"dir":"to_device","hex":"FFx"}\n'),
        "bad_time": write("time.jsonl", HEADER + '{"t_us":-1,"dir":"to_device","hex":""}\n'),
        "array": write("array.json", "[1, 2]"),
        "report": write("report.json", '{"schema":"armjig.report/1","rows":[]}'),
        "bad_rows": write("rows.json", '{"schema":"armjig.report/1","rows":[1]}'),
        "waiver": write("waiver.json", '{"schema":"armjig.waivers/1","waivers":[{"requirement":'
                        '"parol6.none","reason":"x","expires":"2099-01-31"}]}'),
        "deep_key": write("key.toml", "a." * 200_000 + "b = 1"),
        "deep_toml": write("deep.toml", "a = " + "[" * 200_000),
        "bad_toml": write("bad.toml", "[[node]\nid = 2\n"),
        "odd_key": write("odd.toml", "[[node]]\nid = 2\ncolour = 'red'\n"),
        "no_id": write("noid.toml", "[[node]]\nmotor = 'dcx22l'\n"),
        "twice": write("twice.toml", "[[node]]\nid = 2\n[[node]]\nid = 2\n"),
        "pen_node": write("pennode.toml", "[[pen]]\n[[node]]\nid = 9\n"),
        "nan_toml": write("nan.toml", "[[node]]\nid = 2\ninertia = nan\n"),
        "big_id": write("bigid.toml", "[[node]]\nid = 999\n"),
        "toaster": write("toaster.toml", "[[toaster]]\nid = 2\n"),
        "lab": write("lab.toml", "[[device]]\ndevice = 'demo'\n"),
        "lab_odd": write("lab1.toml", "[[device]]\ndevice = 'demo'\ncolour = 'red'\n"),
        "lab_device": write("lab2.toml", "[[device]]\ndevice = 'parol7'\n"),
        "lab_target": write("lab3.toml", "[[device]]\ndevice = 'demo'\ntarget = 'moon:'\n"),
        "lab_twice": write("lab4.toml", "[[device]]\nname = 'left'\ndevice = 'parol6'\ntcp = 4000\n"
                           "[[device]]\ndevice = 'kinovazed'\ntcp = 4000\n"),
        "lab_names": write("lab5.toml", "[[device]]\ndevice = 'parol6'\n"
                           "[[device]]\ndevice = 'parol6'\n"),
        "lab_server": write("lab6.toml", "[[device]]\ndevice = 'kinovazed'\npty = ''\n"),
        "lab_stream": write("lab7.toml", "[[device]]\ndevice = 'parol6'\ni2c = 1\n"),
        "lab_bus": write("lab8.toml", "[[device]]\ndevice = 'morap'\ntcp = 4000\n"),
        "lab_impair": write("lab9.toml", "[[device]]\ndevice = 'demo'\nimpair = 'loss=2'\n"),
        "lab_option": write("lab10.toml", "[[device]]\ndevice = 'parol6'\n"
                            "target = 'emulated:?fault=none-such'\n"),
        "lab_disconnect": write("lab11.toml", "[[device]]\ndevice = 'demo'\n"
                                "impair = 'disconnect=1%'\n"),
        "lab_absent": write("lab12.toml", "[[device]]\ndevice = 'parol6'\n"
                            "target = 'serial:/dev/none-such'\n"),
        "lab_capture": write("lab13.toml", "[[device]]\ndevice = 'parol6'\n"
                             "capture = '/dev/none/x.jsonl'\n"),
        "lab_type": write("lab14.toml", "[[device]]\ndevice = 'parol6'\ntcp = 'http'\n"),
        "huge": folder / "huge",
        "deep_urdf": write("deep.urdf", "<robot name='r'>" + "<a>" * 200_000),
        "urdf": write("two.urdf", "<robot name='r'><link name='a'/><link name='b'/><joint name='j'"
                      " type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>"
                      "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>"),
        "no_axis": write("axis.urdf", "<robot name='r'><link name='a'/><link name='b'/><joint "
                         "name='j' type='revolute'><parent link='a'/><child link='b'/>"
                         "<axis xyz='0 0 0'/></joint></robot>"),
        "script": write("good.rbt", "Begin()\nDelay(0.1)\nEnd()\n"),
        "bad_script": write("bad.rbt", "Begin()\nDance()\nEnd()\n"),
        "nan_script": write("nan.rbt", "Begin()\nDelay(nan)\nEnd()\n"),
        "odd_name": write("two\nlines.jsonl", "{"),
        "fifo": folder / "fifo",
        "socket": folder / "socket",
        "loop": folder / "loop",
        "secret": write("secret", "x"),
        "shut": folder / "shut",
    }
    with open(files["huge"], "wb") as huge:
        huge.truncate(3 << 30)
    os.mkfifo(files["fifo"])
    socket.socket(socket.AF_UNIX).bind(str(files["socket"]))
    files["loop"].symlink_to(files["loop"])
    files["secret"].chmod(0)
    files["shut"].mkdir(mode=0o500)
    return files


def read_table(files):
    """(line number, exit code, flags, words, call, what the shell does with it)"""
    rows = []
    for number, line in enumerate(TABLE.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#") or FILTER not in line:
            continue
        code, words, call = (part.strip() for part in line.split("|", 2))
        devices = DEVICES if "DEVICE" in call else [""]
        for device in devices:
            said = words.replace("DEVICE", device)
            text = call.replace("DEVICE", device)
            text, _, shell = text.partition(";;")
            said = re.sub(r"\{(\w+)\}", lambda name: str(files[name[1]]), said)
            rows.append((number, int(code.rstrip("onu")), code, said,
                         [word_of(word, files) for word in shlex.split(text)],
                         shell.strip().replace("\\n", "\n") or "</dev/null"))
    return rows


def word_of(word, files):
    """Bytes, for arguments need not be text."""
    word = re.sub(r"\{(\w+)\}", lambda name: str(files[name[1]]), word)
    raw = word.encode()
    return re.sub(rb"\\x([0-9A-F]{2})|\\n",
                  lambda code: bytes([int(code[1], 16)]) if code[1] else b"\n", raw)


def as_nobody():
    """How root runs what would be allowed to root, or nothing if that cannot be."""
    drop = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
    try:
        done = subprocess.run([*drop, ARMJIG, "--version"], capture_output=True, check=False)
    except FileNotFoundError:
        return []
    return drop if done.returncode == 0 else []


def run(row, limit):
    _, expected, flags, words, call, shell = row
    drop = []
    if "u" in flags and os.geteuid() == 0:
        drop = as_nobody()
        if not drop:
            return ""
    script = f'{limit} exec "$@" {shell}'
    try:
        done = subprocess.run([*drop, "sh", "-c", script, "sh", ARMJIG, *call], capture_output=True,
                              timeout=SECONDS, start_new_session=True)
    except subprocess.TimeoutExpired:
        return f"does not end in {SECONDS} s"
    said = done.stderr.decode(errors="surrogateescape")
    lines = said.splitlines()
    code = done.returncode if done.returncode >= 0 else 128 - done.returncode
    wrong = []
    if code != expected or code in CRASHES:
        wrong.append(f"exit code {code}, not {expected}")
    if words not in said:
        wrong.append(f"does not say '{words}'")
    if expected in (2, 3) and "n" not in flags and len(lines) != 1:
        wrong.append(f"{len(lines)} lines on standard error, not one")
    if expected in (2, 3) and "o" not in flags and done.stdout:
        wrong.append(f"standard output has {done.stdout[:60]}")
    if any(ord(letter) < 32 for line in lines for letter in line.replace("\t", "")):
        wrong.append("control characters in what it says")
    return "; ".join(wrong + [f"said {said[:400]!r}"]) if wrong else ""


def main():
    # Sanitizers reserve more address space than there is memory.
    is_sanitized = b"__asan_init" in pathlib.Path(ARMJIG).read_bytes()
    limit = "" if is_sanitized else f"ulimit -v {MEMORY};"
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        files = make_files(pathlib.Path(folder))
        rows = read_table(files)
        with concurrent.futures.ThreadPoolExecutor(max_workers=(os.cpu_count() or 2)) as pool:
            for row, wrong in zip(rows, pool.map(lambda row: run(row, limit), rows)):
                if not wrong:
                    continue
                failures += 1
                call = b" ".join(row[4]).decode(errors="backslashreplace")
                print(f"{TABLE}:{row[0]}: armjig {call}\n  {wrong}")
        files["shut"].chmod(0o700)
    print(f"{len(rows)} calls, {failures} of them not as they should be")
    return 1 if failures or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
