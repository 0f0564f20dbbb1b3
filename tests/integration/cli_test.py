#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The program as its users see it: cli_test.py ARMJIG SOURCE_DIR

Each row is a command line, what goes to standard input, the exit code, and words that must be on
standard output (or, with a leading "!", on standard error).
"""

import fcntl
import json
import os
import pathlib
import pty
import struct
import subprocess
import sys
import tempfile
import termios

ARMJIG = sys.argv[1]
SOURCE = pathlib.Path(sys.argv[2])
# Lines that nobody may begin to move for.
WRONG_LINES = {
    "limits": "MoveJoint(200, -90, 180, 0, 0, 180, t=9)",
    "unreachable": "MoveCart(900, 0, 300, 0, 90, 180, t=5)",
    "too-fast": "MoveJoint(0, -90, 180, 0, 0, 180, t=0.1)",
    "no-time": "MoveJoint(90, -90, 180, 0, 0, 170, t=0)",
    "over-100": "MoveJoint(90, -90, 180, 0, 0, 170, v=101, a=10)",
    "unknown": "SpeedCart(1)",
    "missing": "MoveJoint(90, -90, 180, 0, 0)",
}
IDLE = "FFFFFF34" + "00" * 36 + "FF" + "00" * 12 + "E40102"
RECORDING = SOURCE / "captures/parol6/outputs_sweep_a.jsonl"


def corrupted(folder):
    """A recording in which output 1 of the third answer is told the other way round."""
    lines = RECORDING.read_text().splitlines()
    answers = [i for i, line in enumerate(lines) if '"from_device"' in line]
    line = json.loads(lines[answers[2]])
    frame = bytearray.fromhex(line["hex"])
    frame[41] ^= 0x20
    line["hex"] = frame.hex()
    lines[answers[2]] = json.dumps(line)
    path = folder / "corrupted.jsonl"
    path.write_text("\n".join(lines) + "\n")
    return path, answers[2] + 1


def written(folder, name, text):
    path = folder / name
    path.write_text(text)
    return path


def rows(folder):
    different, line = corrupted(folder)
    broken = written(folder, "broken.jsonl",
                     RECORDING.read_text().splitlines()[0] + '\n{"t_us":0,"dir":"to_device"\n')
    other = written(folder, "other.jsonl", '{"format":"golden-trace/1","device":"toaster"}\n')
    faulty = "emulated:?fault=swap-bytes:speed.j1"
    examples = SOURCE / "harness/script/examples"
    captures = SOURCE / "captures"
    wrong = {name: written(folder, f"{name}.rbt", f"Begin()\n{line}\nEnd()\n")
             for name, line in WRONG_LINES.items()}
    binary = folder / "binary.rbt"
    binary.write_bytes(bytes(range(256)))
    two = folder / "two.jsonl"  # clients whose bytes come in between each other's
    two.write_text('{"format":"golden-trace/1","device":"kinovazed"}\n' + "".join(
        f'{{"t_us":{time},"dir":"to_device","conn":{connection},"hex":"{text.encode().hex()}"}}\n'
        for time, (connection, text) in enumerate([(0, "ESt"), (1, "Freeze\r\n"), (0, "op\r\n")])))
    silent = folder / "wire.jsonl"
    logged = folder / "bus.jsonl"
    served = folder / "server.jsonl"
    return [
        # Misuse: one clear line, exit code 2.
        ("", "", 2, ["!subcommand is required"]),
        ("frobnicate", "", 2, ["!no subcommand 'frobnicate'", "!conformance"]),
        # The nearest name that there is.
        ("conformence parol6", "", 2, ["!did you mean 'conformance'?"]),
        ("trace verfy x", "", 2, ["!no subcommand 'verfy'; did you mean 'verify'?"]),
        ("conformance parol6 --targt emulated:", "", 2, ["!no option --targt; did you mean '--target'?"]),
        ("conformance parl6 --list", "", 2, ["!did you mean 'parol6'?"]),
        ("conformance parol6 --target emulted:", "", 2, ["!did you mean 'emulated:'?"]),
        ("conformance parol6 --target emulated:?profil=firmware", "", 2, ["!did you mean 'profile'?"]),
        ("conformance parol6 --target emulated:?profile=firmwear", "", 2, ["!did you mean 'firmware'?"]),
        ("conformance parol6 --target emulated:?fault=zeroo:io", "", 2, ["!did you mean 'zero'?"]),
        ("conformance parol6 --target emulated: --profile documentd", "", 2,
         ["!--profile: there is no 'documentd'; did you mean 'documented'?"]),
        ("conformance parol6 --target emulated: --allow mvoe", "", 2, ["!did you mean 'move'?"]),
        ("conformance parol6 --target emulated: --impair lsos=1%", "", 2, ["!did you mean 'loss'?"]),
        ("conformance parol6 --explain parol6.frame.brust", "", 2, ["!did you mean 'parol6.frame.burst'?"]),
        ("conformance parol6 --list --filter parol6.frame.brust", "", 4,
         ["!did you mean 'parol6.frame.burst'?"]),
        ("kin fk 1 --arm jaco22", "", 2, ["!did you mean 'jaco2'?"]),
        # What is wrong, and nothing that contradicts it.
        ("conformance demo", "", 2, ["!armjig: --target is missing: say where the device is"]),
        ("conformance demo --target emulated: --shard 3/2", "", 2, ["!armjig: --shard 3/2: write which"]),
        ("conformance demo --target emulated: more", "", 2, ["!'more' is one word too many"]),
        ("conformance parol6", "", 2, ["!--target"]),
        ("conformance parol6 --target nonsense", "", 2, ["!'nonsense'"]),
        ("conformance parol6 --target emulated:?x=1", "", 2, ["!no such option"]),
        ("conformance parol6 --target emulated: --allow fly", "", 2, ["!--allow fly"]),
        ("conformance parol6 --target emulated: --impair loss=x", "", 2, ["!loss"]),
        ("decode parol6 F", "", 2, ["!hexadecimal digit is missing"]),
        ("decode parol6 --file /nonexistent", "", 2, ["!/nonexistent"]),
        ("emulate parol6 --speed 0", "", 2, ["!speed"]),
        ("emulate parol6 --set fault=zero:nothing", "", 2, ["!fields: start"]),
        ("trace verify /nonexistent", "", 2, ["!/nonexistent"]),
        ("emulate morap --set nodes=x", "", 2, ["!nodes=x"]),
        ("emulate morap --pty", "", 2, ["!a bus takes --set, --bus, --usb, --usbip, --json and --check"]),
        ("i2c read 0x80 1 --target emulated:", "", 2, ["!ADDRESS"]),
        ("i2c write 0x12 1 --target emulated:", "", 2, ["!missing its partner"]),
        ("i2c scan --target tcp:localhost:1", "", 2, ["!i2c:/dev/i2c-N"]),
        ("i2c scan --target emulated:?node=1", "", 2, ["!no such option"]),
        ("morap tune --type pd --inertia 0.2 --pole 9", "", 2, ["!below 0"]),
        ("morap tune --type x --inertia 0.2 --pole -9", "", 2, ["!--type"]),
        ("morap program /nonexistent --target emulated:", "", 2, ["!/nonexistent"]),
        ("morap simulate --inertia 0.2", "", 2, ["!--params"]),
        ("watch morap --target emulated:", "", 2, ["!--seconds"]),
        ("lab exec -- true", "", 2, ["!--i2c"]),
        ("i2c scan --target i2c:/nonexistent", "", 3, ["!no such bus"]),
        ("i2c scan --target i2c:/dev/null", "", 2, ["!not an I2C bus"]),
        ("i2c read 0x13 1 --target emulated:", "", 3, ["!0x13"]),
        ("morap read-params --target emulated: --node 3", "", 3, ["!0x13"]),
        # Targets that are not there: 3. Nothing selected: 4.
        ("conformance parol6 --target pty:/nonexistent", "", 3, ["!/nonexistent"]),
        ("conformance parol6 --target serial:/nonexistent", "", 3, ["!/nonexistent"]),
        ("conformance parol6 --target serial:/dev/null", "", 2, ["!not a serial port"]),
        ("conformance parol6 --target serial:/dev/x,fast", "", 2, ["!serial:PATH,BAUD"]),
        ("conformance parol6 --target usb:0483", "", 2, ["!usb:0483:5740"]),
        ("conformance parol6 --target usb:ffff:fffe", "", 3, ["!plugged in"]),
        ("conformance parol6 --target serial:ffff:fffe:1", "", 3, ["!plugged in"]),
        ("emulate parol6 --usb-serial 7", "", 2, ["!--usb or --usbip"]),
        ("emulate parol6 --usbip 0 --usb-serial", "", 2, ["!--usb-serial"]),
        ("conformance parol6 --target emulated: --filter nothing-like-that", "", 4, ["!--list"]),
        (f"trace verify {other}", "", 4, ["!toaster", "traces: 0 identical: 0 different: 0"]),
        # What it is for.
        ("i2c scan --target emulated:?nodes=1,2&pen=yes", "", 0, ["0x11", "0x12", "0x19"]),
        ("i2c read 0x12 1 --select 83 --target emulated:", "", 0, ["needs_calibration"]),
        ("i2c scan --target emulated: --impair loss=100%", "", 4, ["!nobody answers"]),
        ("i2c scan --target emulated: --impair reorder=1%", "", 2, ["!'reorder=1%'", "!an I2C bus can"]),
        (f"i2c read 0x12 1 --select 83 --target emulated: --capture {logged}", "", 0, []),
        (f"decode morap --file {logged}", "", 0, ["needs_calibration"]),
        (f"morap read-params --target emulated: --capture {folder}/no/log", "", 3, ["!/no/log"]),
        ("decode morap 24 80", "", 0, ["128 (read_angle)"]),
        (f"decode morap --file {SOURCE}/captures/morap/bus-scan.jsonl", "", 1,
         ["poke", "cut short", "!transactions without an answer"]),
        (f"decode morap --file {SOURCE}/captures/morap/loop-voltage.jsonl --json", "", 0,
         ["read_current"]),
        (f"decode kinovazed --file {two}", "", 0, ["Freeze", "EStop"]),
        (f"conformance kinovazed --target emulated: --filter connection --capture {served}", "", 0,
         [" passed, 0 failed"]),
        (f"decode kinovazed --file {served} --json", "", 1,  # an empty line is one of the cases
         ['"t_us"', "Heartbeat"]),
        ("morap tune --type pd --inertia 0.2 --pole -9", "", 0,  # reference vector 42
         ["2200cdcc4c3e000010c1", "00900102364b03c1513f1441022c4b03c1473f144101fed774bf000000001a"]),
        ("morap read-params --target emulated:", "", 0, ["d = [-1.5711", "rate_hz = 500"]),
        ("morap simulate --type pid --inertia 0.2 --pole -6 --step 0.3 --current 100", "", 0,
         ["overshoot"]),
        ("watch morap --target emulated:?nodes=1,2 --count 1 --json", "", 0, ['"node":2']),
        ("console morap --target emulated:", "calibrate\ngoto 0.5\nwait 2\nstatus\n", 0,
         ["0.49", "enabled"]),
        ("console morap --target emulated:", "node 3\nstatus\n", 1, ["!nobody"]),
        ("console morap --target emulated:", "fly\n", 2, ["!'help'"]),
        ("--version", "", 0, ["armjig 0."]),
        ("--help", "", 0, ["armjig emulate parol6", "Exit codes"]),
        ("conformance parol6 --list", "", 0, ["parol6.frame.burst"]),
        ("conformance parol6 --explain parol6.frame.burst", "", 0, ["must", "source"]),
        ("conformance parol6 --target emulated:", "", 0, [" passed, 0 failed"]),
        ("conformance parol6 --target emulated: --profile documented", "", 0,
         [" passed, 0 failed"]),
        ("conformance parol6 --target emulated:?profile=firmware --profile documented", "", 0,
         [" passed, 0 failed, "," deviated"]),
        ("conformance parol6 --target emulated: --profile shipped", "", 2, ["!--profile"]),
        ("conformance parol6 --target emulated: --tier slow", "", 2, ["!--tier"]),
        ("conformance parol6 --target emulated: --shard 3/2", "", 2, ["!--shard 3/2"]),
        ("conformance parol6 --target emulated: --repeat 0", "", 2, ["!--repeat"]),
        ("conformance parol6 --target emulated: --waivers /nonexistent", "", 2, ["!/nonexistent"]),
        ("conformance parol6 --list --filter nothing-like-that", "", 4, ["!--list"]),
        ("conformance parol6 --explain nothing-like-that", "", 2, ["!--list"]),
        ("conformance diff /nonexistent /nonexistent", "", 2, ["!/nonexistent"]),
        ("conformance mutants parol6 --filter nothing-like-that", "", 4, ["!--list"]),
        ("conformance mutants demo", "", 0, ["100.0 %", "0 failed"]),
        ("conformance demo --target emulated:", "", 0, ["3 passed, 0 failed"]),
        (f"conformance parol6 --target {faulty}", "", 1,
         ["expected     speed.j1", "FF FF FF 38", f"--target '{faulty}' --filter",
          "> speed.j1 = 6488064 steps/s = 0x630000 (bytes 22 to 24: 63 00 00)", "... 44 more",
          "\nFAIL      parol6.receive.store-stays           expected speed.j1 = 99 steps/s = 0x000063"]),
        ("conformance kinovazed --target emulated:?fault=bit-high:4 --filter kinovazed.beat.values",
         "", 1, ["< Heartbeat:19", "> state = isIdle hasEmergencyStop isConnected (0x13)"]),
        ("conformance morap --target emulated:?fault=in:doubled:program.d.0 "
         "--filter morap.program.position", "", 1,
         ["\n            > d.0 = 1.7014118e+38 = 0x7F000000 (bytes 5 to 8: 00 00 00 7F)"]),
        ("conformance demo --target emulated: --color always", "", 0,
         ["\x1b[32mPASS     \x1b[0m demo.query", "\x1b[32m3 passed\x1b[0m"]),
        ("conformance demo --target emulated:", "", 0, ["PASS      demo.query", "\n3 passed, 0 failed"]),
        ("conformance demo --target emulated: --color sometimes", "", 2, ["!--color"]),
        (f"decode parol6 {IDLE} -v", "", 0, ["command            255 (idle)"]),
        (f"decode parol6 {IDLE}", "", 0, ["to_device   command  command 255 (idle)  check 228\n"]),
        (f"decode parol6 --file {SOURCE}/captures/parol6/outputs_sweep_a.jsonl", "", 0,
         ["       2.000 ms to_device   command  command 255 (idle)", "ms from_device telemetry  homed"]),
        ("decode parol6 --file - --json", IDLE, 0, ['"armjig.message/1"', '"text":"255 (idle)"']),
        ("decode parol6 --file -", "", 4, ["!no bytes"]),
        (f"decode parol6 --direction to-device {IDLE[:40]}", "", 1, ["cut short"]),
        (f"decode parol6 --file {RECORDING}", "", 0, ["out1"]),
        (f"trace verify {RECORDING}", "", 0, ["identical", "traces: 1 identical: 1 different: 0"]),
        (f"trace verify {different} {RECORDING}", "", 1,
         [f"corrupted.jsonl:{line}:", "io: expected", "traces: 2 identical: 1 different: 1"]),
        (f"trace verify {broken} {RECORDING}", "", 2,
         ["!broken.jsonl:2:", "traces: 1 identical: 1 different: 0"]),
        ("devices --json", "", 0, ['"armjig.devices/1"']),
        ("doctor --udev-rules", "", 0, ['idVendor}=="0483"']),
        ("completion bash", "", 0, ["complete -o default -F _armjig armjig"]),
        ("completion zsh", "", 0, ["#compdef armjig"]),
        ("completion fish", "", 0, ["complete -c armjig"]),
        ("kin fk 90 -90 180 0 0 180", "", 0, ["262.5700", "commander"]),
        ("kin fk 0 0 0 0 0 0", "", 1, ["114.6700", "!j2 is beyond its limits"]),
        ("kin fk 1 2", "", 2, ["!6 joints"]),
        ("kin fk 1 --arm /bin/sh", "", 2, ["!not a robot description"]),
        ("kin ik 0 262.57 288.75 -90 0 -90 --json", "", 0, ["armjig.kin/1", "closed form"]),
        ("kin ik 900 0 0 0 0 0", "", 1, ["!out of reach"]),
        ("kin limits --arm jaco2", "", 0, ["313.0000"]),
        ("watch parol6 --target emulated: --seconds 2", "", 0, ["estop released", "0 lost"]),
        ("watch parol6 --target emulated: --seconds 1 --json", "", 0, ["armjig.telemetry/1"]),
        ("console parol6 --target emulated:", "enable\njog j1 500 0.2\n# a remark\nstatus\nquit\n",
         0, ["j1           100"]),
        ("console parol6 --target emulated:", "home\nstatus\n", 0, ["homed"]),
        ("console parol6 --target emulated:", "home\njog world z 20 1\njog tool ry -5deg 1\n", 0,
         ["the tool is at 0.000 262.5"]),
        ("console parol6 --target emulated:", "jog world z 20 1\n", 1, ["!line 1: not homed"]),
        ("console parol6 --target emulated:", "jog world z 61\n", 2, ["!at most 60 mm/s"]),
        ("console parol6 --target emulated:", "disable\njog j1 500 1\n", 1, ["!line 2"]),
        ("console parol6 --target emulated:", "frobnicate\n", 2, ["!line 1", "!frobnicate"]),
        ("console kinovazed --target emulated:",
         "quitestop\ninitialize\nmode XYZ\nmove 100 0 0 1\nrun Home\nretract\nwait 1.5\nstatus\n", 0,
         ["Initialize is done", "RunObjective:Home is done", "retracted"]),
        ("console kinovazed --target emulated:", "initialize\n", 1, ["!was rejected"]),
        ("console kinovazed --target emulated:", "run Nowhere\nmove 1 2\n", 2,
         ["!'Nowhere' is none of", "!usage: move X Y Z"]),
        ("console kinovazed --target tcp:127.0.0.1:1", "status\n", 3, ["!is the server running?"]),
        ("console kinovazed --target pty:/dev/null", "status\n", 2, ["!tcp:HOST:PORT"]),
        ("watch kinovazed --target emulated: --count 3", "", 0, ["emergency stop", "3 beats"]),
        # Programs.
        (f"script check {examples}/speeds.rbt", "", 0, ["speeds.rbt:7:1: note: takes"]),
        (f"script check {examples}/speeds.rbt --dialect commander", "", 2,
         ["speeds.rbt:1:1: error: there are no comments"]),
        ("script check -", "Begin()\nGripper(1, 2, 300)\nMoveJoint(90, -90, 180, 0, 0, 170)\nEnd()",
         1, ["-:3:1: warning: the gripper is not waited for", "note: takes"]),
        ("script check - --dialect commander", "Begin()\nHome()\nEnd()", 1, ["-:2:1: error"]),
        ("script format -", "Begin( )\n  Delay(1.50) //x\nEnd()", 0,
         ["Begin()\nDelay(1.5)  //x\nEnd()\n"]),
        ("script format -", "Begin()\nDelay(1", 2, ["!-:2:8: error: the ')' is missing"]),
        ("script", "", 2, ["!subcommand"]),
        (f"plan {examples}/joint6.rbt", "", 0, ["t=2, trap)", "j6", "!takes 12"]),
        (f"plan {examples}/joint6.rbt --csv -", "", 0, ["frame,time_s,line,command,j1_pos"]),
        (f"plan {examples}/joint6.rbt --json -", "", 0, ['"schema":"armjig.plan/1"']),
        (f"plan {examples}/joint6.rbt --capture -", "", 0, ['"golden-trace/1"', "ffffff34002800"]),
        (f"plan {examples}/joint6.rbt --html -", "", 0, ["<!doctype html>", "data-scene"]),
        ("plan - --from power-up", "Begin()\nMoveJoint(10, 10, 10, 10, 10, 10, t=4)\nEnd()", 0,
         ["10.00 deg"]),
        (f"plan {examples}/joint6.rbt --from 1,2", "", 2, ["!--from 1,2"]),
        (f"plan {examples}/joint6.rbt --from 99999999,0,0,0,0,0", "", 2, ["!--from 9"]),
        (f"plan {examples}/joint6.rbt --on-singularity hope", "", 2, ["!hope"]),
        (f"plan {folder}", "", 2, ["!cannot be read"]),
        ("plan /nonexistent", "", 2, ["!/nonexistent"]),
        (f"plan {binary}", "", 2, ["!binary.rbt:1:1: error: byte 0x00: this is no text"]),
        ("latency demo --target emulated: --count 200 --json -", "", 0,
         ['"schema": "armjig.latency/1"', '"is_virtual": true']),
        ("latency demo --target emulated: --count 200 --impair in.delay=5ms --limit p99<6ms", "", 1,
         ["FAIL", "p99<6ms: 6.000 ms"]),
        ("latency demo --target emulated: --count 2000 --against emulated:", "", 0,
         ["no difference"]),
        ("latency morap --target emulated:?nodes=3 --count 200", "", 0,
         ["bus time of an angle", "670.0 us"]),
        ("latency parol6 --target emulated: --seconds 2 --limit lost<1,skipped<1", "", 0,
         ["the board's timing field", "200 answered"]),
        ("latency kinovazed --target emulated: --seconds 3", "", 0, ["heartbeat period, mean"]),
        (f"latency kinovazed --from {captures}/kinovazed/connection-reconnect-idle.jsonl", "", 0,
         ["3 answered", "Initialize to Initialized", "left out"]),
        ("latency morap --from - --json -", "#[a log]\n", 2, ["!no answer"]),
        ("latency demo --target emulated: --count 100 --sweep rate=50,200 --limit max<2ms", "", 0,
         ["Side by side", "rate=200: max<2ms", "rate=50: Round trips"]),
        ("latency demo --target emulated: --count 100 --sweep burst=1,4 --json -", "", 0,
         ['"armjig.latency-runs/1"', '"name": "burst=4"']),
        ("latency parol6 --target emulated: --count 100 --cost --cost-limit 60 --json -", "", 0,
         ['"unit": "steps"', '"highest_rate_hz": 1000.0']),
        ("latency morap --target emulated:?nodes=3 --count 100 --cost", "", 0,
         ["steps of the encoder", "is 500 Hz"]),
        ("latency demo --target emulated: --count 100 --cost", "", 2, ["!no loop"]),
        ("latency parol6 --target emulated: --count 20 --hlog -", "", 0, ["Tag=corrected,"]),
        (f"run {examples}/outputs.rbt --target emulated: --unhomed", "", 0, ["Tracking"]),
        (f"run {examples}/outputs.rbt --target emulated: --unhomed --json", "", 0,
         ['"schema":"armjig.run/1"', '"ran_to_end":true']),
        (f"run {examples}/joint6.rbt --target emulated:", "", 3, ["!is not homed: --home"]),
        (f"run {examples}/joint6.rbt", "", 2, ["!--target is missing"]),
        (f"run {examples}/pick_and_place.rbt --target pty:/nonexistent --allow state", "", 3,
         ["!needs --allow grip,move"]),
        (f"run {binary} --target emulated: --capture {silent}", "", 2, ["!this is no text"]),
    ] + [(command, "", 2, ["!'toaster': no such device", "!there are: parol6, kinovazed, morap, demo"])
         for command in ("conformance toaster --target emulated:", "conformance mutants toaster",
                         "console toaster --target emulated:", "watch toaster --target emulated:",
                         "decode toaster 00", "emulate toaster")
    ] + [(f"{command} {path} {more}", "", 2, [f"!{name}.rbt:2:"])
         for name, path in wrong.items()
         for command, more in (("plan", ""),
                               ("run", f"--target emulated: --home --capture {silent}"))]


def check(arguments, typed, exit_code, words):
    """What is wrong, or nothing."""
    run = subprocess.run([ARMJIG] + arguments.split(), input=typed, capture_output=True, text=True,
                         timeout=120)
    complaints = [] if run.returncode == exit_code else [f"exit code {run.returncode}, not {exit_code}"]
    for word in words:
        stream, wanted = (run.stderr, word[1:]) if word.startswith("!") else (run.stdout, word)
        if wanted not in stream:
            complaints.append(f"no '{wanted}'")
    if any(word.startswith("!") for word in words) and len(run.stderr.splitlines()) > 3:
        complaints.append("more than a few lines of errors")
    if complaints:
        complaints.append(f"\n--- stdout\n{run.stdout[-2000:]}\n--- stderr\n{run.stderr[-2000:]}")
    return ", ".join(complaints)


def on_terminal(arguments, environment, columns=0):
    """What the program prints on a terminal so many columns wide; 0: one that does not know."""
    user_end, terminal = pty.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("4H", 24, columns, 0, 0))
    with subprocess.Popen([ARMJIG] + arguments.split(), stdin=terminal, stdout=terminal,
                          env={"TERM": "xterm"} | environment) as program:
        os.close(terminal)
        text = b""
        try:
            while piece := os.read(user_end, 65536):
                text += piece
        except OSError:  # nobody has the other end any more
            pass
        program.wait(timeout=60)
    os.close(user_end)
    return text.decode()


def widest(text):
    return max(len(line) for line in text.splitlines())


def complaints_of_terminals():
    """What is wrong with colours and the width of help."""
    run = "conformance demo --target emulated:"
    for environment, more, is_coloured in [
            ({}, "", True), ({"NO_COLOR": "1"}, "", False), ({"NO_COLOR": ""}, "", True),
            ({"TERM": "dumb"}, "", False), ({"NO_COLOR": "1"}, " --color always", True),
            ({}, " --color never", False)]:
        if ("\x1b[32mPASS" in on_terminal(run + more, environment)) != is_coloured:
            yield f"with {environment}{more}: {'no ' if is_coloured else ''}colours"
    for environment, columns, width in [({}, 0, 80), ({}, 100, 100), ({}, 20, 60),
                                        ({"COLUMNS": "70"}, 100, 70), ({"COLUMNS": "x"}, 90, 90)]:
        got = widest(on_terminal("--help", environment, columns))
        if not width - 12 <= got <= width:
            yield f"help with {environment} on {columns} columns is {got} wide, not {width}"
    piped = subprocess.run([ARMJIG, "--help"], env={}, capture_output=True, text=True, check=True)
    if widest(piped.stdout) > 80:
        yield f"help is {widest(piped.stdout)} wide in a pipe"


def main():
    failures = 0
    for complaint in complaints_of_terminals():
        failures += 1
        print(complaint)
    with tempfile.TemporaryDirectory() as name:
        table = rows(pathlib.Path(name))
        for row in table:
            complaint = check(*row)
            if (pathlib.Path(name) / "wire.jsonl").exists():
                complaint += "something was sent"
            if complaint:
                failures += 1
                print(f"armjig {row[0]}: {complaint}")
    print(f"{failures} of {len(table)} command lines and of the terminals misbehave")
    return 1 if failures else 0


sys.exit(main())
