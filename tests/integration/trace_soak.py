#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads and converts a recording of 2 GB in less than 50 MB of memory: trace_soak.py ARMJIG SMALL

SMALL is a recording of a PAROL6 board that is repeated. The large files are deleted again.
ARMJIG_SOAK_BYTES sets another size.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

MOST_KB = 50_000


def memory_of(call):
    """Runs it; the most memory that it had, in kB, its seconds of processor, and its exit code."""
    with open(os.devnull, "wb") as nowhere:
        process = subprocess.Popen(call, stdout=nowhere, stderr=nowhere)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_maxrss, usage.ru_utime, process.returncode


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    armjig, small = sys.argv[1:]
    wanted = int(os.environ.get("ARMJIG_SOAK_BYTES", "2000000000"))
    failures = 0
    with tempfile.TemporaryDirectory(prefix="armjig-trace-soak-") as name:
        folder = pathlib.Path(name)
        seed, large, other = folder / "seed.pcapng", folder / "large.pcapng", folder / "other.jsonl"
        subprocess.run([armjig, "trace", "convert", small, seed], check=True)
        # In a process of its own: what is begun by one that had much memory is charged with it.
        maker = pathlib.Path(__file__).with_name("big_capture.py")
        subprocess.run([sys.executable, maker, seed, large, str(wanted)], check=True)
        decode = ["decode", "parol6", "--file", large]
        for call in ([*decode], [*decode, "--json"], [*decode, "--csv"],
                     ["trace", "show", large], ["trace", "show", large, "--html", folder / "a.html"],
                     ["trace", "info", large], ["trace", "convert", large, other]):
            most, user, code = memory_of([armjig, *call])
            words = " ".join(str(word) for word in call).replace(f"{folder}/", "")
            is_good = most < MOST_KB and code in (0, 1)  # the recording has noise
            failures += not is_good
            print(f"{'ok' if is_good else 'FAIL':4}  {most:6} kB, {user:6.1f} s, "
                  f"exit code {code}: {words}", flush=True)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
