"""A browser for check-browser, and its pictures."""
import base64, json, os, struct, subprocess, sys, zlib


def write_png(path, size, color_of):
    rows = b"".join(b"\0" + b"".join(bytes(color_of(x, y)) for x in range(size[0])) for y in range(size[1]))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", *size, 8, 2, 0, 0, 0)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def read_png(data):
    """Rows of pixels of an 8-bit RGB or RGBA PNG (W3C 2003, 9.2)."""
    at, body = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", content[:10])
        body += content if kind == b"IDAT" else b""
        at += 12 + length
    channels, raw = {2: 3, 6: 4}[color], zlib.decompress(body)
    rows, above = [], bytearray(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + width * channels])
        for i in range(len(row)):
            left, up, corner = (row[i - channels], above[i], above[i - channels]) if i >= channels else (0, above[i], 0)
            nearest = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))[2]
            row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, len(row), channels)])
        above = row
    return rows


class Browser:
    """Chromium, controlled through a pipe with its DevTools protocol."""

    def __init__(self, profile):
        to_read, self.out = os.pipe()
        self.inp, to_write = os.pipe()

        def attach():
            low = os.dup(to_read), os.dup(to_write)
            os.dup2(low[0], 3)
            os.dup2(low[1], 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe",
             f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=attach, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.rest, self.number, self.events, self.session = b"", 0, [], {}
        page = next(target for target in self("Target.getTargets")["targetInfos"] if target["type"] == "page")
        answer = self("Target.attachToTarget", targetId=page["targetId"], flatten=True)
        self.session = {"sessionId": answer["sessionId"]}

    def receive(self):
        while b"\0" not in self.rest:
            self.rest += os.read(self.inp, 1 << 20) or sys.exit("check-browser: the browser ended")
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def __call__(self, method, **parameters):
        self.number += 1
        call = {"id": self.number, "method": method, "params": parameters, **self.session}
        os.write(self.out, json.dumps(call).encode() + b"\0")
        while (message := self.receive()).get("id") != self.number:
            self.events.append(message)
        if "error" in message:
            sys.exit(f"check-browser: {method}: {message['error']}")
        return message["result"]

    def open(self, address):
        self("Page.navigate", url=address)
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.events.append(self.receive())

    def value(self, expression):
        return self("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)["result"].get("value")

    def texts(self):
        """What a film's page writes into its picture: [px of the screen per em, words]."""
        return self.value("""(() => {
            const found = [], texts = CanvasRenderingContext2D.prototype, draws = texts.fillText;
            texts.fillText = function(words, ...more) {
                const size = parseFloat(/([0-9.]+)px/.exec(this.font)[1]);
                if (words) found.push([size * canvas.clientWidth / picture.size[0], words]);
                draws.call(this, words, ...more);
            };
            draw();
            texts.fillText = draws;
            return found })()""")

    def picture(self, path, **options):
        data = base64.b64decode(self("Page.captureScreenshot", format="png", **options)["data"])
        path.write_bytes(data)
        return read_png(data)

    def mouse(self, kind, x, y):
        self("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def key(self, name, code):
        for kind in ("keyDown", "keyUp"):
            more = {"text": "\r"} if name == "Enter" and kind == "keyDown" else {}
            self("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=code, **more)
