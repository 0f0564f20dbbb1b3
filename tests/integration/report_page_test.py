#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Opens report pages in headless Chromium and uses them: report_page_test.py [--keep DIR] PAGE...

Each page is opened at 1280 and 390 pixels, light and dark. The test fails on any message in the
console, any request but the page's own, anything wider than the window, and if search, filters or
keys do not do what they say. Screenshots stay in DIR, or in a new temporary folder; it says where.

Chromium is driven through its DevTools protocol on a pair of pipes, so nothing but the standard
library is needed. CHROMIUM names another binary.
"""

import argparse
import base64
import hashlib
import json
import os
import pathlib
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 60
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe",
]
SIZES = {"wide": (1280, 900), "phone": (390, 844)}


class Browser:
    """One Chromium with one tab."""

    def __init__(self, profile):
        binary = os.environ.get("CHROMIUM") or shutil.which("chromium")
        if not binary:
            sys.exit("report_page_test: chromium is not installed (Debian: apt install chromium)")
        command_read, self.command = os.pipe()
        self.answer, answer_write = os.pipe()

        def at_3_and_4():  # where --remote-debugging-pipe looks
            copies = [os.dup(command_read), os.dup(answer_write)]
            os.dup2(copies[0], 3)
            os.dup2(copies[1], 4)

        self.process = subprocess.Popen(
            [binary, *FLAGS, f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=at_3_and_4, close_fds=False,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_read)
        os.close(answer_write)
        self.buffer = b""
        self.last_id = 0
        self.events = []
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        tab = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self.session = tab["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def close(self):
        try:
            os.close(self.command)
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def read(self, deadline):
        """The next message; None after the deadline."""
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.answer], [], [], max(0, deadline - time.monotonic()))
            if not ready:
                return None
            piece = os.read(self.answer, 1 << 16)
            if not piece:
                sys.exit("report_page_test: chromium ended unexpectedly")
            self.buffer += piece
        message, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(message)

    def call(self, method, **params):
        self.last_id += 1
        message = {"id": self.last_id, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.command, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE_S
        while (answer := self.read(deadline)) is not None:
            if answer.get("id") == self.last_id:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)
        raise RuntimeError(f"{method}: no answer from chromium in {PATIENCE_S} s")

    def wait_for(self, event):
        deadline = time.monotonic() + PATIENCE_S
        while event not in [seen.get("method") for seen in self.events]:
            message = self.read(deadline)
            if message is None:
                raise RuntimeError(f"no {event} from chromium in {PATIENCE_S} s")
            self.events.append(message)

    def open(self, url, size, scheme):
        width, height = SIZES[size]
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=size == "phone")
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.events.clear()
        self.call("Page.navigate", url=url)
        self.wait_for("Page.loadEventFired")

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def type(self, text):
        for key in text:
            self.call("Input.dispatchKeyEvent", type="keyDown", key=key, text=key)
            self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def press(self, key, code, text=""):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, text=text,
                      windowsVirtualKeyCode=code)

    def screenshot(self, path, whole_page=True):
        """The whole page up to a height that Chromium can take; the window if it is longer."""
        is_long = self.evaluate("document.documentElement.scrollHeight") > 12000
        data = self.call("Page.captureScreenshot", format="png",
                         captureBeyondViewport=whole_page and not is_long)
        path.write_bytes(base64.b64decode(data["data"]))

    def complaints(self):
        """What the console says, exceptions, and requests for anything but the page."""
        self.evaluate("1")  # whatever happened before is reported before the answer
        found = []
        for event in self.events:
            method, params = event.get("method"), event.get("params", {})
            if method == "Runtime.consoleAPICalled":
                found.append(f"console: {params['args']}")
            elif method == "Runtime.exceptionThrown":
                found.append(f"exception: {params['exceptionDetails']}")
            elif method == "Log.entryAdded":
                found.append(f"log: {params['entry']['text']}")
            elif method == "Network.requestWillBeSent":
                url = params["request"]["url"]
                is_page = url.startswith("file:") and params["type"] == "Document"
                if not is_page and not url.startswith("data:"):
                    found.append(f"request: {url}")
        return found


class Check:
    def __init__(self):
        self.failures = 0

    def equal(self, what, expected, actual):
        if expected != actual:
            self.failures += 1
            print(f"FAIL  {what}: expected {expected!r}, got {actual!r}")


def check_script_hash(check, name, html):
    script = re.search(r"<script>(.*)</script>\s*</body>", html, re.S).group(1)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = re.search(r"script-src '([^']*)'", html).group(1)
    check.equal(f"{name}: kScriptHash in harness/report/page.hpp", f"sha256-{digest}", policy)


VISIBLE = "[...document.querySelectorAll('.row')].filter(row => row.checkVisibility())"
SEARCH = "document.getElementById('search')"


def check_looks(check, browser, page, folder):
    for size in SIZES:
        for scheme in ("light", "dark"):
            what = f"{page.name} {size} {scheme}"
            browser.open(page.as_uri(), size, scheme)
            check.equal(f"{what}: complaints", [], browser.complaints())
            width = SIZES[size][0]
            check.equal(f"{what}: width of the page", width,
                        browser.evaluate("document.documentElement.scrollWidth"))
            is_dark = browser.evaluate(
                "getComputedStyle(document.body).backgroundColor.match(/\\d+/g)[0] < 128")
            check.equal(f"{what}: is dark", scheme == "dark", is_dark)
            browser.screenshot(folder / f"{page.stem}-{size}-{scheme}.png")


def check_use(check, browser, page):
    """Search and filters against what the page itself says of its rows."""
    what = page.name
    browser.open(page.as_uri(), "wide", "light")
    verdicts = browser.evaluate(
        "[...document.querySelectorAll('.row')].map(row => row.dataset.verdict)")
    if not verdicts:
        return
    count = f"{VISIBLE}.length"
    check.equal(f"{what}: rows at first", len(verdicts), browser.evaluate(count))

    name = browser.evaluate("document.querySelector('.row .name').textContent")
    word = re.match(r"[\w.]+", name).group(0)
    has_word = f"row.textContent.toLowerCase().includes({json.dumps(word.lower())})"
    hits = browser.evaluate(
        f"[...document.querySelectorAll('.row')].filter(row => {has_word}).length")
    browser.type("/")
    check.equal(f"{what}: / goes to the search", True,
                browser.evaluate(f"document.activeElement === {SEARCH}"))
    browser.type(word.upper())
    check.equal(f"{what}: rows with {word}", hits, browser.evaluate(count))
    browser.type(" no-such-word-anywhere")
    check.equal(f"{what}: rows with no such word", 0, browser.evaluate(count))
    check.equal(f"{what}: says so", "Nothing matches.",
                browser.evaluate("document.getElementById('shown').textContent"))
    check.equal(f"{what}: no empty topics", 0, browser.evaluate(
        "[...document.querySelectorAll('.topic')].filter(t => t.checkVisibility()).length"))
    browser.press("Escape", 27)
    check.equal(f"{what}: rows after Escape", len(verdicts), browser.evaluate(count))

    for verdict in sorted(set(verdicts)):
        button = f"document.querySelector('.filters button[data-verdict={verdict}]')"
        browser.evaluate(f"{button}.focus()")
        browser.press("Enter", 13, "\r")
        shown = set(browser.evaluate(f"{VISIBLE}.map(row => row.dataset.verdict)"))
        check.equal(f"{what}: filter {verdict}", {verdict}, shown)
        browser.evaluate(f"{button}.click()")
    check.equal(f"{what}: rows without filter", len(verdicts), browser.evaluate(count))

    browser.evaluate("document.getElementById('unfold').click()")
    check.equal(f"{what}: all open", True, browser.evaluate(f"{VISIBLE}.every(row => row.open)"))
    browser.evaluate("document.getElementById('theme').click()")
    check.equal(f"{what}: theme", "dark",
                browser.evaluate("document.documentElement.dataset.theme"))
    browser.evaluate("document.getElementById('theme').click(); localStorage.clear()")
    check.equal(f"{what}: complaints after use", [], browser.complaints())


def check_scene(check, browser, page):
    """The slider sets the time of what is drawn."""
    browser.open(page.as_uri(), "phone", "dark")
    if not browser.evaluate("document.querySelector('.scene') !== null"):
        return
    what = f"{page.name} scene"
    sticks = "document.querySelector('.scene .sticks').getAttribute('d')"
    slider = "document.querySelector('.scene input')"
    first = browser.evaluate(sticks)
    check.equal(f"{what}: is drawn", True, first.startswith("M"))
    browser.evaluate(f"{slider}.focus()")
    browser.press("End", 35)
    check.equal(f"{what}: is at the end", True,
                browser.evaluate(f"{slider}.value === {slider}.max"))
    check.equal(f"{what}: has moved", True, browser.evaluate(sticks) != first)
    check.equal(f"{what}: complaints", [], browser.complaints())


def check_timeline(check, browser, page):
    """Marks go to their messages, messages to their moment; keys zoom."""
    browser.open(page.as_uri(), "wide", "light")
    if not browser.evaluate("document.querySelector('.timeline') !== null"):
        return
    what = f"{page.name} time line"
    view = "document.querySelector('.strip svg').getAttribute('viewBox')"
    chosen = "document.querySelector('.messages .chosen')?.id ?? ''"
    whole = browser.evaluate(view)
    mark = "document.querySelector('.lane:last-of-type a, .lane a')"
    wanted = browser.evaluate(f"{mark}.getAttribute('href').slice(1)")
    browser.evaluate(f"{mark}.dispatchEvent(new MouseEvent('click', "
                     "{bubbles: true, cancelable: true}))")
    check.equal(f"{what}: message of a mark", wanted, browser.evaluate(chosen))
    check.equal(f"{what}: focus is on it", wanted,
                browser.evaluate("document.activeElement.closest('tr')?.id ?? ''"))
    browser.press("ArrowDown", 40)
    check.equal(f"{what}: the next message", True,
                browser.evaluate(chosen) not in (wanted, ""))
    check.equal(f"{what}: its moment is marked", True,
                browser.evaluate("[...document.querySelectorAll('.strip i')].every(i => !i.hidden)"))
    browser.evaluate("document.querySelector('.timeline .plot').focus()")
    browser.type("+")
    check.equal(f"{what}: zoomed", True, browser.evaluate(view) != whole)
    browser.type("0")
    check.equal(f"{what}: all again", whole, browser.evaluate(view))
    check.equal(f"{what}: complaints", [], browser.complaints())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="for the screenshots")
    parser.add_argument("pages", type=pathlib.Path, nargs="+", metavar="PAGE")
    arguments = parser.parse_args()
    folder = arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="armjig-report-page-"))
    folder.mkdir(parents=True, exist_ok=True)
    check = Check()
    with tempfile.TemporaryDirectory(prefix="armjig-chromium-", ignore_cleanup_errors=True) as home:
        browser = Browser(home)
        try:
            for page in arguments.pages:
                page = page.resolve()
                check_script_hash(check, page.name, page.read_text(encoding="utf-8"))
                check_looks(check, browser, page, folder)
                check_use(check, browser, page)
                check_scene(check, browser, page)
                check_timeline(check, browser, page)
        finally:
            browser.close()
    print(f"screenshots in {folder}", flush=True)
    if check.failures:
        sys.exit(f"{check.failures} failed")
    print(f"passed: {len(arguments.pages)} pages")


if __name__ == "__main__":
    main()
