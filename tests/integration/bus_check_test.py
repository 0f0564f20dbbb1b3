# SPDX-License-Identifier: Apache-2.0
"""`armjig emulate morap --check` and `armjig lab exec --check` judge two masters of an I2C bus: our own,
which is sound, and Debian's i2ctransfer as it is used here.

    /usr/bin/python3 bus_check_test.py build/release/cli/armjig
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

ARMJIG = sys.argv[1]
BUS = "i2c:/dev/i2c-1"
NODES = """
[[node]]
id = 2
[[pen]]
"""
PARAMETERS = """
controller = "position"
rate_hz = 200
d = [1.0]
c = [1.0]
f = [0.0]
"""


def ours(folder):
    """A session of our own master: looks, programs, drives, disables."""
    file = folder / "parameters.toml"
    file.write_text(PARAMETERS)
    console = "calibrate\\ngoto 0.2\\nwait 0.2\\nstatus\\n"
    return " && ".join([
        f"{ARMJIG} i2c scan --target {BUS}",
        f"{ARMJIG} morap program {file} --target {BUS} --allow program",
        f"{ARMJIG} morap tune --type pd --inertia 0.2 --pole -9 --target {BUS} --allow program",
        f"{ARMJIG} morap read-params --target {BUS}",
        f"printf '{console}' | {ARMJIG} console morap --target {BUS} --allow all",
    ])


def faulty():
    """Drives a node that is not calibrated, leaves it enabled, and gives the pen no time."""
    return " && ".join([
        "i2ctransfer -y 1 w5@0x12 0x01 0x00 0x00 0x00 0x00",
        "i2ctransfer -y 1 w1@0x19 0x01",
        "i2ctransfer -y 1 w1@0x19 0x02 w1@0x19 0x01",
    ])


FAULTS = {"morap.host.calibrates-first", "morap.host.ends-disabled", "morap.host.pen-pause"}


def failed(report):
    return {row["name"] for row in report["rows"] if row["verdict"] == "fail"}


def emulated(program):
    """Exit code, report and standard error of a session on a bus that is served."""
    emulator = subprocess.Popen([ARMJIG, "emulate", "morap", "--set", "pen=yes", "--check", "--json"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    environment = dict(os.environ)
    for variable in json.loads(emulator.stdout.readline())["environment"]:
        name, value = variable.split("=", 1)
        environment[name] = value
    subprocess.run(["sh", "-c", program], env=environment, check=True, timeout=60,
                   stdout=subprocess.DEVNULL)
    emulator.send_signal(signal.SIGINT)
    out, err = emulator.communicate(timeout=30)
    return emulator.returncode, json.loads(out), err


def in_lab(program, folder):
    """The same for a program that is started on its bus, and its standard output."""
    nodes = folder / "nodes.toml"
    nodes.write_text(NODES)
    file = folder / "report.json"
    done = subprocess.run([ARMJIG, "lab", "exec", "--i2c", str(nodes), "--check", "--json", str(file),
                           "--", "sh", "-c", program], capture_output=True, text=True, timeout=60)
    return done.returncode, json.loads(file.read_text()), done.stderr, done.stdout


def main(folder):
    os.environ["PATH"] = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    code, report, err = emulated(faulty())
    assert failed(report) == FAULTS, failed(report)
    assert code == 1, code
    assert "morap.host.calibrates-first: reference 1" in err, err

    code, report, err = emulated(ours(folder))
    assert failed(report) == set(), (failed(report), err)
    assert code == 0, code

    code, report, err, _ = in_lab(faulty(), folder)
    assert failed(report) == FAULTS, failed(report)
    assert code == 1, code
    assert "morap.host.pen-pause" in err, err

    code, report, err, out = in_lab(ours(folder), folder)
    assert failed(report) == set(), (failed(report), err)
    assert code == 0, code
    assert "rate_hz" in out and "Programs that talk to morap" not in out, out

    assert in_lab("true", folder)[0] == 4, "nobody was told anything"
    assert in_lab("exit 7", folder)[0] == 7, "a program that fails says it itself"
    print("ok")


with tempfile.TemporaryDirectory() as temporary:
    main(pathlib.Path(temporary))
