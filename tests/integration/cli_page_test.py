#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""docs/cli.md against the program: cli_page_test.py ARMJIG docs/cli.md [--renew]

The list of subcommands and options between the marks is the program's own, and the rest of the page
has something to say of each: a subcommand by its name, an option in the tables.
"""

import re
import subprocess
import sys

ARMJIG, PAGE = sys.argv[1:3]
BEGIN, END = "<!-- commands -->\n", "<!-- end of commands -->"


def complaints(page, commands):
    """What the page says wrong, or does not say."""
    begin = page.index(BEGIN) + len(BEGIN)
    end = page.index(END)
    if page[begin:end] != commands:
        yield f"{PAGE} is stale; renew it: scripts/docs"
    rest = page[:begin] + page[end:]
    known = set()
    for line in commands.splitlines():
        command, *names = re.findall(r"`([^`]+)`", line)
        words = command.split()
        known.update(name for name in names if name.startswith("--"))
        if not re.search(rf"\b{words[1]}\b", rest) or not re.search(rf"\b{words[-1]}\b", rest):
            yield f"{PAGE} does not explain '{command}'"
        for name in names:
            if name.startswith("--") and not re.search(rf"(?<![\w-]){name}(?![\w-])", rest):
                yield f"{PAGE} does not explain {name} of '{command}'"
    for name in sorted(set(re.findall(r"`(--[a-z][\w-]*)", rest)) - known - {"--help", "--version"}):
        yield f"{PAGE} explains {name}, which no subcommand has"


def main():
    commands = subprocess.run([ARMJIG, "__commands"], capture_output=True, text=True,
                              check=True).stdout
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    if sys.argv[3:] == ["--renew"]:
        page = page[:page.index(BEGIN) + len(BEGIN)] + commands + page[page.index(END):]
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(page)
    found = list(complaints(page, commands))
    print("\n".join(found) or "the page has what the program has")
    return 1 if found else 0


sys.exit(main())
