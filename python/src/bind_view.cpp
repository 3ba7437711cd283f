// A window beside a simulation loop of the caller's own.
#include <nanobind/stl/string.h>

#include <cmath>
#include <vector>

#include "mjarm/path/curve.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"
#include "python/src/window.hpp"

namespace mjarm::python {
namespace {

BoundWindow open_window(const BoundRobot& robot, const std::string& title, bool trail,
                        bool real_time) {
  auto window = [&] {
    const nb::gil_scoped_release free;
    return BoundWindow::open(robot.robot, title.empty() ? "mjarm " + robot.arm().name : title,
                             trail, real_time);
  }();
  return value_of(std::move(window));
}

/// Puts what the user pushes into a MjData.
void push_bodies(const std::vector<Push>& pushes, nb::handle data) {
  if (pushes.empty()) return;
  const auto all = View<double>::of(nb::handle(data).attr("xfrc_applied"));
  if (!all || all->ndim() != 2 || all->shape(1) != 6) return;
  for (const Push& push : pushes) {
    if (push.body < 0 || static_cast<std::size_t>(push.body) >= all->shape(0)) continue;
    double* const row = all->data() + 6 * static_cast<std::size_t>(push.body);
    for (int k = 0; k < 3; ++k) {
      row[k] = push.force_W[k];
      row[3 + k] = push.torque_W[k];
    }
  }
}

bool show_step(BoundWindow& window, const Turn& turn, const BoundRobot& robot, nb::handle data) {
  const Model& model = robot.robot.model;
  const bool whole = nb::hasattr(data, "qpos");
  const Reals qpos = reals(whole ? data.attr("qpos") : nb::borrow(data), "qpos", {model.nq()});
  std::vector<double> qvel(static_cast<std::size_t>(model.nv()));
  double time = 0;
  if (whole) {
    const Reals given = reals(data.attr("qvel"), "qvel", {model.nv()});
    qvel.assign(given.data(), given.data() + given.size());
    time = nb::cast<double>(data.attr("time"));
  }
  const std::vector<double> q(qpos.data(), qpos.data() + qpos.size());
  const auto pushes = interruptible([&](const StopCheck& stop) {
    const auto lock = turn.lock();
    return window.sync(q, qvel, time, stop);
  });
  if (whole && nb::hasattr(data, "xfrc_applied")) push_bodies(pushes, data);
  return window.is_open();
}

/// `mjarm.Window`.
struct ShownRobot {
  BoundRobot robot;
  BoundWindow window;
  Turn turn = {};
};

constexpr const char* kView = R"(Opens a window beside a simulation loop of your own.

    with mjarm.view(robot) as window:
        while window.is_open:
            controller.step(data)
            mujoco.mj_step(model, data)
            window.sync(data)                 # shows it, and keeps real time

Parameters
----------
robot : Robot
    What is shown; its model and the loop's have to be the same.
title : str, optional
    Of the window.
trail : bool, optional
    Draw where the tool has been.
real_time : bool, optional
    sync() waits until the next step is due. The space bar pauses the loop either way.

Raises
------
NotAvailable
    There is no display.
)";

}  // namespace

void bind_view(nb::module_& m) {
  nb::class_<ShownRobot>(m, "Window", "Shows what a loop simulates; made by view().")
      .def_prop_ro(
          "is_open", [](const ShownRobot& s) { return s.window.is_open(); },
          "False once the user closed it.")
      .def(
          "sync",
          [](ShownRobot& s, nb::handle data) { return show_step(s.window, s.turn, s.robot, data); },
          nb::arg("data").none(), nb::sig("def sync(self, data: Any) -> bool"),
          "One step was made: `data` is a mujoco.MjData, or qpos (nq,). What the user pushes goes "
          "into "
          "its xfrc_applied.\nReturns whether the window is open.")
      .def(
          "add_path",
          [](ShownRobot& s, nb::handle path) {
            if (nb::isinstance<Curve>(path)) {
              const auto& curve = nb::cast<const Curve&>(path);
              s.window.add_path(curve.poses(curve.stations(0.01, 0.1)));
            } else {
              s.window.add_path(poses_of(path, "path"));
            }
          },
          nb::arg("path"), nb::sig("def add_path(self, path: Curve | PosesLike) -> None"),
          "Draws a path, dashed, from now on.")
      .def(
          "close",
          [](ShownRobot& s) {
            const nb::gil_scoped_release free;
            s.window.close();
          },
          "Closes it.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> Window"))
      .def(
          "__exit__",
          [](ShownRobot& s, nb::args) {
            const nb::gil_scoped_release free;
            s.window.close();
          },
          nb::sig("def __exit__(self, *args: Any) -> None"));
  m.def(
      "view",
      [](const BoundRobot& robot, const std::string& title, bool trail, bool real_time) {
        return ShownRobot{BoundRobot(robot.robot), open_window(robot, title, trail, real_time)};
      },
      nb::arg("robot"), nb::kw_only(), nb::arg("title") = "", nb::arg("trail") = true,
      nb::arg("real_time") = true, kView);
}

}  // namespace mjarm::python
