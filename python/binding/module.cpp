#include "python/binding/module.h"

#include <memory>

#include "python/binding/long_work.h"

#include "scene/parallel.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

/// A limit of threads that Python takes and gives back.
class Threads {
 public:
  explicit Threads(int count) : count_(count) {}
  void enter() { limit_ = std::make_unique<ThreadLimit>(count_); }
  void exit() { limit_.reset(); }

 private:
  int count_;
  std::unique_ptr<ThreadLimit> limit_;
};

}  // namespace
}  // namespace lightwell::python

NB_MODULE(_lightwell, module) {
  using namespace lightwell::python;
  module.doc() = "The compiled part of the package lightwell; use the package itself.";
  add_errors();
  add_camera(module);
  add_scene(module);
  add_form_factors(module);
  add_solve(module);
  add_solution(module);
  add_pictures(module);
  add_lightmaps(module);
  add_report(module);
  add_radiation(module);
  add_shortwave(module);
  add_daylight(module);
  nb::class_<Threads>(module, "ThreadLimit")
      .def(nb::init<int>(), nb::arg("count"))
      .def("enter", &Threads::enter)
      .def("exit", &Threads::exit);
  module.def("thread_count", &lightwell::thread_count);
  module.attr("version") = LIGHTWELL_VERSION;
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(end_long_work));
  const nb::module_ os = nb::module_::import_("os");
  if (nb::hasattr(os, "register_at_fork")) {  // Windows has no fork
    os.attr("register_at_fork")(nb::arg("after_in_child") = nb::cpp_function(forget_long_work));
  }
#ifdef NDEBUG
  nb::set_leak_warnings(false);  // daemon threads keep what they work on until the process ends
#endif
}
