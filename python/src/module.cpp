#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>
#include <typeinfo>

#include "apps/mjarm/cli/cli.hpp"
#include "apps/mjarm/commands/commands.hpp"
#include "mjarm/model/mujoco_library.hpp"
#include "python/messages/python.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"

namespace {

/// What a cast inside a call finds wrong, as any other bad input.
void tell_bad_cast(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_cast&) {
    const nanobind::object kind = mjarm::python::error_class("BadInput");
    PyErr_SetString(kind.ptr(), mjarm::text(mjarm::msg::python_other_type).c_str());
  }
}

}  // namespace

NB_MODULE(_core, m) {
  using namespace mjarm;
  namespace nb = nanobind;
  nb::register_exception_translator(tell_bad_cast);
  m.attr("__doc__") = "The C++ part of mjarm; use the package `mjarm`.";
  m.attr("__version__") = MJARM_VERSION;
  m.def(
      "mujoco_version", [] { return mujoco_library().version; },
      "The version of the MuJoCo library in use, such as \"4.0.1\".");
  m.def(
      "run_program",
      [](const std::vector<std::string>& arguments) {
        const nb::gil_scoped_release free;
        return app::run(app::commands(), arguments);
      },
      nb::arg("arguments"),
      "Runs the command line as the program `mjarm` does and returns its exit code.");
  python::bind_core(m);
  python::bind_model(m);
  python::bind_kinematics(m);
  python::bind_posture(m);
  python::bind_path(m);
  python::bind_region(m);
  python::bind_planning(m);
  python::bind_trajectory(m);
  python::bind_control(m);
  python::bind_identification(m);
  python::bind_execution(m);
  python::bind_program(m);
  python::bind_pick(m);
  python::bind_perception(m);
  python::bind_tags(m);
  python::bind_rl(m);
  python::bind_episode(m);
  python::bind_pictures(m);
  python::bind_view(m);
}
