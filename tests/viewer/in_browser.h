#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/temporary_folder.h"
#include "viewer/export.h"

namespace lightwell {

using Json = nlohmann::json;

inline std::string find_browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    const std::string command = std::string("command -v ") + name + " >/dev/null 2>&1";
    if (std::system(command.c_str()) == 0) return name;
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

/// Collects what goes wrong from the very beginning. A browser that only dumps its document shows
/// no frames, so a clock stands in for them.
inline constexpr const char* watch = R"(<head><script>
const errors = [];
for (const kind of ['error', 'warn']) console[kind] = (...words) => errors.push(words.join(' '));
window.addEventListener('error', (event) => errors.push(event.message));
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
</script>)";

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

class InBrowser : public testing::Test {
 protected:
  void SetUp() override {
    browser = find_browser();
    if (browser.empty()) {
      GTEST_SKIP()
          << "no Chromium here, so the page is not opened; on Debian: apt install chromium";
    }
  }

  /// Opens the page with a script in it that leaves what it found in the element "result".
  Json run(const BakedModel& model, const std::string& drive) {
    write_walkthrough(folder / "page.html", model, LuxRange{.low = 0.0, .high = 4000.0});
    std::string page = content_of(folder / "page.html");
    page.replace(page.find("<head>"), 6, watch);
    const std::size_t end = page.rfind("</body>");
    page.replace(end, 7, drive);
    folder.write("driven.html", page);
    const std::string dom = opened("--use-angle=swiftshader --enable-unsafe-swiftshader");
    const std::string mark = "<pre id=\"result\">";
    const std::size_t begin = dom.find(mark) + mark.size(), stop = dom.find("</pre>", begin);
    if (dom.find(mark) == std::string::npos || stop == begin) {
      ADD_FAILURE() << "the page was not driven to its end; the browser said: "
                    << content_of(folder / "said").substr(0, 2000);
      return {};
    }
    return Json::parse(decoded(dom.substr(begin, stop - begin)));
  }

  /// The document of driven.html in the end.
  std::string opened(const std::string& options) {
    const std::string sandbox = ::geteuid() == 0 ? " --no-sandbox " : " ";
    return output_of(
        "HOME='" + folder.path().string() + "' timeout 240 " + browser + " --headless" + sandbox +
        options + " --window-size=640,640 --virtual-time-budget=60000 --dump-dom 'file://" +
        (folder / "driven.html").string() + "' 2>'" + (folder / "said").string() + "'");
  }

  TemporaryFolder folder;
  std::string browser;
};

inline double number(const Json& json) {
  return std::stod(json.get<std::string>());
}

}  // namespace lightwell
