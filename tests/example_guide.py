# SPDX-License-Identifier: Apache-2.0
"""Holds docs/adding-a-device.md to the example it is about.

    python3 tests/example_guide.py docs/adding-a-device.md examples/modbus-gripper [--only-quotes]

A block that names a file, as in ```cpp rtu.hpp, stands in that file of the example, without what
lines of `...` leave out. In a ```console block each line `$ COMMAND` is run in the example's folder
and has the output that follows it.
"""
import fnmatch
import pathlib
import re
import subprocess
import sys

BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def named_blocks(page):
    """The blocks of a page that name a file, by that name."""
    text = pathlib.Path(page).read_text(encoding="utf-8")
    return {name: block for _, name, block in BLOCK.findall(text) if name}


def is_quoted(block, source):
    """All pieces stand in the source, one after the other."""
    place = 0
    for piece in re.split(r"^ *\.\.\.\n", block, flags=re.MULTILINE):
        place = source.find(piece, place)
        if place < 0:
            return False
        place += len(piece)
    return True


def wrong_output(session, folder):
    """The first command whose output is another one."""
    for command, shown in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", session, re.MULTILINE):
        run = subprocess.run(command, shell=True, cwd=folder, text=True, check=False,
                             stdin=subprocess.DEVNULL, capture_output=True)
        pattern = shown.strip().replace("[", "[[]").replace("...", "*")
        if not fnmatch.fnmatchcase(run.stdout.strip(), pattern):
            return f"$ {command}\n{run.stdout}{run.stderr}"
    return None


def main():
    page = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    folder = pathlib.Path(sys.argv[2])
    wrong = []
    quotes = 0
    for kind, name, block in BLOCK.findall(page):
        if name:
            quotes += 1
            if not is_quoted(block, (folder / name).read_text(encoding="utf-8")):
                wrong.append(f"this does not stand in {name}:\n{block}")
        elif kind == "console" and "--only-quotes" not in sys.argv:
            output = wrong_output(block, folder)
            if output:
                wrong.append(f"the guide shows another output:\n{output}")
    print("\n".join(wrong) or f"guide: {quotes} blocks stand in the example")
    sys.exit(1 if wrong or quotes == 0 else 0)


if __name__ == "__main__":
    main()
