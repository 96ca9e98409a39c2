"""Opens a page in chromium by way of its debugging port, waits, judges it as a user sees it and takes its picture:
photograph.py BROWSER PROFILE URL PICTURE SECONDS."""

import base64
import json
import pathlib
import subprocess
import sys
import time
import urllib.request

import websocket

browser, profile, url, picture, seconds = sys.argv[1:]
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1400,1170"]
# What the page tells of itself: what failed in it, and whether everything shows something.
JUDGE = """JSON.stringify({
  state: document.querySelector(".state").textContent,
  rate: +document.querySelector('[data-value="rate"]').textContent,
  views: [...document.querySelectorAll("#overlays img")].map(img => img.naturalWidth),
  frame: document.querySelector("#player output").textContent,
  inks: [...document.querySelectorAll("canvas")].map(canvas => {
    const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data, seen = new Set();
    for (let i = 0; i < bytes.length; i += 4) if (bytes[i + 3]) seen.add(bytes.slice(i, i + 3).join());
    return seen.size;
  }),
  far: performance.getEntriesByType("resource").map(entry => entry.name).filter(name => !name.startsWith(location.origin)),
})"""

process = subprocess.Popen([browser, *FLAGS, "--remote-debugging-port=0", "--remote-allow-origins=*", f"--user-data-dir={profile}", "about:blank"],
                           stderr=subprocess.DEVNULL)
try:
    told = pathlib.Path(profile, "DevToolsActivePort")
    until = time.monotonic() + 60
    while not told.exists() or not told.read_text().strip():
        assert time.monotonic() < until and process.poll() is None, f"{browser} did not begin"
        time.sleep(0.1)
    port = told.read_text().split()[0]
    pages = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
    page = next(page for page in pages if page["type"] == "page")
    connection = websocket.create_connection(page["webSocketDebuggerUrl"], timeout=60)
    failures, asked = [], 0

    def ask(method, **parameters):
        global asked
        asked += 1
        connection.send(json.dumps({"id": asked, "method": method, "params": parameters}))
        while True:
            answer = json.loads(connection.recv())
            if answer.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                failures.append(answer["params"])
            if answer.get("id") == asked:
                assert "result" in answer, answer
                return answer["result"]

    for method in ("Runtime.enable", "Log.enable", "Page.enable"):
        ask(method)
    ask("Page.navigate", url=url)
    time.sleep(float(seconds))
    seen = json.loads(ask("Runtime.evaluate", expression=JUDGE)["result"]["value"])
    shot = ask("Page.captureScreenshot", format="png")["data"]
    pathlib.Path(picture).write_bytes(base64.b64decode(shot))
    print(json.dumps(seen))
    # A browser asks every server for an icon; this one has none.
    failures = [failure for failure in failures if "favicon" not in json.dumps(failure)]
    assert not failures, failures
    assert seen["state"] == "live" and seen["rate"] > 1 and seen["frame"].startswith("frame "), seen
    assert seen["views"] and all(width > 100 for width in seen["views"]), seen
    # The player and the three curves have drawn more than their paper and grid.
    assert len(seen["inks"]) == 4 and all(inks > 4 for inks in seen["inks"]), seen
    assert not seen["far"], seen
finally:
    process.terminate()
    process.wait()
