"""The page of `troffer view` in headless Chromium:  page.py PROGRAM [FOLDER for screenshots]

Exits with status 77 and the reason if Chromium, its driver or python3-selenium is not installed.
"""
import json
import os
import signal
import subprocess
import struct
import sys
import tempfile
import time
import urllib.request

root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.select import Select
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(77)
chromium, driver_path = "/usr/bin/chromium", "/usr/bin/chromedriver"
if not (os.path.exists(chromium) and os.path.exists(driver_path)):
    print("skipped: chromium and chromium-driver are not installed")
    sys.exit(77)

patience = 600  # seconds; only against endless waiting


def start_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",
                     "--window-size=1200,800", "--force-device-scale-factor=1",
                     "--disable-background-networking", "--disable-extensions"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    from selenium.webdriver.chrome.service import Service
    try:
        browser = webdriver.Chrome(service=Service(driver_path), options=options)
    except Exception as failure:  # a fault of the machine, not of the page
        print("skipped: Chromium does not start here:", str(failure)[:300])
        sys.exit(77)
    browser.set_script_timeout(patience)
    return browser


class Page:
    """The program and its page in a browser."""

    def __init__(self, program, arguments, browser):
        self.process = subprocess.Popen([program, "view"] + arguments, stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), self.address
        self.browser = browser
        browser.get(self.address)

    def js(self, script, *arguments):
        return self.browser.execute_script("return " + script, *arguments)

    def wait(self, script, *arguments):
        for _ in range(patience * 20):
            value = self.js(script, *arguments)
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"never: {script}; {self.js('document.body.innerText')}")

    def get(self, path):
        with urllib.request.urlopen(self.address + path) as answer:
            return answer.read()

    def state(self):
        return json.loads(self.get("state"))

    def set(self, name, value):
        """Sets an input as a user would: a new value, and the events that come with it."""
        self.browser.execute_script("""const e = document.getElementById(arguments[0]);
          if (e.type === 'checkbox') e.checked = arguments[1]; else e.value = arguments[1];
          e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change'));""", name, value)

    def drag(self, a, b, steps=4):
        """Drags between places, given as shares of the picture's sides."""
        overlay = self.browser.find_element(By.ID, "overlay")
        width, height = overlay.size["width"], overlay.size["height"]
        def at(p):
            return int((p[0] - 0.5) * width), int((p[1] - 0.5) * height)
        chain = ActionChains(self.browser, duration=20)
        chain.move_to_element_with_offset(overlay, *at(a)).click_and_hold()
        for k in range(1, steps + 1):
            p = [a[i] + (b[i] - a[i]) * k / steps for i in (0, 1)]
            chain.move_to_element_with_offset(overlay, *at(p))
        chain.release().perform()

    def tool(self, name):
        self.browser.find_element(By.CSS_SELECTOR, f"input[name=tool][value={name}]").click()

    def mean(self):
        """Returns the mean of the canvas."""
        return self.js("""(() => { const c = document.getElementById('picture');
          const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let sum = 0;
          for (let i = 0; i < d.length; ++i) if (i % 4 < 3) sum += d[i]; return sum / d.length; })()""")

    def wait_done(self):
        self.wait("app.state && app.state.stage === 'done' && app.layers.whole && "
                  "app.layers.whole.version === app.state.layers.whole.version")

    def screenshot(self, name):
        if len(sys.argv) > 2:
            self.browser.save_screenshot(os.path.join(sys.argv[2], name + ".png"))

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        return self.process.wait(patience)


def check_no_complaints(browser):
    entries = [e for e in browser.get_log("browser") if e["level"] == "SEVERE"]
    assert not entries, entries


def check_looking(page):
    page.wait("app.layers.whole && document.getElementById('picture').width > 1")
    assert page.mean() > 5, page.mean()
    assert page.js("document.title").startswith("kj92room"), page.js("document.title")
    names = page.js("performance.getEntriesByType('resource').map((e) => e.name)")
    assert names and all(n.startswith(page.address) for n in names), names
    page.wait_done()
    first = page.state()
    assert first["layers"]["whole"]["error"] > 0
    page.drag([0.5, 0.5], [0.6, 0.5])
    page.wait("app.state.view > arguments[0]", first["view"])
    assert page.state()["camera"]["eye"] != first["camera"]["eye"]
    page.tool("walk")
    before = page.state()
    page.browser.find_element(By.ID, "overlay").send_keys("w")
    page.wait("app.state.view > arguments[0]", before["view"])
    Select(page.browser.find_element(By.ID, "camera")).select_by_index(0)
    page.set("camera", "0")
    page.wait_done()
    eye = page.state()["camera"]["eye"]
    assert all(abs(a - b) < 1e-3 for a, b in zip(eye, first["camera"]["eye"])), eye
    darker = page.mean()
    page.set("stops", "6")
    assert page.mean() > darker


def check_false_colours(page):
    for show in ("luminance", "illuminance", "error"):
        page.set("show", show)
        assert page.js("app.map.most") > 0
    page.set("show", "illuminance")
    page.set("levels", "1, 2, 3, 5, 8, 12, 20")
    page.set("lines", True)
    assert sum(page.js("app.lines").values()) > 20
    # Without levels from the user, the page chooses levels that suit the scale.
    page.set("levels", "")
    for most in ("0.5", "5", "20"):
        page.set("most", most)
        levels = sorted(float(v) for v in page.js("Object.keys(app.lines)"))
        assert 5 <= len(levels) <= 8 and levels[-1] <= float(most) < 2 * levels[-1], (most, levels)
    page.set("most", "")
    assert sum(page.js("app.lines").values()) > 20
    page.set("lines", False)
    page.set("show", "picture")
    # Lightness (CIE L*) rises evenly along the palette.
    lightness = page.js("""colours.map((c) => { const l = luminanceOf(...c.map((v) => {
      const s = v / 255; return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4; }));
      return 116 * Math.cbrt(l) - 16; })""")
    steps = [b - a for a, b in zip(lightness[::32], lightness[32::32])]
    assert min(steps) > 0.5 * (lightness[-1] - lightness[0]) / 8, steps
    # Labels never overlap.
    assert page.js("""(() => { const l = new LabelBoard(document.getElementById('overlay').getContext('2d'));
      return [l.place('100', 50, 50, '#fff'), l.place('100', 55, 52, '#fff'), l.place('100', 50, 70, '#fff')]; })()""") \
        == [True, False, True]


def check_pinch(page):
    """Spreading two fingers brings the camera nearer; one that stays down does not turn it."""
    before = page.state()
    page.js("""(() => { const o = document.getElementById('overlay'), r = o.getBoundingClientRect();
      o.setPointerCapture = () => {};
      const send = (type, id, x, y) => o.dispatchEvent(new PointerEvent(type, {pointerId: id, pointerType: 'touch',
        clientX: r.left + x * r.width, clientY: r.top + y * r.height, bubbles: true}));
      send('pointerdown', 1, 0.4, 0.5); send('pointerdown', 2, 0.6, 0.5);
      send('pointermove', 1, 0.35, 0.5); send('pointermove', 2, 0.65, 0.5);
      send('pointerup', 2, 0.65, 0.5); send('pointermove', 1, 0.1, 0.2); send('pointerup', 1, 0.1, 0.2); })()""")
    page.wait("app.state.view > arguments[0]", before["view"])
    page.wait_done()
    after = page.state()
    step = [b - a for a, b in zip(before["camera"]["eye"], after["camera"]["eye"])]
    forward = before["camera"]["forward"]
    assert sum(a * b for a, b in zip(step, forward)) > 0.01, step
    assert all(abs(a - b) < 1e-5 for a, b in zip(forward, after["camera"]["forward"]))
    assert page.js("app.pinch === null && app.drag === null")
    page.set("camera", "0")
    page.wait_done()


def check_measuring(page):
    page.tool("point")
    page.drag([0.5, 0.9], [0.5, 0.9], 1)
    page.wait("document.getElementById('measured').innerText.includes('±')")
    item = page.js("measurements.all[0]")
    lx, error = item["rows"][0][0][:2]
    assert lx > 0 and 0 < error < 0.1 * lx, (lx, error)
    csv = page.get(f"measured.csv?number={item['number']}").decode().splitlines()
    assert len(csv) == 2 and abs(float(csv[1].split(",")[9]) - lx) < 1e-3 * lx, csv
    page.tool("grid")
    page.set("along", "3")
    page.drag([0.35, 0.85], [0.6, 0.95])
    page.wait("measurements.all.length === 2 && measurements.all[1].rows")
    text = page.js("document.getElementById('measured').innerText")
    assert "uniformity" in text, text
    # A dense grid shows as many values as fit, and the one under the pointer.
    page.set("along", "40")
    page.drag([0.35, 0.85], [0.6, 0.95])
    page.wait("measurements.all.length === 3 && measurements.all[2].rows")
    page.js("drawOverlay()")
    count = page.js("measurements.all[2].points.length")
    assert 0 < page.js("measurements.shown") < count, (page.js("measurements.shown"), count)
    page.js("measurements.remove(measurements.all[2])")
    page.set("along", "3")
    page.tool("orbit")
    return lx


def check_dimmers(page, lx):
    count = page.js("app.dimmers.length")
    assert count == 4, count
    page.set("stops", "0")
    page.wait_done()
    bright = page.mean()
    page.set("show", "illuminance")
    scale = page.js("app.map.most")
    page.set("show", "picture")
    began = time.time()
    page.browser.find_elements(By.CSS_SELECTOR, ".dimmer input[type=checkbox]")[0].click()
    page.wait("currentPicture() !== null")
    print(f"first effect of a dimmer after {time.time() - began:.2f} s")
    # The scale stays, so that the room looks darker when its main lamp goes off.
    page.set("show", "illuminance")
    assert page.js("app.map.most") == scale, (page.js("app.map.most"), scale)
    page.set("show", "picture")
    page.wait("measurements.values(measurements.all[0]) !== null")
    assert page.mean() < 0.9 * bright, (page.mean(), bright)
    less = page.js("measurements.values(measurements.all[0])[0][0]")
    assert less < lx, (less, lx)
    # Now nothing is rendered again: the page weights the existing layers.
    page.wait_done()
    versions, view = page.js("app.state.layers"), page.js("app.state.view")
    dark = page.mean()
    page.js("""(() => { const e = document.querySelectorAll('.dimmer input[type=range]')[1];
      e.value = 0.2; e.dispatchEvent(new Event('input')); })()""")
    page.wait("Math.abs(app.dimmers[1].level - 0.2) < 1e-9")
    assert page.mean() < dark
    state = page.state()
    assert state["view"] == view and state["layers"] == versions
    # While walking, the settings apply from the first picture on.
    page.tool("walk")
    page.browser.find_element(By.ID, "overlay").send_keys("w")
    page.wait("app.state.view > arguments[0] && app.state.layers.dimmed.view === app.state.view", view)
    page.wait("app.layers.dimmed.version === app.state.layers.dimmed.version")
    assert page.mean() < 0.9 * bright, (page.mean(), bright)
    page.wait_done()
    assert page.mean() < 0.9 * bright, (page.mean(), bright)
    page.tool("orbit")
    page.set("camera", "0")
    page.wait_done()
    # With all on again, the page shows the picture of all light.
    for e in page.browser.find_elements(By.CSS_SELECTOR, ".dimmer input[type=checkbox]")[:1]:
        e.click()
    page.js("""(() => { const e = document.querySelectorAll('.dimmer input[type=range]')[1];
      e.value = 1; e.dispatchEvent(new Event('input')); })()""")
    page.wait_done()
    assert abs(page.mean() - bright) < 0.02 * bright, (page.mean(), bright)


def check_split(page):
    page.set("beside", "error")
    assert not page.js("document.getElementById('split-at').hidden")
    page.set("beside", "path")
    page.wait("app.layers.second && app.layers.second.width > 1")
    page.set("split-at", "300")
    page.set("beside", "")


def check_saving(page):
    page.wait_done()
    href = page.js("document.getElementById('save-png').getAttribute('href')")
    assert page.get(href)[:8] == b"\x89PNG\r\n\x1a\n"
    assert page.get(page.js("document.getElementById('save-exr').getAttribute('href')"))[:4] == b"v/1\x01"
    assert page.get(page.js("document.getElementById('save-hdr').getAttribute('href')"))[:10] == b"#?RADIANCE"


def check_time(program, browser):
    page = Page(program, [os.path.join(root, "scenes/daylight-room/daylight-room.gltf"), "--at",
                          "48.2,16.4,2026-06-21T08:00+02:00", "--size", "96x72", "--error", "0.2",
                          "--quiet"], browser)
    page.wait_done()
    assert page.js("document.getElementById('clock').textContent") == "08:00 +02:00"
    before = page.state()
    page.set("minutes", str(12 * 60))
    page.wait("app.state.time === '2026-06-21T12:00+02:00' && app.state.view > arguments[0]",
              before["view"])
    page.wait_done()
    assert page.mean() > 5
    assert page.end() == 130
    # The page reports the end of the program and how to restart it, and disables its controls.
    page.wait("!document.getElementById('ended').hidden")
    assert "troffer view" in page.js("document.getElementById('again').textContent")
    assert page.js("document.querySelector('aside').inert && document.getElementById('overlay').inert")


def write_weather(path):
    """Three days of every month by hours, clear, at 48 degrees north."""
    lines = ["place Test", "latitude 48", "longitude 0", "time_zone 0", "site_elevation 0",
             "weather_data_file_units 1"]
    for month in range(1, 13):
        for day in (20, 21, 22):
            for hour in range(24):
                is_day = 7 <= hour < 17
                lines.append(f"{month} {day} {hour + 0.5} {600 * is_day} {150 * is_day}")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")


def array_of(path, sensors):
    """Rows of a .npy file of floats."""
    with open(path, "rb") as file:
        data = file.read()
    begin = 10 + data[8] + 256 * data[9]
    values = struct.unpack(f"<{(len(data) - begin) // 4}f", data[begin:])
    columns = len(values) // sensors
    return [values[s * columns:(s + 1) * columns] for s in range(sensors)]


def check_year(program, browser, folder):
    """A slider over the year: every value shown is the one in the arrays of `troffer annual`."""
    scene = os.path.join(root, "scenes/year-office")
    weather, year = os.path.join(folder, "test.wea"), os.path.join(folder, "year")
    write_weather(weather)
    subprocess.run([os.path.abspath(program), "annual", "office.glb", "--weather", weather, "-o", year, "--grid", "Floor,0.8,1",
                    "--border", "0.5", "--groups", "groups.json", "--eyes", "eyes.csv", "--subdivision", "1", "--gather-rays", "64",
                    "--quiet"], cwd=scene, check=True)
    page = Page(program, [os.path.join(scene, "office.glb"), "--annual", year, "--size", "160x120", "--error",
                          "0.5", "--at", "48,0,2026-06-21T08:00+00:00", "--quiet"], browser)
    page.wait("window.year && year.values && year.seen")
    assert page.js("document.getElementById('year-note').hidden")
    with open(os.path.join(year, "glare.csv")) as file:
        glare = [[float(v) for v in line.split(",")] for line in file.read().split("\n")[1:] if line]
    count, when = page.js("year.sensors.length"), page.js("document.getElementById('year-when').textContent")
    assert when == "21 March, 12:30", when
    arrays = {(state, part): array_of(os.path.join(year, "honeybee/South", f"{state}_South", part, "Floor.npy"), count)
              for state in (0, 1) for part in ("total", "direct")}
    with open(os.path.join(year, "honeybee/sun-up-hours.txt")) as file:
        hours = [float(line) for line in file]
    with open(os.path.join(year, "honeybee/dynamic_schedule.json")) as file:
        schedule = json.load(file)["South"]["schedule"]

    def check(state, part):
        """Compares the values shown with a column of the arrays."""
        hour = page.js("year.hour")
        assert hours[hour] == page.js("(year.yearStep + 0.5)"), hour
        page.wait("!year.isAsking")
        if state is None:
            state = page.js("year.stateOf(0, year.hour)")
        expected = [row[hour] for row in arrays[state, part]]
        shown = page.js("Array.from(year.values)")
        assert all(abs(a - b) <= 1e-5 * b for a, b in zip(shown, expected)), (hour, shown, expected)
        assert max(expected) > 0

    check(None, "total")
    assert set(schedule) == {0, 1}
    # Tiles cover the canvas where sensors are seen.
    seen = page.js("year.seen.reduce((a, b) => a + b, 0)")
    assert 0 < seen <= count and page.js("year.marks.length") == seen
    page.set("year-through", True)
    assert page.js("year.marks.length") == count
    page.screenshot("year")
    hour = page.js("year.hour")
    eyes = page.js("year.eyes.all.map((e) => { const g = year.eyes.glareOf(e); return [g.lx, g.dgp]; })")
    assert len(eyes) == 3
    for k, (lx, dgp) in enumerate(eyes):
        assert abs(lx - glare[hour][2 * k + 1]) <= 1e-4 * lx and abs(dgp - glare[hour][2 * k + 2]) < 1e-4
    assert f"DGP {eyes[0][1]:.2f}" in page.js("document.getElementById('year-eyes').innerText")
    # Sliders, keys, groups, and direct light. The picture follows if asked to.
    page.set("year-follow", True)
    page.set("year-step", "9")
    check(None, "total")
    page.wait("app.state.time === '2015-03-21T09:30+00:00'")
    page.wait("document.getElementById('clock').textContent === '09:30 +00:00'")
    page.set("year-follow", False)
    page.browser.find_element(By.ID, "year-step").send_keys(Keys.ARROW_RIGHT)
    assert page.js("year.step") == 10
    page.browser.find_element(By.ID, "year-day").send_keys(Keys.ARROW_UP)
    assert page.js("document.getElementById('year-when').textContent") == "22 March, 10:30"
    check(None, "total")
    state = page.browser.find_element(By.CSS_SELECTOR, "#year-groups select")
    for index in (1, 0):
        Select(state).select_by_index(index + 1)
        check(index, "total")
    page.set("year-part", "direct")
    check(0, "direct")
    page.set("year-part", "total")
    Select(state).select_by_index(0)
    page.wait("!year.isAsking")
    # A click on a sensor shows its value, its day and its year; a click on the year goes to an hour.
    index, x, y = page.js("""(() => { const c = document.getElementById('overlay'), m = year.nearest([0.5, 0.7], c, 1e9);
      return [m.index, m.at[0] / c.width, m.at[1] / c.height]; })()""")
    page.drag([x, y], [x, y], 1)
    page.wait("year.chosen && year.chosen.index === arguments[0]", index)
    text = page.js("document.getElementById('year-sensor').innerText")
    assert "Floor, sensor" in text and "±" in text, text
    page.browser.find_element(By.ID, "year-carpet").click()
    day, step = page.js("[year.day, year.step]")
    assert 150 < day < 158 and step in (9, 10, 11), (day, step)
    page.wait("document.getElementById('year-figures').textContent === 'No daylight at this hour.'")
    page.screenshot("year-sensor")
    # The scale stays until the user asks for a new one.
    page.js("year.go(171 * 24 + 12)")
    page.wait("year.hour !== undefined && !year.isAsking")
    assert page.js("mostOfYear()") == 2000
    page.browser.find_element(By.ID, "year-fit").click()
    assert page.js("mostOfYear()") == page.js("roundUp(quantile(year.values, 0.98))")
    # Playing goes on to the next hour with the sun up.
    page.browser.find_element(By.ID, "year-play").click()
    page.wait("year.step !== 12")
    page.browser.find_element(By.ID, "year-play").click()
    check_no_complaints(browser)
    assert page.end() == 130


def main():
    browser = start_browser()
    try:
        page = Page(sys.argv[1], [os.path.join(root, "scenes/kj92room/kj92room.gltf"), "--size", "160x120",
                                  "--error", "0.1", "--quiet"], browser)
        lx = None
        for check in (check_looking, check_false_colours, check_pinch, check_measuring, check_dimmers,
                      check_split, check_saving):
            print(check.__name__, flush=True)
            lx = (check(page, lx) if check is check_dimmers else check(page)) or lx
        check_no_complaints(browser)
        page.js("document.getElementById('close').click()")
        assert page.process.wait(patience) == 0
        page.wait("!document.getElementById('ended').hidden")
        page.screenshot("ended")
        browser.get("about:blank")
        browser.get_log("browser")
        check_time(sys.argv[1], browser)
        browser.get("about:blank")
        browser.get_log("browser")
        print("check_year", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            check_year(sys.argv[1], browser, folder)
    finally:
        browser.quit()


main()
