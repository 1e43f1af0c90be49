# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens an exported page in Chromium without a network, uses it as a person does, and says as JSON
what it showed: viewer_browser.py PAGE PICTURE LAYER"""
import json
import sys

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

# The colors in every 3rd mask pixel that a view shows, in the first of its voxels.
SAMPLES = """
const [id] = arguments;
const canvas = document.getElementById(id);
const {mmPerPixel, left, top, ratio} = windowOf(canvas);
const context = canvas.getContext('2d');
const samples = [];
for (let j = 0; j < job.size_px[1]; j += 3) {
  for (let i = 0; i < job.size_px[0]; i += 3) {
    const x = Math.floor(((i + 0.4) * job.pitch_mm[0] - left) / mmPerPixel);
    const y = Math.floor(((j + 0.4) * job.pitch_mm[1] - top) / mmPerPixel);
    if (x < 1.5 * kRuler * ratio || y < kRuler * ratio || x >= canvas.width || y >= canvas.height) continue;
    samples.push([i, j, ...context.getImageData(x, y, 1, 1).data.slice(0, 3)]);
  }
}
return samples;
"""


def main():
    page, picture, layer = sys.argv[1], sys.argv[2], int(sys.argv[3])
    options = webdriver.ChromeOptions()
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                 "--window-size=1600,1000", "--host-resolver-rules=MAP * ~NOTFOUND"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options)
    try:
        told = {"layers": []}
        wait = WebDriverWait(driver, 60)
        shows = lambda number: lambda d: d.find_element(By.TAG_NAME, "body").get_attribute(
            "data-layer") == str(number)

        driver.get("file://" + page)
        first = driver.execute_script("return job.first + Math.floor(job.size_px[2] / 2)")
        wait.until(shows(first))
        told["views"] = [c.get_attribute("id") for c in driver.find_elements(By.TAG_NAME, "canvas")]

        def press(key, number):
            ActionChains(driver).send_keys(key).perform()
            wait.until(shows(number))
            told["layers"].append(number)

        press(Keys.HOME, 0)
        press(Keys.ARROW_RIGHT, 1)
        press(Keys.PAGE_UP, 11)
        press(Keys.ARROW_LEFT, 10)
        slider = driver.find_element(By.ID, "slider")
        driver.execute_script("arguments[0].value = arguments[1];"
                              "arguments[0].dispatchEvent(new Event('input'))", slider, layer)
        wait.until(shows(layer))
        told["layers"].append(layer)
        driver.save_screenshot(picture)
        told["whole"] = {view: driver.execute_script(SAMPLES, view) for view in told["views"]}

        # The wheel zooms around the pointer, here the part's left edge.
        before = driver.execute_script("return zoom")
        mask = driver.find_element(By.ID, "mask")
        edge = driver.execute_script("return Math.round(-boxMm[0] * 0.47 * zoom + 0.75 * kRuler)")
        at = ScrollOrigin.from_element(mask, edge, 13)
        for _ in range(5):
            ActionChains(driver).scroll_from_origin(at, 0, -120).perform()
        ActionChains(driver).send_keys("+").perform()
        told["zoom"] = driver.execute_script("return zoom") / before
        told["near"] = {view: driver.execute_script(SAMPLES, view) for view in told["views"]}

        driver.save_screenshot(picture.replace(".png", "_near.png"))

        ActionChains(driver).move_to_element(mask).perform()
        told["where"] = driver.find_element(By.ID, "where").text
        # The first place to look at, where there is one.
        places = driver.find_elements(By.CSS_SELECTOR, "nav button")
        told["places"] = [place.text for place in places]
        if places:
            places[0].click()
            WebDriverWait(driver, 60).until(
                lambda d: d.execute_script("return mark !== null && mark.layer === index"))
            told["flown_to"] = driver.execute_script(
                "return [center[0] + job.origin_mm[0], center[1] + job.origin_mm[1],"
                " index + job.first]")
            driver.save_screenshot(picture.replace(".png", "_place.png"))
        told["faults"] = [entry["message"] for entry in driver.get_log("browser")
                          if entry["level"] == "SEVERE"]
        asked = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
        told["requests"] = [a["params"]["request"]["url"][:100] for a in asked
                            if a["method"] == "Network.requestWillBeSent"
                            and not a["params"]["request"]["url"].startswith("data:")]
        print(json.dumps(told))
    finally:
        driver.quit()


main()
