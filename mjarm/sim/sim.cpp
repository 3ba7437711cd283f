#include "mjarm/sim/sim.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "mjarm/control/actuation.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/sim/holding_internal.hpp"
#include "mjarm/sim/raw_internal.hpp"
#include "mjarm/sim/raw_state.hpp"

namespace mjarm {
namespace {

std::vector<std::string> keyframe_names(const mjModel& m) {
  std::vector<std::string> names;
  for (int i = 0; i < m.nkey; ++i) {
    if (const char* name = mj_id2name(&m, mjOBJ_KEY, i)) names.emplace_back(name);
  }
  return names;
}

/// Adds the pair, or deepens it where it is already there.
void add_contact(std::vector<Contact>& all, Contact contact) {
  for (Contact& known : all) {
    if (known.first == contact.first && known.second == contact.second) {
      known.depth = std::max(known.depth, contact.depth);
      return;
    }
  }
  all.push_back(std::move(contact));
}

/// True where `body` hangs on `root` or is it.
bool moved_by(const mjModel& m, int body, int root) {
  while (body > root) body = m.body_parentid[body];
  return body == root;
}

}  // namespace

struct Sim::Impl {
  Model model;
  raw::Data data;

  raw::OwnModel clamped;           ///< what is simulated in place of `model` while joints are held
  std::optional<Holding> holding;  ///< of joints that are not the arm's
  std::optional<Error> fatal;      ///< MuJoCo refused to go on; no step is possible until a reset

  explicit Impl(const Model& source) : model(source), data(mj_makeData(source.raw())) { refresh(); }
  [[nodiscard]] const mjModel& m() const { return clamped ? *clamped : *model.raw(); }
  [[nodiscard]] mjData& d() const { return *data; }

  [[nodiscard]] bool unstable() const { return raw::unstable(d().warning); }

  /// Runs `work`, in which MuJoCo may give up; then the world is of no use until it is reset.
  template <class Work>
  void guarded(const Work& work) {
    const MujocoOutcome said = call_mujoco(work);
    if (said.failed) fatal = Error{Errc::impossible, text(msg::sim_fatal, d().time, said.error)};
    if (unstable()) return;  // said with the error
    for (const std::string& warning : said.warnings) log_warning(text(msg::sim_mujoco, warning));
  }
  /// Recomputes everything that follows from the state.
  void refresh() {
    guarded([this] { mj_forward(&m(), &d()); });
  }
  /// The world was put somewhere.
  void stand() {
    if (holding) holding->stand({d().qpos, static_cast<std::size_t>(m().nq)});
    refresh();
  }
  void reset() {
    fatal.reset();
    mj_resetData(&m(), &d());
    stand();
  }

  void reset_to(int keyframe) {
    fatal.reset();
    mj_resetDataKeyframe(&m(), &d(), keyframe);
    stand();
  }

  /// What went wrong at `time`, and back to the initial state, whether or not MuJoCo went there.
  Error instability(double time) {
    std::string what = raw::instability(m(), d().warning, time);
    reset();
    return {Errc::impossible, std::move(what)};
  }

  [[nodiscard]] std::vector<Contact> contacts(int root) const {
    std::vector<Contact> all;
    for (int i = 0; i < d().ncon; ++i) {
      const mjContact& contact = d().contact[i];
      if (contact.exclude != 0 || contact.dist > contact.includemargin) continue;
      const auto counts = [&](int geom) {
        return geom >= 0 && moved_by(m(), m().geom_bodyid[geom], root);
      };
      if (!counts(contact.geom[0]) && !counts(contact.geom[1])) continue;
      const auto body = [&](int geom) { return geom >= 0 ? m().geom_bodyid[geom] : -1; };
      add_contact(all, {raw::geom_name(m(), contact.geom[0]), raw::geom_name(m(), contact.geom[1]),
                        -contact.dist, body(contact.geom[0]), body(contact.geom[1]),
                        contact.geom[0], contact.geom[1]});
    }
    return all;
  }
};

Sim::Sim(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Sim::~Sim() = default;
Sim::Sim(Sim&&) noexcept = default;
Sim& Sim::operator=(Sim&&) noexcept = default;

Result<void> Sim::reset(std::string_view keyframe) {
  const mjModel& m = impl_->m();
  if (keyframe.empty()) {
    impl_->reset();
  } else {
    const int key = mj_name2id(&m, mjOBJ_KEY, std::string(keyframe).c_str());
    if (key < 0) {
      const auto names = keyframe_names(m);
      return fail(Errc::bad_input, text(msg::sim_no_keyframe, model().file().string(), keyframe,
                                        names.empty() ? "-" : listed(names)) +
                                       did_you_mean(keyframe, names));
    }
    impl_->reset_to(key);
  }
  return {};
}

void Sim::reset_home() {
  const int key = home_keyframe(&impl_->m());
  key < 0 ? impl_->reset() : impl_->reset_to(key);
}

void Sim::place(const Arm& arm, std::span<const double> q) {
  assert(static_cast<int>(q.size()) == arm.dof());
  mjData& d = impl_->d();
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    d.qpos[joint.qpos] = q[i];
    d.qvel[joint.dof] = 0;
    if (joint.actuator && servo_stiffness(*joint.actuator) > 0) {
      d.ctrl[joint.actuator->id] = ctrl_for_torque(*joint.actuator, 0, q[i], 0);
    }
  }
  impl_->stand();
}

void Sim::place_free(std::string_view body, const Pose& X_WB) {
  mjData& d = impl_->d();
  const mjModel& m = impl_->m();
  const int id = mj_name2id(&m, mjOBJ_BODY, std::string(body).c_str());
  const int joint = id < 0 ? -1 : m.body_jntadr[id];
  if (joint < 0 || m.jnt_type[joint] != mjJNT_FREE) return;
  const Quat turn = to_quat(X_WB.R);
  const double values[] = {X_WB.p.x(), X_WB.p.y(), X_WB.p.z(), turn.w(),
                           turn.x(),   turn.y(),   turn.z()};
  std::copy(std::begin(values), std::end(values), d.qpos + m.jnt_qposadr[joint]);
  std::fill_n(d.qvel + m.jnt_dofadr[joint], 6, 0.0);
  impl_->stand();
}

void Sim::set_state(std::span<const double> qpos, std::span<const double> qvel) {
  assert(static_cast<int>(qpos.size()) == model().nq());
  assert(static_cast<int>(qvel.size()) == model().nv());
  std::copy(qpos.begin(), qpos.end(), impl_->d().qpos);
  std::copy(qvel.begin(), qvel.end(), impl_->d().qvel);
  impl_->stand();
}

Result<void> Sim::restore(const Snapshot& snapshot) {
  const mjModel& m = impl_->m();
  if (!raw::set_state(m, snapshot, impl_->d())) {
    return fail(Errc::bad_input, text(msg::sim_other_snapshot, snapshot.state.size(),
                                      mj_stateSize(&m, mjSTATE_INTEGRATION)));
  }
  impl_->stand();
  if (impl_->holding && !snapshot.place.empty()) impl_->holding->stand(snapshot.place);
  return {};
}

void Sim::set_ctrl(int actuator, double value) {
  assert(actuator >= 0 && actuator < model().nu());
  impl_->d().ctrl[actuator] = value;
}

void Sim::set_external_force(int body, const Eigen::Vector3d& force_W,
                             const Eigen::Vector3d& torque_W) {
  assert(body >= 0 && body < impl_->m().nbody);
  assert(force_W.allFinite() && torque_W.allFinite());
  double* wrench = impl_->d().xfrc_applied + 6 * body;
  std::copy_n(force_W.data(), 3, wrench);
  std::copy_n(torque_W.data(), 3, wrench + 3);
}

void Sim::clear_external_forces() {
  std::fill_n(impl_->d().xfrc_applied, 6 * impl_->m().nbody, 0.0);
}

void Sim::hold_others(const Arm& arm) {
  Holding holding(impl_->model, arm);
  if (holding.joints().empty()) return;
  impl_->clamped.reset(mj_copyModel(nullptr, impl_->model.raw()));
  holding.clamp(*impl_->clamped);
  impl_->holding = std::move(holding);
  impl_->stand();
}

void Sim::take_masses(const Model& model) {
  assert(model.nq() == impl_->m().nq && model.raw()->nbody == impl_->m().nbody);
  impl_->model = model;
  if (impl_->holding) {
    impl_->clamped.reset(mj_copyModel(nullptr, model.raw()));
    impl_->holding->clamp(*impl_->clamped);
  }
  impl_->refresh();
}

std::vector<HeldState> Sim::held() const {
  std::vector<HeldState> held;
  if (!impl_->holding) return held;
  const Holding& holding = *impl_->holding;
  for (std::size_t i = 0; i < holding.joints().size(); ++i) {
    held.push_back({holding.joints()[i], holding.moved()[i]});
  }
  return held;
}

Result<void> Sim::step(std::span<const double> ctrl) {
  const mjModel& m = impl_->m();
  mjData& d = impl_->d();
  assert(static_cast<int>(ctrl.size()) == m.nu);
  for (std::size_t i = 0; i < ctrl.size(); ++i) {
    if (!std::isfinite(ctrl[i])) {
      const char* name = mj_id2name(&m, mjOBJ_ACTUATOR, static_cast<int>(i));
      return fail(Errc::bad_input,
                  text(msg::sim_bad_ctrl, d.time, i, name != nullptr ? name : "-"));
    }
  }
  if (ctrl.data() != d.ctrl) std::copy(ctrl.begin(), ctrl.end(), d.ctrl);

  // The first half of a step (kinematics, contacts, velocities) was done at the end of the step
  // before or by mj_forward, so that reads in between are fresh at no cost: mj_step is mj_step1
  // followed by mj_step2. Only RK4 has no such halves, and pays for a whole step and a half.
  const double time = d.time;
  if (impl_->fatal) return fail(*impl_->fatal);
  impl_->guarded([this, &m, &d] {
    if (impl_->holding) impl_->holding->hold(m, d);
    if (m.opt.integrator == mjINT_RK4) {
      mj_step(&m, &d);
    } else {
      mj_step2(&m, &d);
    }
    if (!impl_->unstable()) mj_step1(&m, &d);
  });
  if (impl_->fatal) return fail(*impl_->fatal);
  if (impl_->unstable()) return fail(impl_->instability(time));
  if (impl_->holding) impl_->holding->measure(m, d);
  return {};
}

const Model& Sim::model() const noexcept { return impl_->model; }
double Sim::time() const noexcept { return impl_->d().time; }

std::span<const double> Sim::qpos() const noexcept {
  return {impl_->d().qpos, static_cast<std::size_t>(impl_->m().nq)};
}
std::span<const double> Sim::qvel() const noexcept {
  return {impl_->d().qvel, static_cast<std::size_t>(impl_->m().nv)};
}
std::span<const double> Sim::ctrl() const noexcept {
  return {impl_->d().ctrl, static_cast<std::size_t>(impl_->m().nu)};
}
std::span<const double> Sim::actuator_force() const noexcept {
  return {impl_->d().actuator_force, static_cast<std::size_t>(impl_->m().nout)};
}
std::span<const double> Sim::sensor_data() const noexcept {
  return {impl_->d().sensordata, static_cast<std::size_t>(impl_->m().nsensordata)};
}

JointState Sim::arm_state(const Arm& arm) const {
  const mjData& d = impl_->d();
  JointState state{JointVec(arm.dof()), JointVec(arm.dof()), JointVec(arm.dof())};
  for (int i = 0; i < arm.dof(); ++i) {
    state.q[i] = d.qpos[arm.joints[i].qpos];
    state.v[i] = d.qvel[arm.joints[i].dof];
    state.a[i] = d.qacc[arm.joints[i].dof];
  }
  return state;
}

JointVec Sim::arm_torque(const Arm& arm) const {
  JointVec torque(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    torque[i] = impl_->d().qfrc_actuator[arm.joints[i].dof];
  }
  return torque;
}

Pose Sim::tool(const Arm& arm) const { return raw::tool_pose(impl_->m(), impl_->d(), arm); }

Pose Sim::body_pose(int body) const {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const mjData& d = impl_->d();
  return {Eigen::Vector3d(d.xpos + 3 * body), Eigen::Map<const Rows>(d.xmat + 9 * body)};
}

bool is_by_design(const Arm& arm, const Contact& contact) {
  return arm.overlap_by_design({contact.geom1, contact.body1}, {contact.geom2, contact.body2});
}

std::vector<Contact> Sim::contacts() const { return impl_->contacts(0); }

std::vector<Contact> Sim::contacts(const Arm& arm) const {
  std::vector<Contact> out = impl_->contacts(impl_->m().dof_bodyid[arm.joints.front().dof]);
  std::erase_if(out, [&](const Contact& contact) { return is_by_design(arm, contact); });
  return out;
}

Snapshot Sim::snapshot() const {
  const mjModel& m = impl_->m();
  Snapshot snapshot;
  snapshot.time = impl_->d().time;
  snapshot.state.resize(static_cast<std::size_t>(mj_stateSize(&m, mjSTATE_INTEGRATION)));
  mj_getState(&m, &impl_->d(), snapshot.state.data(), mjSTATE_INTEGRATION);
  if (impl_->holding) {
    const auto place = impl_->holding->place();
    snapshot.place.assign(place.begin(), place.end());
  }
  return snapshot;
}

}  // namespace mjarm
