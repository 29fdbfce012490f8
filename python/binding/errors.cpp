#include <exception>
#include <new>
#include <stdexcept>

#include "python/binding/module.h"
#include "scene/errors.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

void raise(const char* name, const std::exception& error) {
  PyErr_SetString(nb::module_::import_("lightwell._errors").attr(name).ptr(), error.what());
}

// Turns exceptions of the library into those of lightwell/_errors.py.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Interrupted& error) {
    raise("Interrupted", error);
  } catch (const InputError& error) {
    raise("InputError", error);
  } catch (const std::invalid_argument& error) {
    raise("InputError", error);
  } catch (const std::runtime_error& error) {
    raise("Error", error);
  }
}

}  // namespace

void add_errors() {
  nb::register_exception_translator(translate);
}

}  // namespace lightwell::python
