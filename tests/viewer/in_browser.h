#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/temporary_folder.h"
#include "viewer/export/export.h"

namespace lightwell {

using Json = nlohmann::json;

inline bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// The first of `names` that is installed; empty if none is.
inline std::string first_program(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (has_program(name)) return name;
  }
  return {};
}

inline std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> piece{};
  for (std::size_t n; (n = std::fread(piece.data(), 1, piece.size(), pipe)) > 0;) {
    text.append(piece.data(), n);
  }
  ::pclose(pipe);
  return text;
}

/// Script that collects errors from the start of the page. A browser that dumps its document draws
/// no frames, so a timer replaces requestAnimationFrame. The findings are left in the document;
/// Firefox, which cannot dump a document, writes them to standard output and closes.
inline constexpr const char* watch = R"(<head><script>
const errors = [];
for (const kind of ['error', 'warn']) console[kind] = (...words) => errors.push(words.join(' '));
window.addEventListener('error', (event) => errors.push(event.message));
// Events of the display's real pointer, which other windows share, are ignored.
for (const kind of ['move', 'enter', 'leave', 'over', 'out', 'down', 'up']) {
  window.addEventListener(`pointer${kind}`, (event) => event.isTrusted && event.stopImmediatePropagation(), true);
}
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
const report = (found) => {
  const text = encodeURIComponent(JSON.stringify(found));
  if (window.parent !== window) return window.parent.postMessage(text, '*');
  document.getElementById('result').textContent = text;
  if (!window.dump) return;
  window.dump(document.getElementById('result').outerHTML);
  window.close();
};
// Functions that scripts control the page with; positions on the page are in [0,1].
const driver = {
  wait: (ms) => new Promise((done) => setTimeout(done, ms)),
  frame: () => new Promise(requestAnimationFrame),
  async opened() {
    for (let i = 0; i < 200 && !window.lightwell; ++i) await driver.wait(50);
    return window.lightwell;
  },
  tap(key, code = '') {
    for (const type of ['keydown', 'keyup']) window.dispatchEvent(new KeyboardEvent(type, {key, code}));
  },
  // Events of a finger at a place in pixels.
  touch(kind, id, x, y, target = element('view')) {
    const event = {pointerId: id, pointerType: 'touch', clientX: x, clientY: y, bubbles: true};
    target.dispatchEvent(new PointerEvent(`pointer${kind}`, event));
  },
  // After a time in which two taps are no double tap.
  async tap_finger(x, y) {
    await driver.wait(400);
    for (const kind of ['down', 'up']) driver.touch(kind, 1, x, y);
    do await driver.frame(); while (window.lightwell.probe_due);
    return {...element('probe').dataset};
  },
  async read(x, y) {
    const page = window.lightwell, canvas = element('view');
    const at = {clientX: x * canvas.clientWidth, clientY: y * canvas.clientHeight};
    canvas.dispatchEvent(new PointerEvent('pointermove', at));
    do await driver.frame(); while (page.probe_due || page.light_due);
    return {...element('probe').dataset, text: element('probe').textContent};
  },
  pixel(x, y) {
    const {picture} = window.lightwell, gl = picture.renderer.getContext(), bytes = new Uint8Array(4);
    picture.draw();
    gl.readPixels(x * gl.drawingBufferWidth, (1 - y) * gl.drawingBufferHeight, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return [...bytes].slice(0, 3);
  },
  // `drive(page, found)` stores the values for the test in `found`.
  async run(drive) {
    const found = {};
    try {
      await drive(await driver.opened(), found);
      found.errors = errors;
      report(found);
    } catch (error) {
      report({failed: String(error.stack)});
    }
  },
};
</script>)";

/// A page of its own that shows page.html as large as a device's screen, for windows are not that
/// small, and reports what the page finds.
inline std::string in_frame(int width, int height) {
  return "<body style=\"margin: 0\"><pre id=\"result\"></pre><iframe src=\"page.html\" width=\"" +
         std::to_string(width) + "\" height=\"" + std::to_string(height) +
         "\" style=\"border: 0\"></iframe>" + R"(<script>
window.addEventListener('message', ({data}) => {
  document.getElementById('result').textContent = data;
  if (!window.dump) return;
  window.dump(document.getElementById('result').outerHTML);
  window.close();
});
</script></body>)";
}

/// Preferences of a new profile: only the page is opened, nothing is fetched (the proxy at port 9
/// does not exist), and pages may write to standard output and close.
inline constexpr const char* firefox_settings = R"(
user_pref("browser.dom.window.dump.enabled", true);
user_pref("dom.allow_scripts_to_close_windows", true);
user_pref("webgl.force-enabled", true);
user_pref("browser.aboutwelcome.enabled", false);
user_pref("browser.startup.homepage_override.mstone", "ignore");
user_pref("browser.startup.page", 0);
user_pref("browser.shell.checkDefaultBrowser", false);
user_pref("datareporting.policy.dataSubmissionEnabled", false);
user_pref("toolkit.telemetry.reportingpolicy.firstRun", false);
user_pref("app.update.enabled", false);
user_pref("network.proxy.type", 1);
user_pref("network.proxy.http", "127.0.0.1");
user_pref("network.proxy.http_port", 9);
user_pref("network.proxy.ssl", "127.0.0.1");
user_pref("network.proxy.ssl_port", 9);
)";

inline std::string decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      result += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

enum class BrowserKind { chromium, firefox };

struct PageOptions {
  bool with_webgl = true;
  WhitePoint white{};
  int width = 0, height = 0;  ///< of the screen, pixels; 0: the browser's window
};

/// A test of a page in each of the browsers.
class InBrowser : public testing::TestWithParam<BrowserKind> {
 protected:
  bool is_firefox() const { return GetParam() == BrowserKind::firefox; }

  void SetUp() override {
    browser = is_firefox() ? first_program({"firefox-esr", "firefox"})
                           : first_program({"chromium", "chromium-browser", "google-chrome"});
    if (browser.empty()) {
      GTEST_SKIP() << "the page is not opened, for there is no such browser here; on Debian: apt "
                      "install "
                   << (is_firefox() ? "firefox-esr" : "chromium");
    }
    // Without a display Firefox has no WebGL.
    has_display = std::getenv("DISPLAY") != nullptr;
    if (is_firefox() && !has_display && !has_program("xvfb-run")) {
      GTEST_SKIP() << "Firefox draws nothing without a display; on Debian: apt install xvfb xauth";
    }
  }

  /// Opens the page with a script that gives its findings to report(), and returns them.
  Json run(const BakedModel& model, const std::string& drive, const PageOptions& options = {}) {
    write_walkthrough(folder / "page.html", model, LuxRange{.low = 0.0, .high = 4000.0},
                      options.white);
    std::string page = content_of(folder / "page.html");
    page.replace(page.find("<head>"), 6, watch);
    const std::size_t end = page.rfind("</body>");
    page.replace(end, 7, "<pre id=\"result\"></pre>" + drive + "</body>");
    folder.write(options.width > 0 ? "page.html" : "driven.html", page);
    if (options.width > 0) folder.write("driven.html", in_frame(options.width, options.height));
    const std::string said =
        is_firefox() ? firefox(options.with_webgl) : chromium(options.with_webgl);
    const std::string mark = "<pre id=\"result\">";
    const std::size_t begin = said.find(mark) + mark.size(), stop = said.find("</pre>", begin);
    const std::string complaints = content_of(folder / "said");
    if (said.find(mark) == std::string::npos || stop == begin) {
      ADD_FAILURE() << "the page was not driven to its end; the browser said: "
                    << complaints.substr(0, 2000);
      return {};
    }
    // Errors of the page that Firefox reports itself.
    EXPECT_FALSE(says(complaints, "JavaScript error: file:")) << complaints;
    return Json::parse(decoded(said.substr(begin, stop - begin)));
  }

  /// The document of driven.html after the script.
  std::string chromium(bool with_webgl) {
    const std::string sandbox = ::geteuid() == 0 ? " --no-sandbox " : " ";
    const std::string options =
        with_webgl ? "--use-angle=swiftshader --enable-unsafe-swiftshader" : "--disable-3d-apis";
    return output_of(at_home(browser + " --headless" + sandbox + options +
                             " --window-size=800,700 --virtual-time-budget=60000 --dump-dom"));
  }

  /// Standard output of driven.html.
  std::string firefox(bool with_webgl) {
    const std::string webgl = with_webgl ? "" : "user_pref(\"webgl.disabled\", true);\n";
    std::filesystem::create_directory(folder / "profile");
    folder.write("profile/user.js", firefox_settings + webgl);
    return output_of(at_home((has_display ? "" : "xvfb-run -a ") + browser +
                             " --no-remote --profile '" + (folder / "profile").string() + "'"));
  }

  std::string at_home(const std::string& command) const {
    return "HOME='" + folder.path().string() + "' timeout 240 " + command + " 'file://" +
           (folder / "driven.html").string() + "' 2>'" + (folder / "said").string() + "'";
  }

  TemporaryFolder folder;
  std::string browser;
  bool has_display = false;
};

inline std::string name_of_browser(const testing::TestParamInfo<BrowserKind>& info) {
  return info.param == BrowserKind::firefox ? "Firefox" : "Chromium";
}

inline double number(const Json& json) {
  return std::stod(json.get<std::string>());
}

}  // namespace lightwell
