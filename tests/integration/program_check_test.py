# SPDX-License-Identifier: Apache-2.0
"""`armjig emulate parol6 --check` judges two clients with nothing of ours: one at a good rhythm, and
one whose gripper does not exist.

    /usr/bin/python3 program_check_test.py build/release/cli/armjig
"""
import json
import os
import select
import signal
import subprocess
import sys
import time
import tty


def idle(gripper_id):
    frame = bytearray(56)
    frame[:4] = b"\xff\xff\xff\x34"
    frame[40] = 255
    frame[52] = gripper_id
    frame[53:] = b"\xe4\x01\x02"
    return bytes(frame)


def talk(path, gripper_id, seconds=1.0):
    port = os.open(path, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port)
    end = time.monotonic() + seconds
    due = time.monotonic()
    while due < end:
        os.write(port, idle(gripper_id))
        due += 0.01
        time.sleep(max(0.0, due - time.monotonic()))
        while select.select([port], [], [], 0)[0]:
            os.read(port, 4096)
    os.close(port)


def check(armjig, gripper_id):
    """Exit code, report and standard error of a session."""
    emulator = subprocess.Popen([armjig, "emulate", "parol6", "--check", "--json"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    listening = json.loads(emulator.stdout.readline())["listening"]
    talk(listening[0].removeprefix("pty:"), gripper_id)
    emulator.send_signal(signal.SIGINT)
    out, err = emulator.communicate(timeout=30)
    return emulator.returncode, json.loads(out), err


def main(armjig):
    code, report, err = check(armjig, gripper_id=20)
    failed = [row["name"] for row in report["rows"] if row["verdict"] == "fail"]
    # On a machine that has no time for the client its rhythm is bad too.
    assert "parol6.host.gripper-id" in failed, failed
    assert code == 1, code
    assert "parol6.host.gripper-id: gripper.id was 20" in err, err

    code, report, err = check(armjig, gripper_id=0)
    failed = {row["name"] for row in report["rows"] if row["verdict"] == "fail"}
    assert failed <= {"parol6.host.rate-slow", "parol6.host.jitter"}, failed
    assert code == (1 if failed else 0), code
    print("ok")


main(sys.argv[1])
