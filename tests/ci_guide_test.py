# SPDX-License-Identifier: Apache-2.0
"""What docs/ci.md shows works, as far as it does without GitHub and GitLab.

The workflow, the template, the scripts and the test file are taken from the page and put beside the host program
of docs/spec/parol6.md. The shell commands of each job run with `sh -e`. Left out, by rule: steps with
`uses`, commands that call apt-get, images and runners. A TARGET that is a serial port becomes an
emulated board. Then the same with a wrong program and a wrong board, which every job has to notice.

    /usr/bin/python3 tests/ci_guide_test.py build/release/cli/armjig .
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import yaml

import example_guide

# On a machine that has no time for the program its rhythm is bad, too: then it may try again.
TRIES = 3
WRONG_PROGRAM = ("bytes(9)", "bytes(8) + b'\\x14'")  # node 20 of the gripper's bus
WRONG_BOARD = "emulated:?fault=swap-bytes:speed.j3"


def github_jobs(text):
    """Of each job: name, shell commands, environment, files that it hands on."""
    workflow = yaml.safe_load(text)
    assert workflow.keys() == {"name", True, "permissions", "jobs"}, workflow.keys()  # True: "on"
    for name, job in workflow["jobs"].items():
        assert job.keys() <= {"runs-on", "container", "env", "steps"}, job.keys()
        for step in job["steps"]:
            assert ("run" in step) != ("uses" in step), step
        yield (name, [step["run"] for step in job["steps"] if "run" in step], job.get("env", {}),
               [step["with"]["sarif_file"] for step in job["steps"] if "with" in step])


def gitlab_jobs(text):
    for name, job in yaml.safe_load(text).items():
        assert job.keys() <= {"image", "before_script", "script", "tags", "variables",
                              "artifacts"}, job.keys()
        lines = job.get("before_script", []) + job["script"]
        assert all(isinstance(line, str) for line in lines), lines
        yield name, ["\n".join(line for line in lines if "apt-get" not in line)], \
            job.get("variables", {}), list(job["artifacts"]["reports"].values())


def is_report(path):
    """Something that was checked stands in it."""
    if path.suffix == ".sarif":
        run = json.loads(path.read_text(encoding="utf-8"))["runs"][0]
        return len(run["tool"]["driver"]["rules"]) > 0
    return int(xml.etree.ElementTree.parse(path).getroot().get("tests")) > 0


class Project:
    """Somebody else's project in a folder of its own."""

    def __init__(self, folder, armjig, files):
        self.folder = pathlib.Path(folder)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/armjig").symlink_to(pathlib.Path(armjig).resolve())
        for name, text in files.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text(text, encoding="utf-8")

    def run(self, command, variables):
        """Whether it ended well."""
        path = f"{self.folder}/bin:/usr/bin:/bin"  # Debian's Python has pyserial
        run = subprocess.run(command, cwd=self.folder, env={**os.environ, **variables, "PATH": path},
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, timeout=60, check=False, text=True)
        self.said = run.stdout
        return run.returncode == 0

    def passes(self, job, target):
        _, commands, variables, reports = job
        variables = {name: target if value.startswith("serial:") else value
                     for name, value in variables.items()}
        commands = [command for command in commands if "apt-get" not in command]
        assert commands, job
        for report in reports:
            (self.folder / report).unlink(missing_ok=True)
        passed = all([self.run(["sh", "-e", "-c", command], variables) for command in commands])
        assert all(is_report(self.folder / report) for report in reports), (job, self.said)
        return passed

    def passes_captures(self):
        """The script on a corpus, with its rules."""
        return self.run(["sh", "-e", "captures.sh"], {"TARGET": "emulated:"}) and \
            is_report(self.folder / "captures.xml")

    def record_corpus(self):
        (self.folder / "corpus").mkdir()
        assert self.run(["armjig", "watch", "parol6", "--target", "emulated:", "--count", "20",
                         "--capture", "corpus/look.jsonl"], {}), self.said

    def spoil_corpus(self):
        """In one answer a byte is another one."""
        file = self.folder / "corpus/look.jsonl"
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        place = next(i for i, line in enumerate(lines) if "from_device" in line)
        lines[place] = lines[place].replace("ffffff00", "ffffff01").replace("ffffff38", "ffffff37")
        file.write_text("".join(lines), encoding="utf-8")

    def passes_pytest(self):
        return self.run(["python3", "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_host.py"],
                        {})


def main(armjig, root):
    root = pathlib.Path(root)
    files = example_guide.named_blocks(root / "docs/ci.md")
    host = example_guide.named_blocks(root / "docs/spec/parol6.md")["host.py"]
    assert host.count(WRONG_PROGRAM[0]) == 1
    jobs = [*github_jobs(files[".github/workflows/arm.yml"]), *gitlab_jobs(files[".gitlab-ci.yml"])]
    assert [job[0] for job in jobs] == ["program", "board"] * 2
    with tempfile.TemporaryDirectory() as folder:
        project = Project(folder, armjig, {**files, "host.py": host})
        for job in jobs:
            assert any(project.passes(job, "emulated:") for _ in range(TRIES)), (job, project.said)
        assert any(project.passes_pytest() for _ in range(TRIES)), project.said
        project.record_corpus()
        assert project.passes_captures(), project.said
        project.spoil_corpus()
        assert not project.passes_captures(), project.said
        (project.folder / "host.py").write_text(host.replace(*WRONG_PROGRAM))
        for job in jobs:
            assert not project.passes(job, WRONG_BOARD), (job, project.said)
        assert not project.passes_pytest() and "gripper.id was 20" in project.said, project.said
    print(f"ok: {len(jobs)} jobs and pytest")


main(*sys.argv[1:])
