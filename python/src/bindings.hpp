#pragma once

#include <nanobind/nanobind.h>

/// One function a room: what of it Python sees.
namespace mjarm::python {

void bind_core(nanobind::module_& m);
void bind_model(nanobind::module_& m);
void bind_kinematics(nanobind::module_& m);
void bind_posture(nanobind::module_& m);
void bind_path(nanobind::module_& m);
void bind_region(nanobind::module_& m);
void bind_planning(nanobind::module_& m);
void bind_trajectory(nanobind::module_& m);
void bind_control(nanobind::module_& m);
void bind_identification(nanobind::module_& m);
void bind_execution(nanobind::module_& m);
void bind_program(nanobind::module_& m);
void bind_pick(nanobind::module_& m);
void bind_perception(nanobind::module_& m);
void bind_tags(nanobind::module_& m);
void bind_rl(nanobind::module_& m);
void bind_episode(nanobind::module_& m);
void bind_pictures(nanobind::module_& m);
void bind_view(nanobind::module_& m);

}  // namespace mjarm::python
