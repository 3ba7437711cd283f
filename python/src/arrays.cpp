#include "python/src/arrays.hpp"

#include <array>

namespace mjarm::python {
namespace {

namespace nb = nanobind;

/// What is asked of numpy for every answer; kept for ever, as a module is.
struct Numpy {
  nb::object empty = nb::module_::import_("numpy").attr("empty");
  nb::object dtype = nb::module_::import_("numpy").attr("dtype");
  nb::object doubles = dtype("d");
};

const Numpy& numpy() {
  static const auto* const kept = new Numpy;
  return *kept;
}

}  // namespace

nb::object empty_array(char type_code, std::initializer_list<std::size_t> shape) {
  const Numpy& np = numpy();
  const nb::object sizes = nb::steal(PyTuple_New(static_cast<Py_ssize_t>(shape.size())));
  Py_ssize_t i = 0;
  for (const std::size_t size : shape) {
    PyTuple_SetItem(sizes.ptr(), i++, PyLong_FromSize_t(size));
  }
  if (type_code == kTypeCode<double>) return np.empty(sizes, np.doubles);
  return np.empty(sizes, np.dtype(nb::str(&type_code, 1)));
}

}  // namespace mjarm::python
