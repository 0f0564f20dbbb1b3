#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A program of the vendor's document on an emulated arm behind a pseudo-terminal, with a process for
each: what runs on `emulated:` runs there too, or is refused before anything is sent.

    program_run_test.py ARMJIG
"""
import subprocess
import sys

ARMJIG = sys.argv[1]
FAST = "Begin()\nMoveJoint(0,-90,180,0,0,180,t=4)\nMoveJoint(90,-90,180,60,0,180,v=100,a=100)\nEnd()\n"
SPEED = "Begin()\nMoveJoint(0,-90,180,0,0,180,t=4,speed)\nEnd()\n"


def run(text, *arguments):
    done = subprocess.run([ARMJIG, "run", "-", *arguments], input=text, capture_output=True,
                          text=True, timeout=200)
    return done.returncode, done.stderr


def main():
    emulator = subprocess.Popen([ARMJIG, "emulate", "parol6"], stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True)
    try:
        target = emulator.stdout.readline().split()[1]
        code, err = run(FAST, "--target", "emulated:", "--home")
        assert code == 0, err
        code, err = run(FAST, "--target", target, "--allow", "move,home", "--home")
        assert code == 0, err
        assert "ran to its end, 2 moves" in err, err
        for program, more, why in ((SPEED, [], "j1 may jog at most at 1500 steps/s"),
                                   (FAST, ["--unhomed"], "go-to needs a homed arm")):
            code, err = run(program, "--target", target, "--allow", "move", *more)
            assert code == 3 and why in err, err
            assert "run:" not in err, err
    finally:
        emulator.terminate()
        emulator.wait()


main()
