"""The report opened from disk in headless Chromium: it loads whole, asks for nothing, complains of nothing, fits."""

import pytest

from unit.output.report.chromium import CHROMIUM, Browser

MEASURE = """(() => {
  document.querySelectorAll("details").forEach(one => { one.open = true; });
  const images = [...document.images];
  return {
    width: innerWidth,
    page: document.documentElement.scrollWidth,
    images: images.length,
    loaded: images.filter(one => one.complete && one.naturalWidth > 0).length,
    dead: [...document.links].filter(one => one.hash && !document.getElementById(one.hash.slice(1))).length,
  };
})()"""


@pytest.fixture
def browser(tmp_path):
    opened = Browser(tmp_path / "profile")
    yield opened
    opened.close()


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
@pytest.mark.parametrize("width", [390, 1280])
def test_page_in_a_browser(page, tmp_path, browser, width):
    file = tmp_path / "report.html"
    file.write_text(page, encoding="utf-8")
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
    browser.call("Page.navigate", url=file.as_uri())
    browser.wait_for("Page.loadEventFired")
    measured = browser.evaluate(MEASURE)
    assert measured["width"] == width
    assert measured["page"] <= width
    assert measured["images"] == measured["loaded"] > 10
    assert measured["dead"] == 0
    for complaint in ("Log.entryAdded", "Runtime.consoleAPICalled", "Runtime.exceptionThrown"):
        assert browser.told(complaint) == []
    asked = {request["request"]["url"].split(":")[0] for request in browser.told("Network.requestWillBeSent")}
    assert asked <= {"file", "data"}
    files = [request["request"]["url"] for request in browser.told("Network.requestWillBeSent")]
    assert [url for url in files if url.startswith("file:")] == [file.as_uri()]
