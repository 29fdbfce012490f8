#include "viewer/window/x_display.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

namespace lightwell {
namespace {

/// Attempts to open a display; a server that restarts is back in a fraction of their time.
constexpr int tries = 10;
constexpr std::chrono::milliseconds between_tries{50};

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(fmt::format(
      "{}. Run this in a desktop session, or under a virtual display: "
      "'xvfb-run -a lightwell view --offscreen OUT.png ...' (Debian packages xvfb, xauth and "
      "libgl1-mesa-dri)",
      what));
}

double scale_at(double dots_per_inch) {
  constexpr double plain = 96.0, most = 4.0;
  return std::clamp(dots_per_inch / plain, 1.0, most);
}

}  // namespace

/// The X library's functions, found by name in the library that VTK has loaded already, which saves
/// a build dependency.
struct DisplayConnection::Impl {
  Impl() : library(dlopen("libX11.so.6", RTLD_LAZY)) {}
  ~Impl() {
    if (display) function<int(void*)>("XCloseDisplay")(display);
    if (library) dlclose(library);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  template <class F>
  F* function(const char* name) const {
    return library ? reinterpret_cast<F*>(dlsym(library, name)) : nullptr;
  }
  void open(const char* name) {
    auto* const open_display = function<void*(const char*)>("XOpenDisplay");
    for (int i = 0; i < tries && !display; ++i) {
      if (i > 0) std::this_thread::sleep_for(between_tries);
      display = open_display(name);
    }
  }
  bool draws_opengl() const {
    int opcode = 0, event = 0, error = 0;
    return function<int(void*, const char*, int*, int*, int*)>("XQueryExtension")(
               display, "GLX", &opcode, &event, &error) != 0;
  }

  double text_scale() const {
    const auto* const resources = function<const char*(void*)>("XResourceManagerString")(display);
    if (const auto scale = text_scale_in(resources ? resources : "")) return *scale;
    constexpr double inch = 25.4;  // mm
    const int pixels = function<int(void*, int)>("XDisplayWidth")(display, 0);
    const int mm = function<int(void*, int)>("XDisplayWidthMM")(display, 0);
    return mm > 0 ? scale_at(inch * pixels / mm) : 1.0;
  }

  void* library = nullptr;
  void* display = nullptr;
};

std::optional<double> text_scale_in(std::string_view resources) {
  constexpr std::string_view name = "Xft.dpi:";
  for (std::size_t at = 0; at < resources.size();) {
    const std::size_t end = std::min(resources.find('\n', at), resources.size());
    std::string_view line = resources.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with(name)) continue;
    const double dpi = std::strtod(std::string(line.substr(name.size())).c_str(), nullptr);
    if (dpi > 0.0) return scale_at(dpi);
  }
  return std::nullopt;
}

double screen_text_scale() {
  DisplayConnection::Impl x;
  const char* const name = std::getenv("DISPLAY");
  if (!x.library || !name) return 1.0;
  x.open(name);
  return x.display ? x.text_scale() : 1.0;
}

DisplayConnection::DisplayConnection() : impl_(std::make_unique<Impl>()) {
  // The class of a new window object shows VTK's back end; no display is opened by its constructor.
  if (!vtkSmartPointer<vtkRenderWindow>::New()->IsA("vtkXOpenGLRenderWindow")) return;
  const char* name = std::getenv("DISPLAY");
  if (!name || !*name) fail("there is no X display (DISPLAY is not set), and drawing needs one");
  if (!impl_->library) return;
  impl_->open(name);
  if (!impl_->display) fail(fmt::format("the X display '{}' cannot be opened", name));
  if (!impl_->draws_opengl()) {
    fail(fmt::format("the X display '{}' cannot draw OpenGL (no GLX)", name));
  }
}

DisplayConnection::~DisplayConnection() = default;

void hide_window(void* display, void* window) {
  void* library = dlopen("libX11.so.6", RTLD_LAZY);
  if (!library) return;
  using Unmap = int (*)(void*, unsigned long);
  using Sync = int (*)(void*, int);
  const auto unmap = reinterpret_cast<Unmap>(dlsym(library, "XUnmapWindow"));
  const auto sync = reinterpret_cast<Sync>(dlsym(library, "XSync"));
  if (unmap && sync && display && window) {
    unmap(display, reinterpret_cast<unsigned long>(window));
    sync(display, 0);
  }
  dlclose(library);
}

void report_held_keys_once(void* display) {
  void* library = dlopen("libX11.so.6", RTLD_LAZY);
  if (!library) return;
  using Set = int (*)(void*, int, int*);
  const auto set = reinterpret_cast<Set>(dlsym(library, "XkbSetDetectableAutoRepeat"));
  if (set && display) set(display, 1, nullptr);
  dlclose(library);
}

}  // namespace lightwell
