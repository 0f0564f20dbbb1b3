#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`armjig fuzz` finds defects that the suites do not see: rare_defects_soak.py ARMJIG SOURCE

Each is to be found within 60 s and shrunk to at most 3 records more than the shortest that is known."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

from rare_defects import SHORTEST

ARMJIG, SOURCE = sys.argv[1:3]
MOST_SECONDS = 60
MOST_SURPLUS = 3


def run(*arguments):
    return subprocess.run([ARMJIG, *arguments], capture_output=True, text=True, check=False)


def trouble_with(device, name, shortest, folder):
    target = f"emulated:?fault=rare:{name}"
    if run("conformance", device, "--target", target, "--tier", "full").returncode != 0:
        return "the suite sees it"
    report = folder / "report.json"
    run("fuzz", device, "--target", target, "--known", f"{SOURCE}/fuzz/known/{device}-defects.toml",
        "--max-time", str(MOST_SECONDS), "--fail-fast", "--json", str(report))
    found = [row for row in json.loads(report.read_text())["rows"] if row["verdict"] == "fail"]
    if not found:
        return "it was not found"
    seconds, size = re.search(r"([0-9.]+) s after.*?([0-9]+) after shrinking", found[0]["evidence"]).groups()
    print(f"{device} {name}: {seconds} s, {size} records; {shortest} are the shortest known", flush=True)
    return None if int(size) <= shortest + MOST_SURPLUS else f"{size} records are too many for {shortest}"


def main():
    troubles = []
    with tempfile.TemporaryDirectory() as folder:
        for device, names in SHORTEST.items():
            for name, shortest in names.items():
                if trouble := trouble_with(device, name, shortest, pathlib.Path(folder)):
                    troubles.append(f"{device} {name}: {trouble}")
    print("\n".join(troubles))
    return 1 if troubles else 0


if __name__ == "__main__":
    sys.exit(main())
