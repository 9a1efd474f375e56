#!/usr/bin/env python3
"""Drives a page of `pellucid-cli share` in a browser, as a person would, and compares it with `pellucid-cli render`.

    drive_page.py PELLUCID_CLI [--volume VOLUME] [--browser chromium|firefox|PATH] [--keep FOLDER] [-- OPTIONS …]

OPTIONS are those of a scene (--tf, --view, --shading …), for both commands. Talks to Chromium over its pipe, to Firefox
by its Marionette; needs nothing but Python and the browser. Says SKIPPED where that is not installed.
"""
import argparse
import base64
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SIZE = (300, 240)
LEAST_SSIM = 0.97
HOSTILE = "</script><script>window.stolen=1</script><img src=x onerror='window.stolen=2'>&{{voxels}} \u2028 \u2603"


class Browser:
    """One page in a headless browser."""

    def __init__(self, path, folder, width=1100, height=720, dark=False, before=""):
        # Whatever else is open here has other numbers than 3 and 4, which are the browser's ends of its pipes.
        taken = [os.open(os.devnull, os.O_RDONLY) for _ in range(2)]
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()

        def connect():
            os.dup2(to_browser, 3)
            os.dup2(from_browser, 4)

        self.process = subprocess.Popen(
            [path, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--no-first-run", "--disable-dev-shm-usage",
             f"--user-data-dir={folder}", "--remote-debugging-pipe", "about:blank"],
            preexec_fn=connect, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for end in (to_browser, from_browser, *taken):
            os.close(end)
        self.buffer, self.last, self.events = b"", 0, []
        target = self.send("Target.createTarget", {"url": "about:blank"}, session=None)["targetId"]
        self.session = self.send("Target.attachToTarget", {"targetId": target, "flatten": True}, session=None)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.send(f"{domain}.enable")
        self.send("Emulation.setDeviceMetricsOverride",
                  {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        self.send("Emulation.setEmulatedMedia",
                  {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
        if before:
            self.send("Page.addScriptToEvaluateOnNewDocument", {"source": before})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.write_end)
        os.close(self.read_end)

    def send(self, method, params=None, session=""):
        self.last += 1
        message = {"id": self.last, "method": method, "params": params or {}}
        if session is not None:
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        wanted = self.last
        while True:
            answer = self.receive()
            if answer.get("id") == wanted:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def receive(self):
        while b"\0" not in self.buffer:
            more = os.read(self.read_end, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.buffer += more
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def open(self, page):
        self.send("Page.navigate", {"url": Path(page).absolute().as_uri()})
        # The page's own script defines it, at the very end of the file.
        self.wait("typeof window.pellucid === 'object' && document.readyState === 'complete'")

    def wait(self, condition, seconds=120):
        end = time.time() + seconds
        while not self.value(condition):
            if time.time() > end:
                raise RuntimeError("waited in vain for " + condition)
            time.sleep(0.05)

    def value(self, expression):
        result = self.send("Runtime.evaluate", {"expression": expression, "awaitPromise": True, "returnByValue": True})
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", details["text"]))
        return result["result"].get("value")

    def picture(self, path, size=SIZE):
        url = self.value(f"window.pellucid.picture({size[0]}, {size[1]})")
        Path(path).write_bytes(base64.b64decode(url.split(",", 1)[1]))
        return path

    def screenshot(self, path):
        Path(path).write_bytes(base64.b64decode(self.send("Page.captureScreenshot", {"format": "png"})["data"]))

    def key(self, key, shift=False):
        params = {"key": key, "modifiers": 8 if shift else 0}
        if len(key) == 1:
            params["text"] = key
        self.send("Input.dispatchKeyEvent", {"type": "keyDown", **params})
        self.send("Input.dispatchKeyEvent", {"type": "keyUp", "key": key})

    def mouse(self, kind, x, y, **more):
        self.send("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **more})

    def requests(self):
        """All that the page has asked for besides itself and texts in it."""
        asked = [e["params"]["request"]["url"] for e in self.events if e.get("method") == "Network.requestWillBeSent"]
        return [url for url in asked if not url.startswith(("file:", "data:", "blob:"))]

    def complaints(self):
        return [e["params"] for e in self.events if e.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded")
                and e["params"].get("entry", {"level": "error"})["level"] == "error"]


class Firefox(Browser):
    """The same with Firefox, whose Marionette knows no scripts before those of a page: they go into a copy of it."""

    KEYS = {"Home": "\ue011", "ArrowLeft": "\ue012"}
    PREFERENCES = {"marionette.port": 0, "webgl.force-enabled": True, "gfx.x11-egl.force-enabled": True,
                   "gfx.webrender.software": True, "browser.shell.checkDefaultBrowser": False,
                   "datareporting.policy.dataSubmissionEnabled": False, "app.update.enabled": False, "browser.aboutwelcome.enabled": False}

    def __init__(self, path, folder, width=1100, height=720, dark=False, before=""):
        folder = Path(folder)
        folder.mkdir(parents=True)
        self.copy, self.before, self.last, self.buffer = folder / "page.html", before, 0, b""
        wanted = {**self.PREFERENCES, "layout.css.prefers-color-scheme.content-override": 0 if dark else 1}
        (folder / "user.js").write_text("".join(f"user_pref({json.dumps(k)}, {json.dumps(v)});\n" for k, v in wanted.items()))
        self.process = subprocess.Popen([path, "--headless", "--marionette", "--no-remote", "--profile", str(folder)],
                                        env={**os.environ, "HOME": str(folder), "MOZ_WEBGL_FORCE_EGL": "1"}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port, end = folder / "MarionetteActivePort", time.time() + 60
        while not (port.exists() and port.read_text()):
            if time.time() > end or self.process.poll() is not None:
                raise RuntimeError("Firefox does not answer")
            time.sleep(0.05)
        self.socket = socket.create_connection(("127.0.0.1", int(port.read_text())))
        self.receive()
        self.send("WebDriver:NewSession", {"capabilities": {"alwaysMatch": {"timeouts": {"script": 120000}}}})
        self.send("WebDriver:SetWindowRect", {"width": width, "height": height})

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.socket.close()

    def send(self, method, params=None):
        self.last += 1
        text = json.dumps([0, self.last, method, params or {}]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, result = self.receive()
        if error:
            raise RuntimeError(f"{method}: {error}")
        return result

    def receive(self):
        while True:
            head, colon, rest = self.buffer.partition(b":")
            if colon and len(rest) >= int(head):
                self.buffer = rest[int(head):]
                return json.loads(rest[:int(head)])
            more = self.socket.recv(1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.buffer += more

    def open(self, page):
        first = ("<script>window.complaints = []; for (const kind of ['error', 'unhandledrejection', 'securitypolicyviolation'])"
                 " addEventListener(kind, e => complaints.push(String(e.message || e.reason || e.violatedDirective)));"
                 f"{self.before}</script>")
        self.copy.write_text(Path(page).read_text().replace("<head>", "<head>" + first, 1))
        self.send("WebDriver:Navigate", {"url": self.copy.absolute().as_uri()})
        self.wait("typeof window.pellucid === 'object' && document.readyState === 'complete'")

    def value(self, expression):
        script = ("const done = arguments[arguments.length - 1]; (async () => (" + expression + "))()"
                  ".then(value => done({value}), error => done({error: String(error)}));")
        answer = self.send("WebDriver:ExecuteAsyncScript", {"script": script, "args": []})["value"]
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer.get("value")

    def screenshot(self, path):
        Path(path).write_bytes(base64.b64decode(self.send("WebDriver:TakeScreenshot", {"full": False})["value"]))

    def act(self, kind, *actions, **more):
        self.send("WebDriver:PerformActions", {"actions": [{"type": kind, "id": kind, "actions": list(actions), **more}]})

    def key(self, key, shift=False):
        value = self.KEYS.get(key, key)
        self.act("key", {"type": "keyDown", "value": value}, {"type": "keyUp", "value": value})

    def mouse(self, kind, x, y, **more):
        actions = [{"type": "pointerMove", "x": x, "y": y}]
        if kind != "mouseMoved":
            actions.append({"type": "pointerDown" if kind == "mousePressed" else "pointerUp", "button": 0})
        self.act("pointer", *actions)

    def requests(self):
        asked = self.value("performance.getEntriesByType('resource').map(entry => entry.name)")
        return [url for url in asked if not url.startswith(("file:", "data:", "blob:"))]

    def complaints(self):
        return self.value("window.complaints")


class Run:
    def __init__(self, arguments):
        self.cli, self.volume, self.options = arguments.cli, arguments.volume, arguments.options
        self.browser = arguments.browser
        self.keep = arguments.keep
        self.folder = Path(arguments.keep) if arguments.keep else Path(tempfile.mkdtemp(prefix="page"))
        self.folder.mkdir(parents=True, exist_ok=True)
        self.failures, self.browsers = [], 0

    def command(self, *words):
        done = subprocess.run([self.cli, *map(str, words), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr}")
        return json.loads(done.stdout)

    def check(self, what, holds, detail=""):
        print(f"{'ok    ' if holds else 'FAILED'} {what}{f' ({detail})' if detail != '' else ''}", flush=True)
        if not holds:
            self.failures.append(what)

    def path(self, name):
        return str(self.folder / name)

    def page(self, name, *more):
        out = self.path(name)
        return out, self.command("share", self.volume, *self.options, *more, "--out", out)

    def look(self, browser, name):
        """A picture of the whole page, for people; of no use where nothing is kept."""
        if self.keep:
            browser.value("window.pellucid.settled()")
            browser.screenshot(self.path(name))

    def open(self, page, **how):
        self.browsers += 1
        kind = Firefox if "firefox" in Path(self.browser).name else Browser
        browser = kind(self.browser, self.path(f"profile{self.browsers}"), **how)
        browser.open(page)
        return browser

    def alike(self, one, other):
        return self.command("compare", one, other)["ssim"]

    def reference(self, name, *more):
        out, options = self.path(name), list(self.options)
        if "--tf" in more and "--tf" in options:
            at = options.index("--tf")
            del options[at:at + 2]
        self.command("render", self.volume, *options, *more, "--size", f"{SIZE[0]}x{SIZE[1]}", "--out", out)
        return out


def check_file(run, page, answer):
    text = Path(page).read_bytes()
    run.check("the file is as large as is said", len(text) == answer["bytes"], len(text))
    run.check("the file is ASCII", max(text) < 128)
    most = 1.3 * answer["voxel_bytes"] + 300e3
    run.check("the file is not much larger than its voxels", len(text) <= most, f"{len(text)} of {most:.0f}")


def check_use(run, browser, first):
    """Eyes, density, keys and the mouse change what they should."""
    start = browser.value("window.pellucid.state()")
    ssim = lambda name: run.alike(first, browser.picture(run.path(name)))
    browser.value("document.getElementById('picture').focus()")
    if start["shown"]:
        name = browser.value("document.querySelector('.feature .name').textContent")
        browser.key("1")
        hidden = browser.value("window.pellucid.state()")["shown"]
        run.check("the key 1 hides the first feature", hidden[0] != start["shown"][0] and hidden[1:] == start["shown"][1:])
        run.check("its eye says so", browser.value("document.querySelector('.feature').getAttribute('aria-checked')") == "false")
        run.check("and it is said aloud", name in browser.value("document.getElementById('spoken').textContent"))
        one = run.reference("hidden_reference.png", "--tf", hidden_tf(run, 0)) if run.has_tf else None
        if one:
            alike = run.alike(one, browser.picture(run.path("hidden.png")))
            run.check("the picture without it is that of render", alike >= LEAST_SSIM, f"SSIM {alike:.4f}")
        browser.value("document.querySelector('.feature').click()")
        run.check("its eye shows it again", browser.value("window.pellucid.state()")["shown"] == start["shown"])
    if start["coverage"] is not None:
        browser.key("]")
        denser = browser.value("window.pellucid.state()")
        grown = [b >= a - 1e-9 for a, b in zip(start["opacities"], denser["opacities"])]
        run.check("the key ] makes it denser", denser["coverage"] > start["coverage"] and all(grown), denser["coverage"])
        told = run.command("density", run.volume, *(o for o in run.options if o != "--shading"), "--coverage", denser["coverage"])["chosen"]["opacity"]
        off = max(abs(a - b) for a, b in zip(told, denser["opacities"]))
        run.check("its opacities are those of density", off < 1e-3, f"{off:.1e}")
        run.check("the picture follows", ssim("denser.png") < 0.9999)
    browser.key("Home")
    for key, word in (("ArrowLeft", "turns"), ("+", "zooms"), ("l", "lights")):
        browser.key(key)
        alike = ssim(f"{word}.png")
        run.check(f"the key {key} {word}", alike < 0.999, f"SSIM {alike:.4f}")
        browser.key("Home")
    back = ssim("back.png")
    run.check("Home brings the saved view back", back > 0.9999 and browser.value("window.pellucid.state()") == start, f"SSIM {back:.5f}")
    browser.mouse("mousePressed", 300, 300, button="left", buttons=1, clickCount=1)
    browser.mouse("mouseMoved", 380, 300, button="left", buttons=1)
    browser.mouse("mouseReleased", 380, 300, button="left", clickCount=1)
    run.check("the mouse turns", browser.value("window.pellucid.state()")["camera"]["eye"] != start["camera"]["eye"])
    browser.value("document.getElementById('reset').click()")
    browser.value("(() => { const cut = document.querySelector('#cuts input'); cut.value = 50; cut.dispatchEvent(new Event('input')); })()")
    cut = run.alike(run.reference("cut_reference.png", "--clip", "x:0.5:1"), browser.picture(run.path("cut.png")))
    run.check("a cut is that of --clip", cut >= LEAST_SSIM, f"SSIM {cut:.4f}")
    browser.value("document.getElementById('reset').click()")
    unnamed = browser.value("[...document.querySelectorAll('#panel button, #panel input, canvas')].filter(e => !e.hidden && "
                            "!(e.getAttribute('aria-label') || e.textContent.trim() || (e.labels && e.labels.length))).length")
    run.check("every control has a name", unnamed == 0)


def tents(path, count=3):
    """A file with what --tf tents:3 has (docs/method.md, "Transfer function"), in other colours."""
    points, features = [], []
    for i, color in zip(range(count), ("#e0703a", "#e8d9a0", "#6aa0d8")):
        centre, half = (i + 0.5) / count, 0.4 / count
        points += [{"x": centre + d * half, "opacity": 0.4 * (d == 0), "color": color} for d in (-1, 0, 1)]
        features.append({"name": ("Soft", "Firm", "Hard")[i], "range": [centre - half, centre + half], "color": color})
    Path(path).write_text(json.dumps({"format": "pellucid-tf", "version": 1, "points": points, "features": features}))
    return path


def hidden_tf(run, index):
    """The transfer function of the options, a file, without the feature."""
    tf = json.loads(Path(run.options[run.options.index("--tf") + 1]).read_text())
    a, b = tf["features"][index]["range"]
    del tf["features"][index]
    tf["points"] = [p for p in tf["points"] if not a <= p["x"] < b]
    path = run.path("hidden.tf.json")
    Path(path).write_text(json.dumps(tf))
    return path


def drive(run):
    run.has_tf = "--tf" in run.options and run.options[run.options.index("--tf") + 1].endswith(".tf.json")
    page, answer = run.page("page.html")
    print(f"       {answer['bytes']} bytes, {answer['voxel_bytes']} of voxels, {answer['dims']} by {answer['bits']} bits")
    check_file(run, page, answer)
    reference = run.reference("reference.png")
    with run.open(page) as browser:
        milliseconds = browser.value("window.pellucid.ready")["milliseconds"]
        print(f"       opened in {milliseconds:.0f} ms", flush=True)
        first = browser.picture(run.path("picture.png"))
        alike = run.alike(reference, first)
        run.check("the picture is that of render", alike >= LEAST_SSIM, f"SSIM {alike:.4f}")
        run.look(browser, "light.png")
        check_use(run, browser, first)
        run.check("nothing was asked of a network", browser.requests() == [], browser.requests() or "")
        run.check("nothing went wrong in the page", browser.complaints() == [], browser.complaints() or "")

    own = "delete window.DecompressionStream;"
    with run.open(page, before=own, dark=True, width=420, height=860) as browser:
        browser.value("window.pellucid.ready")
        alike = run.alike(first, browser.picture(run.path("own.png")))
        run.check("a browser without DecompressionStream unpacks the same", alike > 0.9999, f"SSIM {alike:.5f}")
        run.look(browser, "dark.png")

    without = "HTMLCanvasElement.prototype.getContext = () => null;"
    with run.open(page, before=without) as browser:
        browser.wait("document.getElementById('message').textContent.includes('WebGL 2')")
        run.check("without WebGL 2 there is a still picture", browser.value("document.getElementById('still').naturalWidth") >= 100)
        if run.keep:
            browser.screenshot(run.path("still.png"))

    page, _ = run.page("hostile.html", "--title", HOSTILE, "--density-slider", "off", "--voxels", 10000)
    with run.open(page) as browser:
        browser.value("window.pellucid.ready")
        shown = HOSTILE.replace("\u2028", " ")
        run.check("a hostile title is text", browser.value("document.querySelector('h1').textContent") == shown)
        run.check("and does nothing", browser.value("typeof window.stolen") == "undefined")
        run.check("a coarser volume is said to be one", "made coarser" in browser.value("document.getElementById('size').textContent"))
        run.check("its picture can be drawn", browser.value("window.pellucid.picture(40, 30)").startswith("data:image/png"))


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        cut = arguments.index("--")
        arguments, options = arguments[:cut], arguments[cut + 1:]
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("cli")
    parser.add_argument("--volume", default="sample:knee")
    parser.add_argument("--browser", default="chromium")
    parser.add_argument("--keep", help="a folder for the page and pictures of it")
    parsed = parser.parse_args(arguments)
    names = {"chromium": ("chromium", "chromium-browser", "google-chrome"), "firefox": ("firefox", "firefox-esr")}
    asked, parsed.browser = parsed.browser, None
    for name in names.get(asked, (asked,)):
        parsed.browser = parsed.browser or shutil.which(name)
    if not parsed.browser:
        print(f"SKIPPED: {asked}, which shows the page, is not installed")
        return 0
    parsed.options = options
    run = Run(parsed)
    if not options:
        run.options = ["--tf", tents(run.path("tents.tf.json")), "--view", "30,20", "--shading"]
    try:
        drive(run)
    finally:
        if not parsed.keep:
            shutil.rmtree(run.folder, ignore_errors=True)
    return 1 if run.failures else 0


if __name__ == "__main__":
    sys.exit(main())
