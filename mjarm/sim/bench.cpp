#include "mjarm/sim/bench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/core/stopwatch.hpp"
#include "mjarm/sim/raw_internal.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm {
namespace {

constexpr double kSwing = 0.2;   // [rad or m]
constexpr double kPeriod = 2.0;  // [s]

/// All joints swing by (1 - cos) / 2 away from `home`, so that the motion begins at rest.
std::vector<JointVec> swing(const Arm& arm, double timestep, int steps) {
  std::vector<JointVec> positions;
  for (int i = -1; i <= steps; ++i) {
    const double phase = 2 * std::numbers::pi * std::max(i, 0) * timestep / kPeriod;
    positions.emplace_back(arm.home.array() + kSwing * (1 - std::cos(phase)) / 2);
  }
  return positions;
}

/// The loop as every run makes it.
class Contestant {
 public:
  Contestant(std::string name, const Model& model, const Arm& arm, Controller controller)
      : name_(std::move(name)), arm_(arm), sim_(model), controller_(std::move(controller)) {}

  /// @return [us] the whole run took. `ctrl` gets the commands of every step where wanted.
  Result<double> run(const std::vector<JointVec>& positions, bool record,
                     std::vector<double>* ctrl = nullptr) {
    if (auto reset = sim_.reset(); !reset) return fail(std::move(reset.error()));
    sim_.place(arm_, as_span(positions.front()));
    std::optional<Recorder> recorder;
    if (record) recorder.emplace(sim_.model(), arm_);
    Stepper stepper(sim_, arm_);
    const Stopwatch watch;
    for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
      auto stepped =
          stepper.step(sim_, controller_, {positions[i - 1], positions[i], positions[i + 1]},
                       recorder ? &*recorder : nullptr);
      if (!stepped) return fail(std::move(stepped.error()));
      if (ctrl != nullptr) ctrl->insert(ctrl->end(), sim_.ctrl().begin(), sim_.ctrl().end());
    }
    return watch.us();
  }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  const Arm& arm_;
  Sim sim_;
  Controller controller_;
};

/// MuJoCo alone.
class Bare {
 public:
  Bare(const Model& model, const Arm& arm)
      : model_(model), arm_(arm), data_(mj_makeData(model.raw())) {}

  double run(const JointVec& start_position, const std::vector<double>& ctrl) {
    const mjModel* m = model_.raw();
    mj_resetData(m, data_.get());
    for (int i = 0; i < arm_.dof(); ++i) data_->qpos[arm_.joints[i].qpos] = start_position[i];
    mj_forward(m, data_.get());
    const Stopwatch watch;
    for (std::size_t at = 0; at < ctrl.size(); at += static_cast<std::size_t>(m->nu)) {
      std::copy_n(ctrl.data() + at, m->nu, data_->ctrl);
      mj_step(m, data_.get());
    }
    return watch.us();
  }

 private:
  Model model_;
  const Arm& arm_;
  raw::Data data_;
};

/// One contestant a control mode that works; the error of the last one where none does.
Result<std::vector<Contestant>> contestants_of(const Model& model, const Arm& arm) {
  std::vector<Contestant> contestants;
  Error why;
  for (const ControlMode mode :
       {ControlMode::servo, ControlMode::servo_gravity, ControlMode::computed_torque}) {
    auto controller = Controller::create(model, arm, mode);
    if (controller) {
      contestants.emplace_back(std::string(name(mode)), model, arm, std::move(*controller));
    } else {
      why = std::move(controller.error());
    }
  }
  if (contestants.empty()) return fail(std::move(why));
  return contestants;
}

}  // namespace

Result<std::vector<SimBenchEntry>> bench_sim(const Model& model, const Arm& arm,
                                             const SimBenchOptions& options) {
  const int steps = std::max(options.steps, 1);
  const std::vector<JointVec> positions = swing(arm, model.timestep(), steps);
  auto contestants = contestants_of(model, arm);
  if (!contestants) return fail(std::move(contestants.error()));

  // A first run warms the caches up and tells the commands that MuJoCo alone replays.
  std::vector<double> ctrl;
  if (auto first = contestants->front().run(positions, false, &ctrl); !first) {
    return fail(std::move(first.error()));
  }
  Bare bare(model, arm);

  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<SimBenchEntry> entries{{"mj_step", kNever}};
  for (const Contestant& contestant : *contestants) entries.push_back({contestant.name(), kNever});
  entries.push_back({"recorded", kNever});
  for (int round = 0; round < std::max(options.rounds, 1); ++round) {
    entries[0].us = std::min(entries[0].us, bare.run(positions.front(), ctrl) / steps);
    for (std::size_t i = 1; i < entries.size(); ++i) {
      const bool record = i + 1 == entries.size();
      auto& contestant = (*contestants)[record ? i - 2 : i - 1];
      const auto us = contestant.run(positions, record);
      if (!us) return fail(us.error());
      entries[i].us = std::min(entries[i].us, *us / steps);
    }
  }
  for (SimBenchEntry& entry : entries) {
    entry.rtf = 1e6 * model.timestep() / entry.us;
    entry.ratio = entries[0].us / entry.us;
  }
  return entries;
}

}  // namespace mjarm
