"""Looks at pages of answers in Chromium, which draws with software. RADAR_PROGRAM and CHROMEDRIVER name programs."""

import json
import math
import os
import struct
import subprocess

import pytest
from selenium.webdriver import ActionChains, Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.actions import interaction
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

CUBE = """v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


def at(mesh, x, y, z):
    return [mesh, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z]


# A row of cubes at x = 0, 10, 20, 30; sensors move along x, at y = 0, or beside them, at y = 50.
QUERIES = [
    {"id": "short", "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 10},
    {"id": "long", "sensor": at(0, -9, 0, 0), "dir": [1, 0, 0], "D": 20},
    {"id": "free", "sensor": at(0, -5, 50, 0), "dir": [1, 0, 0], "D": 10},
    {"id": "inside", "sensor": at(0, 10.5, 0.5, 0.5), "dir": [1, 0, 0], "D": 10},
    {"id": "back", "sensor": at(0, 35, 0, 0), "dir": [-1, 0, 0], "D": 10, "exclude": [1]},
]


@pytest.fixture(scope="module")
def browser():
    options = ChromeOptions()
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--window-size=1200,800",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    chrome = Chrome(options=options, service=Service(os.environ["CHROMEDRIVER"]))
    yield chrome
    chrome.quit()


class View:
    """A page in the browser."""

    def __init__(self, browser, file):
        self.browser = browser
        browser.get_log("browser")
        browser.get(file.as_uri())
        self.wait("window.view && view.stage.items && !view.flight && !view.stale")

    def run(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def wait(self, condition):
        WebDriverWait(self.browser, 60, 0.05).until(lambda _: self.run(f"return {condition}"))

    def choose(self, query):
        self.run("view.choose(arguments[0], {fly: true})", query)
        self.wait("!view.flight && !view.stale")

    def pixel_of(self, place):
        """Where a place is on the canvas, by the numbers of the camera alone."""
        camera, width, height = self.run("return [view.camera, view.canvas.clientWidth, view.canvas.clientHeight]")
        c, s = math.cos(camera["yaw"]), math.sin(camera["yaw"])
        cp, sp = math.cos(camera["pitch"]), math.sin(camera["pitch"])
        right, up, forward = (-s, c, 0), (-c * sp, -s * sp, cp), (-c * cp, -s * cp, -sp)
        eye = [t - camera["distance"] * f for t, f in zip(camera["target"], forward)]
        x, y, depth = (sum((p - e) * a for p, e, a in zip(place, eye, axis)) for axis in (right, up, forward))
        scale = height / (2 * math.tan(math.pi / 9) * depth)
        return width / 2 + scale * x, height / 2 - scale * y

    def colour_at(self, place):
        x, y = self.pixel_of(place)
        script = """
            view.draw(4e6);
            const {gl} = view.renderer, colour = new Uint8Array(4);
            const [x, y] = [...arguments].map((value) => Math.round(value * devicePixelRatio));
            gl.readPixels(x, gl.drawingBufferHeight - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
            return [...colour];"""
        return self.run(script, x, y)[:3]

    def rows(self):
        """The texts of the rows in sight: status, id, t, width, object; where queries give options, these."""
        return self.run("return [...document.querySelectorAll('.room .row')].map((r) => [...r.children].map((c) => c.textContent))")

    def ids(self):
        return [row[1] for row in self.rows()]

    def click(self, place):
        x, y = self.pixel_of(place)
        canvas = self.browser.find_element(By.ID, "scene")
        size = canvas.size
        ActionChains(self.browser).move_to_element_with_offset(
            canvas, round(x - size["width"] / 2), round(y - size["height"] / 2)
        ).click().perform()

    def errors(self):
        return [entry for entry in self.browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def make_page(folder, queries, *options, chains=()):
    (folder / "cube.obj").write_text(CUBE)
    batch = {
        "format": "cyber-radar-queries-1",
        "meshes": ["cube.obj"],
        "chains": list(chains),
        "scenes": [{"instances": [at(0, 10 * i, 0, 0) for i in range(4)]}],
        "queries": [{"scene": 0, **query} for query in queries],
    }
    return write_page(folder, batch, *(options or ["--mode", "reference"]))


def write_page(folder, batch, *options):
    (folder / "batch.json").write_text(json.dumps(batch))
    page = folder / "page.html"
    program = os.environ["RADAR_PROGRAM"]
    command = [program, "view", folder / "batch.json", "--out", page, *options]
    subprocess.run(command, check=True, stdout=subprocess.PIPE)
    return page


@pytest.fixture()
def view(browser, tmp_path):
    shown = View(browser, make_page(tmp_path, QUERIES))
    yield shown
    assert shown.errors() == []


def is_like(colour, name):
    """Whether a lit surface has the hue of one of the page's colours: hit is orange, objects are grey, touched blue."""
    red, green, blue = colour
    return {
        "hit": red > 1.6 * green > 3 * blue,
        "object": max(colour) < 1.35 * min(colour),
        "touched": blue > 1.3 * red,
        "touched glass": red > 150 and blue > red + 30,
        "left out glass": red > 1.2 * green and blue > 1.1 * green,
    }[name]


def test_the_table_says_what_the_answers_say(view):
    rows = view.rows()
    assert [[status, identity, t, touched] for status, identity, t, _, touched in rows] == [
        ["● hit", "short", "3", "0"],
        ["● hit", "long", "7", "0"],
        ["○ clear", "free", "∞", ""],
        ["✕ overlap", "inside", "0", "1"],
        ["● hit", "back", "3", "3"],
    ]
    assert all(float(width) < 1e-12 for *_, width, _ in rows if width)


def test_the_chosen_sensor_is_drawn_where_the_answer_says(view):
    view.choose(1)
    view.run("view.setAlone(true); view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    # Places on the sides that the camera sees.
    assert is_like(view.colour_at((-2 + 0.5, -1, 0.6)), "hit")  # it stops at x = -2
    assert is_like(view.colour_at((0.5, -1, 0.6)), "touched glass")  # it would hide the contact
    assert not is_like(view.colour_at((-9 + 0.5, -1, 0.6)), "hit")  # where it starts, it is like glass
    view.run("view.whole(false)")
    assert is_like(view.colour_at((10.5, -1, 0.6)), "object")
    words = view.browser.find_element(By.ID, "chosen").text
    assert "Free for 7, then it touches object 0 (cube.obj)." in words


def test_the_table_filters_and_sorts(view):
    chips = {chip.text.split()[1]: chip for chip in view.browser.find_elements(By.CLASS_NAME, "chip")}
    assert sorted(chips) == ["clear", "hit", "overlap"]
    chips["hit"].click()
    assert view.ids() == ["short", "long", "back"]
    identity, number = view.browser.find_elements(By.CSS_SELECTOR, ".filters input")
    number.send_keys("0")
    assert view.ids() == ["short", "long"]
    identity.send_keys("LO")
    assert view.ids() == ["long"]
    # The scene shows no others.
    view.run("view.choose(-1); view.whole(false)")
    view.wait("!view.stale")
    assert view.run("return view.stage.items.length") == 5
    identity.send_keys(Keys.BACKSPACE * 2)
    number.send_keys(Keys.BACKSPACE)
    chips["hit"].click()
    view.browser.find_elements(By.CSS_SELECTOR, ".heads button")[2].click()
    assert view.ids() == ["inside", "short", "back", "long", "free"]
    assert view.run("return [...document.querySelectorAll('.heads span')].map((head) => head.ariaSort)[2]") == "ascending"


def test_a_click_chooses_what_is_under_it(view):
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.whole(false)")
    view.wait("!view.stale")
    view.click((33 - 0.5, -1, 0.5))  # the sensor "back", which stops at x = 32
    assert view.run("return view.look.chosen") == 4
    assert view.browser.find_element(By.CSS_SELECTOR, ".row[aria-selected=true]").text.split("\n")[1] == "back"
    view.click((20.5, -1, 0.5))
    assert view.run("return [view.look.chosen, view.look.object]") == [-1, 2]
    assert view.browser.find_element(By.CSS_SELECTOR, "#chosen h2").text == "Object 2"
    # A row flies there.
    view.browser.find_element(By.CSS_SELECTOR, ".room .row").click()
    view.wait("!view.flight && !view.stale")
    assert view.run("return view.look.chosen") == 0
    assert view.run("return view.camera.target[0]") == pytest.approx(-2.5)  # from where it starts to the end of what it touches


def test_keys_choose_and_play(view):
    body = view.browser.find_element(By.TAG_NAME, "body")
    assert view.run("return view.look.chosen") == 0  # the first hit
    body.send_keys(Keys.ARROW_DOWN)
    assert view.run("return view.look.chosen") == 1
    view.wait("!view.flight")
    view.run("view.setAlone(true); view.seek(0.5)")
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert is_like(view.colour_at((-5.5 + 0.5, -1, 0.6)), "hit")  # half of the way of 7 from x = -9
    view.run("view.seek(1); view.advance = () => {}")  # or it may be over before this looks
    body.send_keys(" ")
    assert view.run("return view.playing")
    view.run("delete view.advance")
    view.wait("!view.playing")
    assert view.run("return view.look.time") == 1
    body.send_keys(Keys.ESCAPE)
    assert view.run("return view.look.chosen") == -1


def test_the_focus_decides_what_keys_do(view):
    def press(selector, *keys):
        """Gives the focus as the tabulator does: by clicks, a canvas gets none."""
        view.run("document.querySelector(arguments[0]).focus()", selector)
        for key in keys:
            ActionChains(view.browser).send_keys(key).perform()
        return view.run("return [view.look.chosen, view.camera.yaw, view.camera.distance]")

    chosen, yaw, distance = press("#scene")
    assert press("#scene", Keys.ARROW_LEFT, Keys.ARROW_DOWN) == [chosen, pytest.approx(yaw - 0.1), distance]
    assert press("#scene", "+")[2] == pytest.approx(distance / 1.2)
    assert press(".scroller", Keys.END)[0] == 4
    assert view.run("return document.querySelector('#' + view.table.scroller.getAttribute('aria-activedescendant')).ariaSelected") == "true"
    assert press(".scroller", Keys.ARROW_UP)[0] == 3
    assert press(".scroller", Keys.HOME, Keys.PAGE_DOWN)[0] == 4
    assert press("#by", Keys.ARROW_DOWN)[0] == 4 and view.run("return view.look.by") == "t"
    press(".chip", " ")
    assert view.ids() == ["short", "long", "back"] and not view.run("return view.playing")
    view.run("view.advance = () => {}")  # or it may be over before this looks
    press("#time", Keys.HOME, " ")
    assert view.run("return view.playing")
    view.browser.find_element(By.ID, "scene").click()
    assert view.run("return document.activeElement === document.body")


def test_two_fingers_zoom(view):
    fingers = ActionBuilder(view.browser, mouse=PointerInput(interaction.POINTER_TOUCH, "one"))
    one, two = fingers.pointer_action.source, fingers.add_pointer_input(interaction.POINTER_TOUCH, "two")
    before, chosen = view.run("return [view.camera.distance, view.look.chosen]")
    for finger, x in ((one, 200), (two, 300)):
        finger.create_pointer_move(x=x, y=300)
        finger.create_pointer_down()
    one.create_pause(0.1)
    two.create_pointer_move(x=400, y=300)
    for finger in (one, two):
        finger.create_pointer_up(0)
    fingers.perform()
    assert view.run("return [view.camera.distance, view.look.chosen]") == [pytest.approx(before / 2), chosen]


def test_only_the_picture_keeps_a_context(browser, tmp_path):
    page = make_page(tmp_path, QUERIES[:1])
    record = """
        const getContext = HTMLCanvasElement.prototype.getContext;
        window.contexts = [];
        HTMLCanvasElement.prototype.getContext = function (type, ...more) {
          const context = getContext.call(this, type, ...more);
          if (type === "webgl2") contexts.push(context);
          return context;
        };"""
    script = browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": record})
    view = View(browser, page)
    browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
    assert view.run("return contexts.map((context) => context.isContextLost())") == [True, False]


def test_a_lost_context_returns(view):
    view.choose(1)
    view.run("view.setAlone(true); view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    view.run("window.loss = view.renderer.gl.getExtension('WEBGL_lose_context'); loss.loseContext(); view.change()")
    view.wait("document.querySelector('#note').textContent.includes('has lost its graphics device')")
    view.run("loss.restoreContext()")
    view.wait("document.querySelector('#note').textContent.trim() === ''")
    assert is_like(view.colour_at((-2 + 0.5, -1, 0.6)), "hit")
    # The browser says that it was lost.
    assert all("CONTEXT_LOST_WEBGL" in entry["message"] for entry in view.errors())


def test_text_of_a_batch_is_text(browser, tmp_path):
    hostile = "<img src=x onerror=\"document.title='mine'\"></script>"
    view = View(browser, make_page(tmp_path, [{**QUERIES[0], "id": hostile}]))
    assert view.ids() == [hostile]
    view.choose(0)
    assert view.browser.find_element(By.CSS_SELECTOR, "#chosen h2").text == f"● {hostile}"
    assert view.run("return document.images.length") == 0
    assert view.browser.title.endswith("batch.json")
    assert view.errors() == []


def test_mode_sampled_shows_the_scopes(browser, tmp_path):
    view = View(browser, make_page(tmp_path, QUERIES[:1], "--mode", "sampled", "--resolution", "64"))
    view.choose(0)
    words = view.browser.find_element(By.ID, "chosen").text
    for part in ("64 × 64 pixels", "R: ", "M: ", "L: ", "An exact search: free for 3, then it touches object 0."):
        assert part in words
    picture = view.browser.find_elements(By.CSS_SELECTOR, "figure canvas")[2]
    view.run("arguments[0].scrollIntoView()", picture)
    ActionChains(view.browser).move_to_element(picture).perform()
    under = view.browser.find_elements(By.CLASS_NAME, "under")[2].text
    assert under.startswith("pixel 32, 3") and float(under.split(": ")[1]) == pytest.approx(3, abs=1e-4)
    assert view.errors() == []


def test_a_page_without_queries_shows_its_scene(browser, tmp_path):
    view = View(browser, make_page(tmp_path, []))
    assert view.rows() == []
    assert view.run("return view.stage.items.length") == 4
    view.browser.find_element(By.TAG_NAME, "body").send_keys(Keys.ARROW_DOWN, "f", " ")
    view.wait("!view.playing")
    assert view.errors() == []


def test_objects_move_and_deform_and_steps_have_scenes_of_their_own(browser, tmp_path):
    lines = [line.split() for line in CUBE.splitlines()]
    corners = [[float(x) for x in rest] for kind, *rest in lines if kind == "v"]
    faces = [[int(x) - 1 for x in rest] for kind, *rest in lines if kind == "f"]
    header = ["ply", "format ascii 1.0", "element vertex 8", *(f"property float {axis}" for axis in "xyz")]
    header += ["element face 6", "property list uchar int vertex_indices", "end_header"]
    rows = [" ".join(map(str, row)) for row in [*corners, *([4, *face] for face in faces)]]
    (tmp_path / "cube.ply").write_text("\n".join([*header, *rows, ""]))
    stretched = [3 * x for corner in corners for x in corner]
    (tmp_path / "stretched.f32").write_bytes(struct.pack(f"<{len(stretched)}f", *stretched))
    scenes = [
        {"id": "moving", "instances": [at(0, 0, 0, 0), at(0, 20, 0, 0)], "motions": [[1, -4, 0, 0]]},
        {"id": "deformed", "base": 0, "instances": [at(0, 0, 40, 0)], "deforms": [[0, "stretched.f32"]]},
    ]
    queries = [
        {"id": "meets", "scene": 0, "sensor": at(0, 8, 0, 0), "motion": [16, 0, 0]},
        {"id": "grown", "scene": 1, "sensor": at(0, 8, 40, 0), "dir": [-1, 0, 0], "D": 10},
    ]
    batch = {"format": "cyber-radar-queries-1", "meshes": ["cube.ply"], "scenes": scenes, "queries": queries}
    view = View(browser, write_page(tmp_path, batch, "--mode", "reference"))
    view.choose(0)
    assert "Free for 0.5 of the step, then it touches object 1 (cube.ply)." in view.browser.find_element(By.ID, "chosen").text
    view.run("view.setAlone(true); view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert is_like(view.colour_at((16 + 0.5, -1, 0.6)), "hit")
    assert is_like(view.colour_at((18 + 0.5, -1, 0.6)), "touched glass")  # halfway through the step
    view.choose(1)
    assert view.run("return view.data.scene(view.look.scene).objects.count") == 3
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert view.rows()[1][2] == "2"
    assert is_like(view.colour_at((2.5, 37, 2.5)), "touched")  # three times as large
    assert not view.run("return view.renderer.meshBuffers.has(view.data.meshes[0])")  # of the other scene
    assert view.errors() == []


def test_a_sensor_that_turns_is_drawn_where_its_turn_takes_it(browser, tmp_path):
    # A cube on an arm of 10 about (0, -10), from the right to below the row's first cube, and on a screw.
    queries = [
        {
            "id": "swings",
            "sensor": at(0, 10, -10, 0),
            "turn": {"axis": [0, 0, 5], "angle": 3, "centre": [0, -10, 0]},
        },
        {
            "id": "screws",
            "sensor": at(0, 40, 60, 0),
            "motion": [0, 0, 20],
            "turn": {"axis": [0, 0, 1], "angle": 6.28318530718, "centre": [40, 50, 0]},
        },
    ]
    view = View(browser, make_page(tmp_path, queries))
    words = words_of(view, 0)
    assert "then it touches object 0 (cube.obj)." in words and "It turns by 171.9° about (0, 0, 5) through (0, -10, 0)." in words
    share = view.run("return view.data.answers[0].share")
    angle = 3 * share
    assert 1 < angle < math.pi / 2
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.setAlone(true); view.change()")

    def middle_of_top(angle):
        return 10 * math.cos(angle), -10 + 10 * math.sin(angle), 1

    def colour(place):
        view.run("view.stage.begin(4e6)")
        return view.colour_at(place)

    assert is_like(colour(middle_of_top(angle)), "hit")
    for time in (0.25, 0.5):
        view.run("view.seek(arguments[0])", time)
        assert is_like(colour(middle_of_top(time * angle)), "hit"), time
        assert not is_like(colour(middle_of_top(0.85 * angle)), "hit")
    # What plays: the same turn at all times, and at half its way the screw is on the other side, half as high.
    view.choose(1)
    view.run("view.seek(0.5)")
    place = view.run("return view.data.placeAt(1, 0.5)")
    assert [round(x, 6) for x in place] == [40, 40, 10]
    view.run("view.camera.target = [40, 40, 10]; view.camera.distance = 40; view.change()")
    assert max(colour((40, 40, 11))) > 1.2 * min(colour((40, 40, 11)))
    assert view.errors() == []


def test_a_chain_is_drawn_where_its_joints_take_it(browser, tmp_path):
    # The same swing: an arm of 10, and on it a tip, 4 higher.
    turning = {"joint": "revolute", "axis": [0, 0, 2]}
    links = [{"name": "arm", **turning, "meshes": [at(0, 10, 0, 0)]}, {"name": "tip", "parent": "arm", "meshes": [at(0, 14, 0, 4)]}]
    query = {"id": "swings", "chain": 0, "from": [0.5], "to": [3], "base": at(0, 0, -10, 0)[1:]}
    view = View(browser, make_page(tmp_path, [query], chains=[{"links": links}]))
    words = words_of(view, 0)
    assert "then its link arm touches object 0 (cube.obj)." in words and "Chain: 2 links, 2 meshes, 24 triangles" in words
    share = view.run("return view.data.answers[0].share")
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.6; view.setAlone(true); view.change()")
    for time in (1, 0.5, 0.25):
        view.run("view.seek(arguments[0])", time)
        view.run("view.stage.begin(4e6)")
        for angle, is_there in ((0.5 + 2.5 * time * share, True), (0.1, False)):
            for reach, height in ((10, 1), (14, 5)):
                place = reach * math.cos(angle), -10 + reach * math.sin(angle), height
                assert is_like(view.colour_at(place), "hit") == is_there, (time, place)
    assert view.errors() == []


def words_of(view, query):
    view.choose(query)
    return view.browser.find_element(By.ID, "chosen").text


def legend(view):
    return view.browser.find_element(By.ID, "legend").text


def test_an_answer_to_whether_there_is_a_contact_says_no_more(browser, tmp_path):
    queries = [
        {"id": "whether", "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 10, "any_hit": True},
        {"id": "near", "sensor": at(0, -5, 2.5, 0), "dir": [1, 0, 0], "D": 10, "any_hit": True, "clearance": 0.75},
    ]
    view = View(browser, make_page(tmp_path, queries))
    assert view.run("return [view.camera.distance, ...view.camera.target].every(Number.isFinite)")
    assert [row[2:] for row in view.rows()] == [["≤ 10", "", "", "any_hit"], ["≤ 10", "", "", "any_hit, clearance 0.75"]]
    view.choose(0)
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert is_like(view.colour_at((-5 + 0.5, -1, 0.6)), "hit")  # where it starts: where it stops was not asked
    assert view.errors() == []


def test_a_gap_is_no_contact_and_is_drawn_with_its_length(browser, tmp_path):
    queries = [
        {"id": "comes near", "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 10, "clearance": 0.75},
    ]
    view = View(browser, make_page(tmp_path, queries))
    # As if an answer had the length, and as if it had not.
    for gap in ("0.75", "NaN"):
        view.run(f"view.data.answers[0].gap = {gap}; view.overlay.key = ''; view.change()")
        comes = words_of(view, 0)
        assert "Comes within 0.75 of object 0 (cube.obj) after 2.25." in comes
        assert ("The gap is then 0.75 long" in comes) == (gap != "NaN")
        labels = view.browser.find_element(By.ID, "labels").text
        assert ("0.75" in labels) == (gap != "NaN")
        assert ("the gap" in legend(view)) == (gap != "NaN")
    assert view.errors() == []


def test_all_contacts_that_a_query_lists_are_shown(browser, tmp_path):
    queries = [
        {"id": "several", "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 30, "hits": "all", "ignore_leaving": True},
        {"id": "one", "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 10},
    ]
    view = View(browser, make_page(tmp_path, queries))
    assert [(row[4], row[5]) for row in view.rows()] == [("0 + 2", "ignore_leaving, hits all"), ("0", "")]
    words = words_of(view, 0)
    assert "Free for 3, then object 0 (cube.obj) blocks it." in words and "It may leave what it rests on" in words
    assert view.browser.find_element(By.ID, "labels").text.count("cube.obj") == 3
    buttons = view.browser.find_elements(By.CSS_SELECTOR, "#chosen li button")
    assert [button.text for button in buttons] == [f"{3 + 10 * i}: object {i} (cube.obj)" for i in range(3)]
    buttons[2].click()
    view.wait("!view.flight && !view.stale")
    assert "After 23, object 2 (cube.obj) blocks it, if nothing does before." in view.browser.find_element(By.ID, "chosen").text
    assert view.run("return document.activeElement.ariaPressed") == "true"
    view.run("view.setAlone(true); view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert is_like(view.colour_at((18 + 0.5, -1, 0.6)), "hit")
    assert "listed moments" in legend(view)
    view.choose(1)
    assert view.browser.find_elements(By.CSS_SELECTOR, "#chosen li") == []
    assert view.errors() == []


def test_objects_left_out_are_named_and_drawn_as_glass(browser, tmp_path):
    queries = [
        {"id": "stuck", "sensor": at(0, 10.5, 0.5, 0.5), "dir": [0, 0, 1], "D": 5, "skip_overlapping": True},
        {"id": "free", "sensor": at(0, 10, 50, 0), "dir": [0, 0, 1], "D": 5, "skip_overlapping": True},
    ]
    view = View(browser, make_page(tmp_path, queries))
    assert [row[0] for row in view.rows()] == ["○ clear, 1 left out", "○ clear"]
    words = words_of(view, 0)
    assert "Crosses object 1 (cube.obj) where it starts; left out" in words and "Touches nothing else within 5." in words
    assert "object 1 (cube.obj), left out" in view.browser.find_element(By.ID, "labels").text
    view.run("view.camera.yaw = -1.2; view.camera.pitch = 0.4; view.change()")
    assert is_like(view.colour_at((9.2, -1, -0.6)), "left out glass")
    assert "left out" not in words_of(view, 1)
    assert view.errors() == []


def test_what_is_far_away_is_counted_and_does_not_shrink_the_rest(browser, tmp_path):
    (tmp_path / "cube.obj").write_text(CUBE)
    scenes = [{"instances": [at(0, 0, 0, 0), at(0, 10, 0, 0), at(0, 1e6, 0, 0), [0, 1, 0, 0, 1e200, 0, 1, 0, 0, 0, 0, 1, 0]]}]
    queries = [
        {"id": "hits", "scene": 0, "sensor": at(0, -5, 0, 0), "dir": [1, 0, 0], "D": 10},
        {"id": "free", "scene": 0, "sensor": at(0, -5, 5, 0), "dir": [1, 0, 0], "D": 1e9},
    ]
    batch = {"format": "cyber-radar-queries-1", "meshes": ["cube.obj"], "scenes": scenes, "queries": queries}
    view = View(browser, write_page(tmp_path, batch, "--mode", "reference"))
    far = view.browser.find_element(By.ID, "far")
    assert far.text == "2 objects far away"
    view.run("view.whole(false)")
    view.wait("!view.stale")
    assert view.run("return view.camera.distance") < 200
    far.click()
    view.wait("!view.flight && !view.stale")
    assert view.run("return view.camera.distance") > 1e6  # what a picture can hold
    assert view.errors() == []


def test_a_sensor_that_hides_its_contact_is_glass(view):
    view.choose(4)  # it stands at x = 33 and touches the cube at x = 30, seen from beyond it
    _, y, z = view.run("return view.data.answers[4].point")  # a corner; seen through the sensor
    view.run("Object.assign(view.camera, arguments[0]); view.change()", {"yaw": -0.2 * y, "pitch": -0.3 * z})
    view.wait("!view.stale")
    assert view.run("return view.stage.items.filter((item) => item.placed === view.data.sensors && item.i === 4).length") == 0
    view.run("view.camera.yaw = 3; view.change()")
    view.wait("!view.stale")
    assert view.run("return view.stage.items.filter((item) => item.placed === view.data.sensors && item.i === 4).length") == 1


def test_a_legend_a_scale_and_axes_say_what_is_seen(view):
    assert legend(view).splitlines()[:3] == ["● hit", "○ clear", "✕ overlap"]
    view.run("view.look.by = 't'; view.change()")
    view.wait("!view.stale")
    assert "t = 7" in legend(view)
    length, width = view.run("return [Number(view.overlay.scale.textContent), view.overlay.scale.getBoundingClientRect().width]")
    camera, height = view.run("return [view.camera, view.canvas.clientHeight]")
    assert width == pytest.approx(length * height / (2 * math.tan(math.pi / 9) * camera["distance"]), abs=1)
    assert view.run("return view.overlay.axes.getContext('2d').getImageData(0, 0, 72, 72).data.some((x) => x > 0)")


def test_heads_stand_over_their_columns_beside_a_scrollbar(browser, tmp_path):
    queries = [{**QUERIES[0], "id": f"{i}"} for i in range(200)]
    view = View(browser, make_page(tmp_path, queries))
    ends = view.run(
        "return ['.heads', '.room .row'].map((row) => [...document.querySelector(row).children].map((c) => c.getBoundingClientRect().right))"
    )
    assert ends[0] == pytest.approx(ends[1], abs=0.6)
    # The row of what is chosen is in sight, whatever room the words about it take.
    view.run("view.choose(-1); view.table.scroller.scrollTop = 0; view.choose(Math.floor(view.table.scroller.clientHeight / 24) - 3)")
    places = ["[aria-selected=true]", ".scroller"]
    row, table = view.run("return arguments[0].map((place) => document.querySelector(place).getBoundingClientRect().bottom)", places)
    assert row <= table
    assert view.errors() == []
