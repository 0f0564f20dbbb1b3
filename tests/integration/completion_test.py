#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Completion as people use it: completion_test.py ARMJIG

Types lines with a tab into each shell that is there, on a terminal of its own, lets the shell echo
what became of them, and compares.
"""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile

ARMJIG = pathlib.Path(sys.argv[1]).resolve()
PATIENCE = 60  # seconds, for a machine that is busy with something else

# What is typed, and what it becomes.
LINES = {
    "armjig conf\t": "armjig conformance",
    "armjig conformance kin\t": "armjig conformance kinovazed",
    "armjig conformance parol6 --tar\t": "armjig conformance parol6 --target",
    "armjig conformance parol6 --target ser\t": "armjig conformance parol6 --target serial:",
    "armjig emulate morap --set mot\t": "armjig emulate morap --set motor=",
    "armjig conformance parol6 --target 'emulated:?profile=firm\t":
        "armjig conformance parol6 --target emulated:?profile=firmware",
    "armjig conformance parol6 --explain parol6.frame.burst.th\t":
        "armjig conformance parol6 --explain parol6.frame.burst.thirty",
    "armjig decode demo --file seven\t": "armjig decode demo --file seven.bin",
}

# How each is started, and what makes it ready.
SHELLS = {
    "bash": (["bash", "--norc", "--noprofile", "-i"], "source <(armjig completion bash)"),
    "zsh": (["zsh", "-f", "-i"],
            "bindkey -e; autoload -U compinit && compinit -u -D && source <(armjig completion zsh)"),
    "fish": (["fish", "--no-config", "-i"], "armjig completion fish | source"),
}

# What the program itself answers the scripts.
ANSWERS = [
    (["conformance", ""], ["demo", "diff", "kinovazed", "morap", "mutants", "parol6"]),
    (["record", "parol6", "--listen", ""], ["i2c:", "pty:", "rfc2217:", "tcp:"]),
    (["emulate", ""], ["demo", "kinovazed", "morap", "parol6"]),
    (["conformance", "mutants", "d"], ["demo"]),
    (["watch", "morap", "--target", ""],
     ["emulated:", "emulated:?", "i2c-tiny-usb:", "i2c:", "pty:", "rfc2217:", "serial:", "tcp:", "usb:"]),
    (["conformance", "parol6", "--target", "emulated:?profile="],
     ["emulated:?profile=documented", "emulated:?profile=firmware"]),
    (["conformance", "parol6", "--target", "emulated:?crc=d4&es"], ["emulated:?crc=d4&estop="]),
    (["conformance", "parol6", "--explain", "parol6.frame.burst.t"],
     ["parol6.frame.burst.thirty"]),
    (["conformance", "parol6", "--profile=f"], ["--profile=firmware"]),
    (["conformance", "parol6", "--allow", "state,gr"], ["state,grip"]),
    (["kin", "fk", "--arm", "jaco2-"], ["jaco2-spherical"]),
    (["decode", "demo", "--file", ""], []),
    (["nonsense", "x"], []),
    ([""], None),
]


class Terminal:
    """A shell on a terminal of its own."""

    def __init__(self, command, folder):
        environment = {"PATH": f"{ARMJIG.parent}:{os.environ['PATH']}", "TERM": "xterm",
                       "HOME": str(folder), "LC_ALL": "C.UTF-8", "PS1": "$ "}
        self.process, self.file = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.execvpe(command[0], command, environment)
        self.shown = ""

    def type(self, text):
        os.write(self.file, text.encode())

    def read_until(self, pattern):
        """What is shown, up to a match; None if there is none in time."""
        while not (found := re.search(pattern, plain(self.shown))):
            if not select.select([self.file], [], [], PATIENCE)[0]:
                return None
            try:
                self.shown += os.read(self.file, 65536).decode(errors="replace")
            except OSError:
                return None
        self.shown = ""
        return found

    def close(self):
        os.close(self.file)
        os.kill(self.process, 9)
        os.waitpid(self.process, 0)


def plain(text):
    """Without what moves the cursor and colours."""
    return re.sub(r"\x1b(\][^\x07]*\x07|\[[0-9;?>=]*[a-zA-Z]|[()][A-Z0-9]|[=>])", "", text)


def check_shell(name, folder):
    command, ready = SHELLS[name]
    terminal = Terminal(command, folder)
    # The marks are not in what is typed, only in what the shell makes of it.
    terminal.type(f"{ready}; echo re''ady\r")
    if terminal.read_until(r"ready") is None:
        return [f"{name}: did not start: {terminal.shown[-2000:]!r}"]
    failures = []
    for typed, wanted in LINES.items():
        # Control-A goes to the beginning of the line, control-E to its end.
        terminal.type(f"{typed}\x01echo be''gin; echo \x05; echo e''nd\r")
        found = terminal.read_until(r"begin\r+\n([^\r\n]*)\r+\n(?:.*\n)?end\r")
        got = found.group(1).strip() if found else f"nothing in {terminal.shown[-2000:]!r}"
        if got != wanted:
            failures.append(f"{name}: {typed!r} became {got!r}, not {wanted!r}")
            if not found:
                break
    terminal.close()
    return failures


def check_answers():
    failures = []
    for words, wanted in ANSWERS:
        run = subprocess.run([ARMJIG, "__complete", *words], capture_output=True, text=True,
                             check=True)
        got = run.stdout.split()
        if wanted is not None and got != wanted:
            failures.append(f"{words}: {got}, not {wanted}")
        if wanted is None and not {"conformance", "decode", "emulate"} <= set(got):
            failures.append(f"{words}: {got}")
    return failures


def main():
    failures = check_answers()
    for name in SHELLS:
        if name != "bash" and shutil.which(name) is None:
            print(f"{name} is not here: skipped")
            continue
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "seven.bin").write_bytes(b"7")
            found = check_shell(name, folder)
        failures += found
        print(f"{name}: {'failed' if found else 'completes'}")
    print("\n".join(failures))
    return 1 if failures else 0


sys.exit(main())
