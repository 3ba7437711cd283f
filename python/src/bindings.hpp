#pragma once

#include <nanobind/nanobind.h>

/// One function a room: what of it Python sees.
namespace mjarm::python {

void bind_core(nanobind::module_& m);
void bind_model(nanobind::module_& m);
void bind_kinematics(nanobind::module_& m);
void bind_path(nanobind::module_& m);
void bind_planning(nanobind::module_& m);
void bind_trajectory(nanobind::module_& m);

}  // namespace mjarm::python
