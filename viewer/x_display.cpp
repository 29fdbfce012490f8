#include "viewer/x_display.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

namespace lightwell {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(fmt::format(
      "{}. Run this in a desktop session, or under a virtual display: "
      "'xvfb-run -a lightwell view --offscreen OUT.png ...' (Debian packages xvfb, xauth and "
      "libgl1-mesa-dri)",
      what));
}

using Library = std::shared_ptr<void>;

/// VTK has loaded this library already; asking it by name saves a build dependency on X11.
Library load_x11() {
  void* const library = dlopen("libX11.so.6", RTLD_LAZY);
  return library ? Library(library, &dlclose) : nullptr;
}

}  // namespace

std::shared_ptr<void> require_display() {
  // Making the window object says which back end VTK was built with; it opens nothing yet.
  if (!vtkSmartPointer<vtkRenderWindow>::New()->IsA("vtkXOpenGLRenderWindow")) return nullptr;

  const char* name = std::getenv("DISPLAY");
  if (!name || !*name) fail("there is no X display (DISPLAY is not set), and drawing needs one");

  const Library x11 = load_x11();
  if (!x11) return nullptr;
  const auto open = reinterpret_cast<void* (*)(const char*)>(dlsym(x11.get(), "XOpenDisplay"));
  const auto close = reinterpret_cast<int (*)(void*)>(dlsym(x11.get(), "XCloseDisplay"));
  const auto has_extension = reinterpret_cast<int (*)(void*, const char*, int*, int*, int*)>(
      dlsym(x11.get(), "XQueryExtension"));
  if (!open || !close || !has_extension) return nullptr;
  void* const connection = open(name);
  if (!connection) fail(fmt::format("the X display '{}' cannot be opened", name));
  std::shared_ptr<void> display(connection, [x11, close](void* d) { close(d); });
  int opcode = 0, event = 0, error = 0;
  if (!has_extension(connection, "GLX", &opcode, &event, &error))
    fail(fmt::format("the X display '{}' cannot draw OpenGL (no GLX)", name));
  return display;
}

void report_held_keys_once(void* display) {
  const Library x11 = load_x11();
  if (!x11 || !display) return;
  const auto set =
      reinterpret_cast<int (*)(void*, int, int*)>(dlsym(x11.get(), "XkbSetDetectableAutoRepeat"));
  if (set) set(display, 1, nullptr);
}

}  // namespace lightwell
