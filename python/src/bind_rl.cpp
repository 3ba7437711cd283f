// Learning: the environment of `mjarm train`, and policies.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/onnx_export.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/trained_policy.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"
#include "python/src/interrupt.hpp"

namespace mjarm::python {
namespace {

using Floats = View<const float>;

/// Anything array-like as float32; without a copy where it is that already.
Floats floats(nb::handle value, const char* name) {
  if (std::optional<Floats> out = Floats::of(value)) return std::move(*out);
  (void)reals(value, name);  // or says what is wrong
  return *Floats::of(nb::module_::import_("numpy").attr("asarray")(value, "float32", "C"));
}

/// `mjarm.gym` has it: the environment, and what draws it.
struct BoundReach {
  rl::ReachEnv env;
  std::optional<render::OffscreenRenderer> renderer = {};
  int width = 0, height = 0;  // [px] of the renderer

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(env.count()); }
  [[nodiscard]] std::size_t observations() const {
    return static_cast<std::size_t>(env.observation_size());
  }
};

/// What can be told of the task by words.
struct TaskWords {
  std::string region, action, gripper;
  int frame_skip, episode_steps;
  double start_spread, speed, torque;
  bool orientation, obstacle, guide;
};

rl::ReachOptions task_of(const TaskWords& words, int environments, int threads) {
  rl::ReachOptions options = words.guide ? rl::guide_options() : rl::ReachOptions();
  options.environments = environments;
  options.threads = threads;
  if (words.guide) return options;
  options.region = value_of(rl::reach_region(words.region));
  options.action = value_of(rl::reach_action(words.action));
  options.gripper = value_of(rl::reach_gripper(words.gripper));
  options.frame_skip = words.frame_skip;
  options.episode_steps = words.episode_steps;
  options.start_spread = words.start_spread;
  options.speed = words.speed;
  options.torque = words.torque;
  options.orientation = words.orientation;
  options.obstacle = words.obstacle;
  return options;
}

std::unique_ptr<BoundReach> make_reach(int environments, int threads, const std::string& region,
                                       const std::string& action, const std::string& gripper,
                                       int frame_skip, int episode_steps, double start_spread,
                                       double speed, double torque, bool orientation, bool obstacle,
                                       bool guide) {
  const rl::ReachOptions options =
      task_of({region, action, gripper, frame_skip, episode_steps, start_spread, speed, torque,
               orientation, obstacle, guide},
              environments, threads);
  const Model model = value_of(rl::reach_model(options));
  return std::make_unique<BoundReach>(BoundReach{value_of(rl::ReachEnv::create(model, options))});
}

nb::object observations(const BoundReach& self) {
  return array<float>(self.env.observations(), {self.count(), self.observations()});
}

nb::object reset_reach(BoundReach& self, std::uint64_t seed) {
  value_of(self.env.reset(seed));
  return observations(self);
}

/// (observations, rewards, terminated, truncated).
nb::tuple step_reach(BoundReach& self, nb::handle actions) {
  const Floats given = floats(actions, "actions");
  const auto width = static_cast<std::size_t>(self.env.action_size());
  if (given.ndim() != 2 || given.shape(0) != self.count() || given.shape(1) != width) {
    refuse(msg::python_actions, self.count(), width);
  }
  // With the interpreter's lock: nobody may read while it steps, and a step is short.
  value_of(self.env.step({given.data(), given.size()}));
  return nb::make_tuple(observations(self), array<float>(self.env.rewards(), {self.count()}),
                        array<bool>(self.env.terminated(), {self.count()}),
                        array<bool>(self.env.truncated(), {self.count()}));
}

void check_copy(const BoundReach& self, int copy) {
  if (copy < 0 || copy >= self.env.count()) refuse(msg::python_copy, self.env.count());
}

nb::object draw_reach(BoundReach& self, int copy, int width, int height) {
  check_copy(self, copy);
  check_pixels(width, height);
  if (!self.renderer || self.width != width || self.height != height) {
    self.renderer = value_of(render::OffscreenRenderer::create(
        self.env.model(),
        {.width = width, .height = height, .software_quality = render::RenderQuality::low}));
    self.width = width;
    self.height = height;
  }
  render::Overlay overlay;
  overlay.spheres.push_back(
      {.p_W = self.env.goal(copy), .radius = 0.02, .color = {0.15F, 0.70F, 0.30F, 0.6F}});
  const render::Image image = value_of(self.renderer->draw(self.env.snapshot(copy), {}, overlay));
  return array_of(image);
}

/// The name of a shipped policy, or a file.
rl::TrainedPolicy load_policy(nb::handle name_or_path) {
  const std::filesystem::path given = path_text(name_or_path);
  std::error_code none;
  const bool shipped =
      !std::filesystem::exists(given, none) && given.filename() == given && !given.has_extension();
  if (!shipped) return value_of(rl::load_policy(given));
  const auto file = find_model_file("policies/" + given.string() + ".safetensors");
  const std::vector<std::string> known{"reach"};
  if (!file) {
    refuse(msg::python_policy, given.string(), did_you_mean(given.string(), known), known.front());
  }
  return value_of(rl::load_policy(*file));
}

nb::object act(const rl::TrainedPolicy& self, nb::handle observation) {
  const Floats given = floats(observation, "observation");
  const auto width = static_cast<std::size_t>(self.policy.shape().observations);
  const auto out = static_cast<std::size_t>(self.policy.shape().actions);
  const bool one = given.ndim() == 1;
  if (given.ndim() < 1 || given.ndim() > 2 || given.shape(given.ndim() - 1) != width) {
    refuse(msg::python_observation, width, width);
  }
  const std::size_t rows = one ? 1 : given.shape(0);
  std::vector<float> actions;
  {
    const nb::gil_scoped_release free;
    for (std::size_t i = 0; i < rows; ++i) {
      const Eigen::VectorXf action = self.policy.act({given.data() + i * width, width});
      actions.insert(actions.end(), action.begin(), action.end());
    }
  }
  const std::span<const float> all = actions;
  return one ? array<float>(all, {out}) : array<float>(all, {rows, out});
}

nb::dict evaluate(const rl::TrainedPolicy& self, int episodes, std::uint64_t seed, int threads) {
  rl::ReachOptions task = self.task;
  task.threads = threads;
  const Model model = value_of(rl::reach_model(task));
  const rl::Evaluation found = value_of(interruptible([&](const StopCheck& stop) {
    return rl::evaluate(model, task, self.policy,
                        {.episodes = episodes, .seed = seed, .stop = stop});
  }));
  nb::dict out;
  out["episodes"] = found.episodes;
  out["within_5cm"] = found.within_5cm;
  out["within_2cm"] = found.within_2cm;
  out["within_1cm"] = found.within_1cm;
  out["within_5mm"] = found.within_5mm;
  out["median"] = found.median;
  out["p95"] = found.p95;
  out["max"] = found.max;
  out["distances"] = array(found.distances, {found.distances.size()});
  return out;
}

void bind_env(nb::module_& m) {
  const rl::ReachOptions usual;
  nb::class_<BoundReach>(m, "ReachBatch",
                         "Many copies of the task of `mjarm train reach`, stepped together.")
      .def(nb::new_(&make_reach), nb::kw_only(), nb::arg("environments") = 1,
           nb::arg("threads") = 1, nb::arg("region") = std::string(rl::name(usual.region)),
           nb::arg("action") = std::string(rl::name(usual.action)),
           nb::arg("gripper") = std::string(rl::name(usual.gripper)),
           nb::arg("frame_skip") = usual.frame_skip, nb::arg("episode_steps") = usual.episode_steps,
           nb::arg("start_spread") = usual.start_spread, nb::arg("speed") = usual.speed,
           nb::arg("torque") = usual.torque, nb::arg("orientation") = false,
           nb::arg("obstacle") = false, nb::arg("guide") = false)
      .def_prop_ro(
          "count", [](const BoundReach& b) { return b.env.count(); }, "Copies.")
      .def_prop_ro(
          "observation_size", [](const BoundReach& b) { return b.env.observation_size(); },
          "Numbers of an observation.")
      .def_prop_ro(
          "action_size", [](const BoundReach& b) { return b.env.action_size(); },
          "Numbers of an action, each -1 to 1.")
      .def_prop_ro(
          "fps",
          [](const BoundReach& b) {
            return 1 / (b.env.model().timestep() * b.env.options().frame_skip);
          },
          "Actions a simulated second.")
      .def("reset", &reset_reach, nb::arg("seed"), nb::sig("def reset(self, seed: int) -> Floats"),
           "Starts every copy anew; observations (count, n).")
      .def("step", &step_reach, nb::arg("actions"),
           nb::sig("def step(self, actions: ArrayLike) -> tuple[Floats, "
                   "Floats, "
                   "Flags, Flags]"),
           "One step of every copy: observations, rewards, terminated, truncated. A copy whose "
           "episode "
           "ended has begun another.")
      .def_prop_ro(
          "final_observations",
          [](const BoundReach& b) {
            return array<float>(b.env.final_observations(), {b.count(), b.observations()});
          },
          nb::sig("def final_observations(self) -> Floats"),
          "The last ones of episodes that ended in the step just done; other rows mean nothing.")
      .def_prop_ro(
          "distances",
          [](const BoundReach& b) { return array<double>(b.env.distances(), {b.count()}); },
          nb::sig("def distances(self) -> Array"),
          "From tool to goal after the step just done [m], (count,).")
      .def(
          "goal",
          [](const BoundReach& b, int copy) {
            check_copy(b, copy);
            return array(b.env.goal(copy));
          },
          nb::arg("copy") = 0, nb::sig("def goal(self, copy: int = 0) -> Array"),
          "In the world [m], (3,).")
      .def("render", &draw_reach, nb::arg("copy") = 0, nb::arg("width") = 640,
           nb::arg("height") = 480,
           nb::sig("def render(self, copy: int = 0, width: int = 640, height: int = 480) -> "
                   "Pixels"),
           "A picture of a copy, (height, width, 3).");
}

}  // namespace

void bind_rl(nb::module_& m) {
  bind_env(m);
  nb::class_<rl::TrainedPolicy>(m, "Policy", "A trained policy.")
      .def_static("load", &load_policy, nb::arg("name_or_path"),
                  nb::sig("def load(name_or_path: str | os.PathLike[str]) -> Policy"),
                  "A checkpoint of `mjarm train` (.safetensors), a .zip of stable-baselines3 "
                  "(nothing in it "
                  "is run), or the\nname of one that comes with mjarm (\"reach\").")
      .def_prop_ro(
          "file", [](const rl::TrainedPolicy& p) { return p.file; }, "Where it was read.")
      .def_prop_ro(
          "observation_size",
          [](const rl::TrainedPolicy& p) { return p.policy.shape().observations; },
          "Numbers of an observation.")
      .def_prop_ro(
          "action_size", [](const rl::TrainedPolicy& p) { return p.policy.shape().actions; },
          "Numbers of an action.")
      .def("act", &act, nb::arg("observation"),
           nb::sig("def act(self, observation: ArrayLike) -> Floats"),
           "The mean action, (actions,) of one observation (observations,), or of many rows.")
      .def("evaluate", &evaluate, nb::arg("episodes") = 200, nb::arg("seed") = 1,
           nb::arg("threads") = 1,
           nb::sig("def evaluate(self, episodes: int = 200, seed: int = 1, threads: int = 1) -> "
                   "dict[str, Any]"),
           "Judges it on goals that training has not seen, as `mjarm eval` does; distances [m].")
      .def(
          "save_onnx",
          [](const rl::TrainedPolicy& p, const std::filesystem::path& file) {
            value_of(rl::save_onnx(file, p.policy.tensors()));
          },
          nb::arg("file"), nb::sig("def save_onnx(self, file: str | os.PathLike[str]) -> None"),
          "Writes the mean action as an ONNX model: input \"observation\", output \"action\".")
      .def("__repr__", [](const rl::TrainedPolicy& p) {
        return "<mjarm.Policy: " + std::to_string(p.policy.shape().observations) + " -> " +
               std::to_string(p.policy.shape().actions) + ">";
      });
}

}  // namespace mjarm::python
