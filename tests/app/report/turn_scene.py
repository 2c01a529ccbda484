# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""turn_scene.py REPORT.html FOLDER: opens a report in headless Chromium without a network, drags the first scene
by the mouse and turns the wheel. Prints what it saw as JSON. FOLDER is for Chromium's own files."""
import json
import os
import pathlib
import subprocess
import sys

DRAG_PX = (120, 40)
READ_SCENE = """(() => {
  const canvas = document.querySelector(".scene canvas");
  canvas.scrollIntoView({block: "center", behavior: "instant"});
  const box = canvas.getBoundingClientRect();
  return {x: box.x + box.width / 2, y: box.y + box.height / 2, height: canvas.clientHeight,
          yaw: +canvas.dataset.yaw, pitch: +canvas.dataset.pitch, distance: +canvas.dataset.distance,
          drawn: +canvas.dataset.drawn, pixels: canvas.toDataURL()};
})()"""
NEXT_FRAME = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))"


class Browser:
    """Chromium, controlled through its DevTools protocol on two pipes."""

    def __init__(self, folder):
        to_read, self.write_end = os.pipe()
        self.read_end, to_write = os.pipe()

        def give_pipes():
            # Chromium reads from descriptor 3 and writes to 4.
            inner, outer = os.dup(to_read), os.dup(to_write)
            os.dup2(inner, 3)
            os.dup2(outer, 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
             "--disable-dev-shm-usage", "--proxy-server=127.0.0.1:9", "--host-resolver-rules=MAP * ~NOTFOUND",
             "--window-size=1280,900", "--remote-debugging-pipe", f"--user-data-dir={folder}", "about:blank"],
            preexec_fn=give_pipes, close_fds=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.events, self.buffer, self.last, self.session = [], b"", 0, None

    def message(self):
        while b"\0" not in self.buffer:
            part = os.read(self.read_end, 1 << 16)
            if not part:
                raise SystemExit("Chromium has ended")
            self.buffer += part
        one, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(one)

    def call(self, method, **parameters):
        self.last += 1
        request = {"id": self.last, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.write_end, json.dumps(request).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.last:
                if "error" in answer:
                    raise SystemExit(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, event):
        while not any(one.get("method") == event for one in self.events):
            self.events.append(self.message())

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise SystemExit(str(result["exceptionDetails"]))
        return result["result"].get("value")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def end(self):
        self.session = None
        self.call("Browser.close")
        self.process.wait()


def main(report, folder):
    browser = Browser(folder)
    target = browser.call("Target.createTarget", url="about:blank")["targetId"]
    browser.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    for domain in ("Page", "Runtime", "Network", "Log"):
        browser.call(f"{domain}.enable")
    browser.events.clear()
    browser.call("Page.navigate", url=pathlib.Path(report).resolve().as_uri())
    browser.wait_for("Page.loadEventFired")
    states = [browser.evaluate(READ_SCENE)]
    x, y = states[0]["x"], states[0]["y"]
    browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    for part in (0.5, 1):
        browser.mouse("mouseMoved", x + part * DRAG_PX[0], y + part * DRAG_PX[1], button="left", buttons=1)
    browser.mouse("mouseReleased", x + DRAG_PX[0], y + DRAG_PX[1], button="left", clickCount=1)
    browser.evaluate(NEXT_FRAME)
    states.append(browser.evaluate(READ_SCENE))
    browser.mouse("mouseWheel", x, y, deltaX=0, deltaY=-100)
    browser.evaluate(NEXT_FRAME)
    states.append(browser.evaluate(READ_SCENE))
    requests = [one["params"]["request"]["url"] for one in browser.events
                if one.get("method") == "Network.requestWillBeSent"]
    faults = [str(one["params"]) for one in browser.events
              if one.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded")]
    browser.end()
    print(json.dumps({"start": states[0], "turned": states[1], "zoomed": states[2], "drag_px": DRAG_PX,
                      "requests": [url for url in requests if not url.startswith("data:")], "faults": faults}))


main(*sys.argv[1:])
